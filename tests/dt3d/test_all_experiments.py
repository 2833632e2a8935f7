"""`dt3d experiment all`: it goes on after a failure, and says how each ended."""

import io
import re
import sys
from types import ModuleType

import pytest
from rich.console import Console

from dt3d import _output, cli
from dt3d._output import style
from dt3d.cli.all_experiments import QUICK, quick_options, run_all
from dt3d.experiments import EXPERIMENTS


def good(out, console, *, points=10**9, seed=0):
    """Writes two files.

    More.
    """
    (out / "good.csv").write_text(f"{points} {seed}")
    (out / "good.png").write_text("")


def bad(out, console):
    """Ends in an error."""
    (out / "bad.csv").write_text("half")
    msg = "no\nluck [here]"
    raise ValueError(msg)


def again(out, console):
    """Replaces a file of another."""
    (out / "good.csv").unlink()
    (out / "good.csv").write_text("again")


@pytest.fixture
def console():
    return Console(file=io.StringIO(), width=80)


@pytest.fixture
def listed(monkeypatch):
    """Gives the command line other experiments."""

    def give(**experiments):
        module = ModuleType("dt3d.experiments")
        module.EXPERIMENTS = experiments
        monkeypatch.setitem(sys.modules, "dt3d.experiments", module)

    return give


def test_all_run_in_order_and_the_table_says_how_each_ended(tmp_path, console):
    (tmp_path / "old.txt").write_text("")
    ended = run_all({"good": good, "bad": bad, "again": again}, tmp_path, console)
    assert [(e.name, e.files, e.error) for e in ended] == [
        ("good", ("good.csv", "good.png"), ""),
        ("bad", ("bad.csv",), "ValueError: no luck [here]"),
        ("again", ("good.csv",), ""),
    ]
    assert (tmp_path / "good.csv").read_text() == "again"
    lines = [" ".join(line.split()) for line in console.file.getvalue().splitlines()]
    assert "1 of 3: good, after 0 s. Writes two files." in lines
    assert "2 of 3: bad, after 0 s. Ends in an error." in lines
    assert "bad failed: ValueError: no luck [here]" in lines
    words = [line.split() for line in lines if line]
    assert [(row[0], *row[2:]) for row in words[-3:]] == [
        ("good", "ok", "good.csv", ".png"),
        ("bad", "failed", "bad.csv"),
        ("again", "ok", "good.csv"),
    ]
    assert all(float(row[1]) >= 0 for row in words[-3:])


def test_quick_gives_small_sizes_to_those_that_have_them(tmp_path, console):
    run_all({"good": good}, tmp_path, console, quick=True)
    assert (tmp_path / "good.csv").read_text() == f"{QUICK['points']} 0"
    for name, experiment in EXPERIMENTS.items():  # those of the plane, too, which load late
        if name != "primitives":  # which takes nothing
            assert quick_options(experiment), name


def test_the_status_is_1_if_one_failed(tmp_path, listed, capsys):
    listed(good=good, bad=bad)
    assert cli.main(["experiment", "all", "--out", str(tmp_path / "new")]) == 1
    out, err = capsys.readouterr()
    assert "2 experiments in" in out
    assert not err
    listed(good=good)
    assert cli.main(["experiment", "all", "--out", str(tmp_path), "--quick"]) == 0
    assert (tmp_path / "good.csv").read_text() == f"{QUICK['points']} 0"


def test_words_that_all_does_not_take(tmp_path, listed, capsys):
    listed(good=good)
    assert cli.main(["experiment", "all", "--out", str(tmp_path), "--seed", "1"]) == 2
    assert "experiment all takes --out, --quick and --costs only; got seed" in capsys.readouterr().err
    assert not (tmp_path / "good.csv").exists()


def stopped(out, console):
    """Ctrl-C."""
    raise KeyboardInterrupt


def stopped_in_a_library(out, console):
    """Ctrl-C, of which a library makes an error of its own."""
    try:
        raise KeyboardInterrupt
    except KeyboardInterrupt as interrupt:
        msg = "callback failed"
        raise RuntimeError(msg) from interrupt


@pytest.mark.parametrize("experiment", [stopped, stopped_in_a_library])
def test_ctrl_c_ends_all(tmp_path, listed, capsys, experiment):
    listed(first=experiment, good=good)
    assert cli.main(["experiment", "all", "--out", str(tmp_path)]) == 130
    assert not (tmp_path / "good.csv").exists()


def numbers(labels):
    """Whether an axis has numbers, of what its label has to say; not names, nor nothing."""
    return any(re.fullmatch(r"[\d.,]+", label.get_text()) for label in labels)


@pytest.mark.slow
def test_every_experiment_runs_quickly_and_leaves_a_table_and_pictures(tmp_path, console, monkeypatch):
    figures = []
    monkeypatch.setattr(_output, "style", lambda figure: figures.append(figure) or style(figure))
    ended = run_all(EXPERIMENTS, tmp_path, console, quick=True)
    assert [(e.name, e.error) for e in ended] == [(name, "") for name in EXPERIMENTS]
    for name in EXPERIMENTS:
        assert (tmp_path / f"{name}.csv").stat().st_size > 0
        assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")
        assert (tmp_path / f"{name}.pdf").read_bytes().startswith(b"%PDF")
    assert "…" not in console.file.getvalue()
    assert len(figures) == len(EXPERIMENTS)
    for axes in (a for figure in figures for a in figure.axes if a.axison):
        where = axes.figure.axes.index(axes), [text.get_text() for text in axes.get_xticklabels()]
        assert axes.get_xlabel() or not numbers(axes.get_xticklabels()), where
        assert axes.get_ylabel() or axes.get_title() or not numbers(axes.get_yticklabels()), where
