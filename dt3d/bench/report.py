"""What was measured: a table, a CSV, and a picture."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from datetime import date
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

from .. import _output as output
from .._numba.cores import available_cores
from .._table import Sheet
from .rounds import Measured

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console

NAME = "bench"  # of the files
HEADER = ["set", "sites", "library", "median seconds", "ratio", "tetrahedra", "peak bytes",
          "verified", "runs", "ended"]  # fmt: skip
MARKERS = "osD^vP*X"


def publish(measured: Sequence[Measured], out: Path, console: Console) -> None:
    """Print the table, and write ``bench.csv``, ``bench.png`` and ``bench.pdf`` to the folder ``out``."""
    table(measured).show(console)
    console.print("right: proved by exact arithmetic; bytes are those above the input")
    output.publish(console, out, NAME, HEADER, csv_rows(measured), draw(measured))


def written(out: Path) -> tuple[Path, Path, Path]:
    """The files that `publish` writes into a folder: the table, and the picture as PNG and as PDF."""
    return output.written(out, NAME)


def machine() -> str:
    """The day, the processor and its cores, in words."""
    return f"{date.today().isoformat()}, {_processor()}, {available_cores()} cores"


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def by_set(measured: Sequence[Measured]) -> list[list[Measured]]:
    """The rows of each set, that of dt3d first."""
    return [list(rows) for _, rows in groupby(measured, lambda m: (m.set_name, m.sites))]


def ratio(row: Measured, rows: Sequence[Measured]) -> float | None:
    """How many times as long as dt3d on the same set, by medians."""
    first = rows[0].seconds
    return row.seconds / first if first and row.seconds else None


def table(measured: Sequence[Measured]) -> Sheet:
    """Medians, and how they compare with dt3d's."""
    names = ("set", "sites", "library")
    numbers = ("seconds", "ratio", "tetrahedra", "10^6 per s", "bytes/site", "right", "runs")
    title = f"Delaunay triangulation in space, dt3d = 1: {machine()}"
    shown = Sheet(title, [*names, *numbers], {"set", "library"}, keep=len(names))
    for rows in by_set(measured):
        for row in rows:
            shown.add_row(*_cells(row, rows))
        shown.add_section()
    return shown


def _cells(row: Measured, rows: Sequence[Measured]) -> list[str]:
    names = [row.set_name, f"{row.sites:,}", row.label]
    seconds, times = row.seconds, ratio(row, rows)
    if seconds is None:
        return [*names, row.ended, "", "", "", "", "", "0"]
    return [
        *names,
        f"{seconds:.3g}" if seconds < 100 else f"{seconds:.0f}",
        "" if times is None else f"{times:.2f}",
        f"{row.tetrahedra:,}",
        f"{1e-6 * row.tetrahedra / seconds:.2f}",
        "" if row.memory is None else f"{row.memory / row.sites:,.0f}",
        "" if row.verified is None else "yes" if row.verified else "NO",
        f"{len(row.runs)}" + (f", {row.ended}" if row.ended else ""),
    ]


def csv_rows(measured: Sequence[Measured]) -> list[list[object]]:
    """The rows of the CSV, one for each library and set; several runs are separated by spaces."""
    return [
        [row.set_name, row.sites, row.label, row.seconds, ratio(row, rows), row.tetrahedra,
         row.memory, row.verified, " ".join(f"{s:.6f}" for s in row.runs), row.ended]
        for rows in by_set(measured)
        for row in rows
    ]  # fmt: skip


def draw(measured: Sequence[Measured]) -> Figure:
    """Microseconds per site, a column for each set and a marker for each library."""
    sets = by_set(measured)
    figure = output.new_figure(max(6.0, 1.2 * len(sets) + 3.0), 4.2)
    axes = figure.subplots()
    libraries = list(dict.fromkeys(row.label for row in measured))
    for k, library in enumerate(libraries):
        points = [
            (column, 1e6 * row.seconds / row.sites)
            for column, rows in enumerate(sets)
            for row in rows
            if row.label == library and row.seconds
        ]
        marker = MARKERS[k % len(MARKERS)]
        axes.plot(*zip(*points, strict=True) if points else ([], []), marker, label=library)
    axes.set_yscale("log")
    axes.set_ylabel("microseconds per site")
    # a dollar in the name of a file begins no formula
    names = [f"{rows[0].set_name}\n{rows[0].sites:,}".replace("$", r"\$") for rows in sets]
    axes.set_xticks(range(len(sets)), names)
    axes.set_xlim(-0.5, len(sets) - 0.5)
    axes.grid(axis="y", alpha=0.3)
    axes.legend()
    axes.set_title(machine(), fontsize="small")
    return figure
