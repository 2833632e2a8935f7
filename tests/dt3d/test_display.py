"""Whether anything can be drawn is asked in another process, which may crash."""

import sys

import pytest

from dt3d import _display


def test_rendering_is_asked_once(monkeypatch):
    calls = []
    monkeypatch.setattr(_display, "_succeeds", lambda program: calls.append(program) or False)
    _display.renders.cache_clear()
    try:
        assert not _display.renders()
        assert not _display.renders()
        assert calls == [_display.RENDER]
    finally:
        _display.renders.cache_clear()


@pytest.mark.parametrize(
    ("program", "expected"),
    [
        ("pass", True),
        ("raise SystemExit(3)", False),
        ("import os; os.abort()", False),
        ("print('words', flush=True)", True),
    ],
)
def test_what_becomes_of_a_process(program, expected, capfd):
    assert _display._succeeds(program) is expected
    assert capfd.readouterr() == ("", "")


def test_a_process_that_hangs_is_ended(monkeypatch):
    monkeypatch.setattr(_display, "PATIENCE", 0.5)
    assert not _display._succeeds("import time; time.sleep(600)")


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere there is always a screen")
def test_screens_that_are_not_there(monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(ValueError, match=r"no screen .* \(DISPLAY is not set\); use --screenshot FILE.png"):
        _display.check_screen()
    monkeypatch.setenv("DISPLAY", ":4711")
    with pytest.raises(ValueError, match=r"the screen DISPLAY=:4711 does not answer; use .* --html"):
        _display.check_screen()
