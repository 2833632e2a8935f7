"""What is made of triangulations, beside the libraries that make it, too: the list, a table and a CSV."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

from .._output import write_csv
from .._table import Sheet
from .pairs import Pair
from .report import machine

if TYPE_CHECKING:
    from rich.console import Console

# name: the module beside this one whose function `pairs(rounds, quick)` measures, and what it does
COMPARISONS = {
    "interpolation": "linear, natural neighbour and nearest interpolation; SciPy, MetPy",
    "voronoi": "the Voronoi diagram; SciPy",
    "incremental": "sites added to a triangulation, beside all of them from scratch",
    "jax": "a triangulation inside jit and vmap, beside direct calls",
}
HEADER = ["task", "size", "other", "seconds of dt3d", "seconds of the other", "ratio", "note"]
_MODULES = {
    "interpolation": "interpolation",
    "voronoi": "voronoi",
    "incremental": "added_sites",
    "jax": "jax_calls",
}


def measure(name: str, rounds: int, quick: bool) -> list[Pair]:
    """Run a comparison; ``quick`` is for small sizes, to see that everything runs.

    Raises
    ------
    ValueError
        If there is none of this name.
    """
    if name not in COMPARISONS:
        msg = f"there is no comparison {name!r}; there are {', '.join(COMPARISONS)}"
        raise ValueError(msg)
    pairs: Callable[[int, bool], list[Pair]] = import_module(f".{_MODULES[name]}", __package__).pairs
    return pairs(rounds, quick)


def file_of(out: Path, name: str) -> Path:
    """The table that `show` writes into a folder."""
    return out / f"compare-{name}.csv"


def show(name: str, measured: Sequence[Pair], out: Path, console: Console) -> None:
    """Print a table, and write it to the folder ``out`` with the seconds of each round."""
    columns = ["task", "size", "other", "dt3d (s)", "other (s)", "ratio", "note"]
    sheet = Sheet(f"{COMPARISONS[name]}: {machine()}", columns, {"task", "size", "other", "note"})
    rows = []
    for pair in measured:
        ours, theirs = median(pair.ours), median(pair.theirs)
        cells = f"{ours:.3g}", f"{theirs:.3g}", f"{pair.ratio:.2f}"
        sheet.add_row(pair.task, pair.size, pair.other, *cells, pair.note)
        every = [" ".join(f"{s:.9f}" for s in seconds) for seconds in (pair.ours, pair.theirs)]
        rows.append([pair.task, pair.size, pair.other, *every, pair.ratio, pair.note])
    sheet.show(console)
    write_csv(file_of(out, name), HEADER, rows)
    console.print(f"wrote {file_of(out, name)}", markup=False, soft_wrap=True)
