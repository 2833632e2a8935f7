"""Section 3.3: when the variant of the paper's reviewer pays."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ...threaded2d.options import PlaneOptions
from ...threaded2d.virtual_time.scheduler import simulate
from . import sets
from .costs import SHIPPED_NAME, chosen_costs, described, points_of
from .report import Row, publish
from .runs import OURS, PAPER, note_of, options_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console

DEARER = (
    1,
    5,
    10,
)  # how many times as much an element costs that is taken in a critical section; the paper: 5
PAYS_FROM = 3.0  # nodes that the specialised thread visits per location, by the paper


def helping(
    out: Path, console: Console, *,
    points: int | str = "1000,5000,50000", queue_length: str = "16,128,1024", data: str = "uniform",
    searching: int = 3, elements: int = 4, costs: str = SHIPPED_NAME,
) -> list[Row]:  # fmt: skip
    """Kohout et al. 2004, section 3.3: searching threads that find the queue full finish locations in it.

    Virtual time; the gain over the method as published, if an element that is taken costs 1, 5 or 10 times
    as much. The paper expects that it pays where the specialised thread visits three nodes or more per
    location, and does not try it.
    """
    sizes, lengths = sets.sizes(points), sets.sizes(queue_length)
    table = chosen_costs(costs, [(data, n, 1) for n in sizes])
    rows: list[Row] = []
    for n in sizes:
        sites, found = points_of(data, n), table.of(data, n).costs
        alone = simulate(sites, options_of(n, "sequential", 1, OURS), 1, found).seconds
        for length in lengths:
            way: PlaneOptions = {**PAPER, "queue_length": length}
            plain = simulate(sites, options_of(n, "batch", searching + 1, way), elements, found)
            row: Row = {
                "points": n,
                "queue": length,
                "nodes left": plain.visited[-1] / max(1, plain.inserted[-1]),
                "as published": alone / plain.seconds,
            }
            for times in DEARER:
                dear = found._replace(get=times * found.get)
                way = {**PAPER, "queue_length": length, "helping": True}
                run = simulate(sites, options_of(n, "batch", searching + 1, way), elements, dear)
                row[f"helping, x{times}"] = alone / run.seconds
                row[f"gain x{times}, %"] = 100 * (plain.seconds / run.seconds - 1)
                row[f"nodes left, x{times}"] = run.visited[-1] / max(1, run.inserted[-1])
            rows.append(row)

    def draw(axes: Axes) -> None:
        for times, style in zip(DEARER, ("o", "s", "^"), strict=True):
            axes.plot(
                [row["nodes left"] for row in rows], [row[f"gain x{times}, %"] for row in rows], style,
                label=f"an element taken costs {times} times as much",
            )  # fmt: skip
        axes.axhline(0, color="0.7", linewidth=0.8)
        axes.axvline(PAYS_FROM, color="0.7", linestyle="--", label="paper: pays from here on")
        axes.set(xlabel="nodes that the specialised thread visits per location", ylabel="gain, %")
        axes.legend()

    publish(
        "kohout-helping", f"Kohout et al. 2004, section 3.3: helping, {searching}:1 on {elements} elements",
        rows, out, console, draw,
        f"{_found(rows)} {note_of(table.source)} Costs: {described(table.of(data, sizes[-1]))}.",
    )  # fmt: skip
    return rows


def _found(rows: list[Row]) -> str:
    """Where it gains, in words."""
    parts = []
    for times in DEARER:
        gains = [row[f"gain x{times}, %"] for row in rows]
        pays = [row["nodes left"] for row in rows if row[f"gain x{times}, %"] > 1]
        where = (
            f"more than 1 % where {min(pays):.2g} nodes or more were left"
            if pays
            else "nowhere more than 1 %"
        )
        parts.append(f"x{times}: {min(gains):+.0f} to {max(gains):+.0f} %, {where}")
    return f"Gain if an element taken costs so many times as much: {'; '.join(parts)}."
