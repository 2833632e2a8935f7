"""``dt3d experiment all``: every experiment of the list, and what came of each."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from inspect import getdoc, signature
from pathlib import Path
from time import perf_counter
from types import MappingProxyType
from typing import TYPE_CHECKING

from .._status import one_line
from .._table import Sheet

if TYPE_CHECKING:
    from rich.console import Console

Experiment = Callable[..., object]
Option = int | float | str

# What --quick gives the parameters of these names: sizes at which an experiment ends in seconds, and at which
# its numbers say little. 500 sites are the fewest from which the CM-5 model can be calibrated.
QUICK: dict[str, Option] = {
    "most_sites": 500,
    "other_sets": 1,
    "sites": 200,
    "points": 1000,
    "repeats": 1,
    "largest_cell": 4,
    "step": 20,
}


@dataclass(frozen=True)
class Ended:
    """How one experiment ended: its seconds, the files that it wrote, and its error, "" if it had none."""

    name: str
    seconds: float
    files: tuple[str, ...]
    error: str


def summary_of(experiment: Experiment) -> str:
    """The first paragraph of its docstring, as a line."""
    return " ".join((getdoc(experiment) or "").partition("\n\n")[0].split())


def quick_options(experiment: Experiment) -> dict[str, Option]:
    """The small sizes of `QUICK`, for those parameters that the experiment has."""
    return {name: size for name, size in QUICK.items() if name in signature(experiment).parameters}


def run_all(
    experiments: Mapping[str, Experiment],
    out: Path,
    console: Console,
    *,
    quick: bool = False,
    options: Mapping[str, Option] = MappingProxyType({}),
) -> list[Ended]:
    """Run all, go on after one that fails, and print a table of how each ended.

    ``options`` are for those experiments that have them.

    Ctrl-C ends all of it, as does a reader of the output that is gone.
    """
    begin, ended = perf_counter(), []
    for number, (name, experiment) in enumerate(experiments.items(), 1):
        console.rule(style="none")
        console.print(
            f"{number} of {len(experiments)}: {name}, after {perf_counter() - begin:.0f} s. "
            f"{summary_of(experiment)}",
            markup=False,
            soft_wrap=True,
        )
        chosen = quick_options(experiment) if quick else {}
        chosen |= {key: value for key, value in options.items() if key in signature(experiment).parameters}
        ended.append(_run(name, experiment, out, console, chosen))
        if ended[-1].error:
            console.print(f"{name} failed: {ended[-1].error}", markup=False, soft_wrap=True)
    table = Sheet(
        f"{len(ended)} experiments in {perf_counter() - begin:.0f} s, files in {out}",
        ["experiment", "seconds", "ended", "files"],
        {"experiment", "ended", "files"},
    )
    for e in ended:
        table.add_row(e.name, f"{e.seconds:.1f}", "failed" if e.error else "ok", _short(e.files))
    table.show(console)
    return ended


def _run(
    name: str, experiment: Experiment, out: Path, console: Console, options: Mapping[str, Option]
) -> Ended:
    before, begin, error = _files(out), perf_counter(), ""
    try:
        experiment(out, console, **options)
    except BrokenPipeError:
        raise
    except Exception as failure:
        if _interrupted(failure):
            raise KeyboardInterrupt from failure
        error = f"{type(failure).__name__}: {one_line(failure)}"
    seconds = perf_counter() - begin
    new = tuple(sorted(file for file, state in _files(out).items() if before.get(file) != state))
    return Ended(name, seconds, new, error)


def _interrupted(failure: BaseException | None) -> bool:
    """Whether Ctrl-C is behind it, which libraries turn into errors of their own."""
    while failure is not None and not isinstance(failure, KeyboardInterrupt):
        failure = failure.__cause__ or failure.__context__
    return failure is not None


def _files(out: Path) -> dict[str, tuple[int, int]]:
    """The files of a folder and those below it, with what changes when one is replaced."""
    found = {}
    for path in out.rglob("*"):
        if path.is_file():
            state = path.stat()
            found[str(path.relative_to(out))] = (state.st_ino, state.st_mtime_ns)
    return found


def _short(files: tuple[str, ...]) -> str:
    """Files of one stem are named once: a.csv .pdf .png."""
    words: list[str] = []
    last = ""
    for file in files:
        stem, dot, end = file.rpartition(".")
        words.append(f".{end}" if dot and stem == last else file)
        last = stem
    return " ".join(words)
