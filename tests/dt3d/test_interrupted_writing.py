"""Signals and other threads while a file is written."""

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

import scanvec as sv
from dt3d._output import write_csv
from dt3d._paths import written_aside

OLD = b"the old file, which somebody may need\n"

WRITE = """
import importlib.util, sys, time
spec = importlib.util.spec_from_file_location("writing", sys.argv[1])
writing = importlib.util.module_from_spec(spec)
spec.loader.exec_module(writing)  # without JAX, which takes a second
with writing.written_aside(sys.argv[2]) as aside:
    aside.write_bytes(b"a part")
    print("ready", flush=True)
    for _ in range(600):  # a signal that comes just before a sleep is heard after it
        time.sleep(0.1)
"""


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP", "SIGKILL"])
def test_a_signal_while_writing(tmp_path, name):
    path = tmp_path / "old.csv"
    path.write_bytes(OLD)
    module = Path(sv.__file__).parent / "_writing.py"
    words = [sys.executable, "-c", WRITE, str(module), str(path)]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "ready\n"
        process.send_signal(signal.Signals[name])
        process.wait(30)
    assert process.returncode == -signal.Signals[name]  # it ends as it would have
    assert path.read_bytes() == OLD
    left = [other for other in os.listdir(tmp_path) if other != path.name]
    if name == "SIGKILL":  # which nobody hears; what is left says of whom it is
        assert [other.split("-")[:2] for other in left] == [[".old.dt3d", str(process.pid)]]
        assert left[0].endswith(".csv")
    else:
        assert left == []


def test_another_s_handler_of_signals_stays(tmp_path):
    heard = []
    before = signal.signal(signal.SIGTERM, lambda *_: heard.append(1))
    try:
        with written_aside(tmp_path / "a.csv") as aside:
            signal.raise_signal(signal.SIGTERM)
            aside.write_text("x")
        assert heard == [1]
        assert (tmp_path / "a.csv").read_text() == "x"
    finally:
        signal.signal(signal.SIGTERM, before)
    with written_aside(tmp_path / "a.csv"):
        assert signal.getsignal(signal.SIGTERM) is not before
    assert signal.getsignal(signal.SIGTERM) is before


def test_threads_write_one_file_at_once(tmp_path):
    """Each writes its own file aside; the last to end wins, and no two are mixed."""
    path, errors = tmp_path / "a.csv", []

    def write(k):
        try:
            write_csv(path, ["x"], [[k]] * 2000)
        except BaseException as error:
            errors.append(error)

    threads = [threading.Thread(target=write, args=(k,)) for k in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert errors == []
    lines = path.read_text().split()
    assert len(lines) == 2001
    assert len(set(lines[1:])) == 1
    assert os.listdir(tmp_path) == ["a.csv"]
