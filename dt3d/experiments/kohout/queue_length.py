"""Table 1: the best length of the batch method's queue."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...threaded2d.configuration import Options, searching_threads
from ...threaded2d.virtual_time.costs import measure
from ...threaded2d.virtual_time.scheduler import simulate
from . import sets
from .report import Row, publish

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console

LENGTHS = (16, 32, 64, 128, 256, 512, 1024, 2048, 4096)
# points: searching threads to one specialised, best length (Dell P 410, two processors)
PAPER = {
    1000: (2, 64), 5000: (3, 256), 10_000: (2, 512), 50_000: (3, 512),
    100_000: (3, 1024), 500_000: (3, 1024), 1_000_000: (3, 1024),
}  # fmt: skip


def queue(
    out: Path, console: Console, *, points: int | str = "1000,5000,10000,50000,100000", elements: int = 2
) -> list[Row]:
    """Table 1: the speed-up of the batch method in virtual time for queues of 16 to 4,096 elements."""
    rows: list[Row] = []
    for n in sets.sizes(points):
        sites = sets.uniform(n)
        costs = measure(sites)
        base = simulate(sites, Options(method="sequential", order="random"), 1, costs).seconds
        searching, best = PAPER.get(n, (searching_threads(n, elements), None))
        row: Row = {"points": n, "threads": f"{searching}:1"}
        for length in LENGTHS:
            options = Options(method="batch", threads=searching + 1, order="random", queue_length=length)
            row[str(length)] = base / simulate(sites, options, elements, costs).seconds
        row["best"] = max(LENGTHS, key=lambda length: row[str(length)])
        row["paper best"] = best
        rows.append(row)

    def draw(axes: Axes) -> None:
        for row in rows:
            axes.plot(
                LENGTHS, [row[str(length)] for length in LENGTHS], "o-", label=f"{row['points']:,} points"
            )
        axes.set(xscale="log", xlabel="queue length", ylabel=f"speed-up, {elements} virtual elements")
        axes.set_xticks(LENGTHS, [str(length) for length in LENGTHS])
        axes.minorticks_off()
        axes.legend()

    note = "Virtual time has no caches, which make long queues better or worse; look at the flat part."
    publish("kohout-queue", "Kohout et al. 2004, Table 1: queue length", rows, out, console, draw, note)
    return rows
