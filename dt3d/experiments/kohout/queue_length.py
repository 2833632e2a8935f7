"""Table 1: the best length of the batch method's queue."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...threaded2d.configuration import searching_threads
from ...threaded2d.options import PlaneOptions
from . import sets
from .by_size import SIZES
from .costs import SHIPPED_NAME, chosen_costs, described
from .paper import QUEUE
from .report import Row, publish
from .runs import PAPER, SpeedupSet, note_of, options_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console

LENGTHS = (16, 32, 64, 128, 256, 512, 1024, 2048, 4096)


def queue(
    out: Path, console: Console, *, points: int | str = SIZES, elements: int = 2, costs: str = SHIPPED_NAME
) -> list[Row]:
    """Kohout et al. 2004, Table 1: the batch method as published, for queues of 16 to 4,096; virtual time."""
    counts = sets.sizes(points)
    table = chosen_costs(costs, [("uniform", n, 1) for n in counts])
    rows: list[Row] = []
    for n in counts:
        given = SpeedupSet("uniform", sets.uniform(n), table)
        searching, best = QUEUE.get(n, (searching_threads(n, elements), None))
        row: Row = {"points": n, "threads": f"{searching}:1"}
        for length in LENGTHS:
            way: PlaneOptions = {**PAPER, "queue_length": length}
            options = options_of(n, "batch", searching + 1, way)
            row[str(length)] = given.alone / given.simulated(options, elements).seconds
        row["best"] = max(LENGTHS, key=lambda length: row[str(length)])
        row["paper best"] = best
        row["loss at paper's %"] = (
            None if best is None else 100 * (1 - row[str(best)] / row[str(row["best"])])
        )
        rows.append(row)

    def draw(axes: Axes) -> None:
        for row in rows:
            (line,) = axes.plot(
                LENGTHS, [row[str(length)] for length in LENGTHS], "o-", label=f"{row['points']:,} points"
            )
            if row["paper best"] is not None:
                best = row["paper best"]
                axes.plot([best], [row[str(best)]], "*", color=line.get_color(), markersize=12)
        axes.plot([], [], "*", color="0.5", markersize=12, label="best in the paper")
        axes.set(xscale="log", xlabel="queue length", ylabel=f"speed-up, {elements} virtual elements")
        axes.set_xticks(LENGTHS, [str(length) for length in LENGTHS])
        axes.minorticks_off()
        axes.legend()

    note = (
        "The curves are flat over a wide range, where the best is chance; the last column is "
        f"what the paper's best loses here. {note_of(table.source)} "
        f"Costs: {described(table.of('uniform', counts[-1]))}."
    )
    publish(
        "kohout-queue", "Kohout et al. 2004, Table 1: queue length, batch as published", rows, out, console,
        draw, note,
    )  # fmt: skip
    return rows
