"""Figure 1: where the sequential algorithm spends its time."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ...threaded2d import Delaunay
from . import sets
from .busy import warn_if_busy
from .report import Row, publish

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console


def phases(
    out: Path,
    console: Console,
    *,
    points: int | str = "1000,5000,10000,50000,100000",
    order: Literal["brio", "random"] = "random",
) -> list[Row]:
    """Kohout et al. 2004, Figure 1: time of the sequential algorithm in location, changes and extraction.

    The paper has 60 to 70 % location and up to 25 % changes.
    """
    warn_if_busy(console)
    rows: list[Row] = []
    Delaunay(sets.uniform(200), method="sequential")  # compiled before the clock runs
    for n in sets.sizes(points):
        stats = Delaunay(sets.uniform(n), method="sequential", order=order).stats
        location, change = stats.location_seconds[0], stats.change_seconds[0]
        rest = stats.seconds["extraction"]
        total = location + change + rest
        rows.append(
            {
                "points": n,
                "location ms": 1e3 * location,
                "change ms": 1e3 * change,
                "extraction ms": 1e3 * rest,
                "location %": 100 * location / total,
                "change %": 100 * change / total,
                "paper location %": "60-70",
                "paper change %": "up to 25",
            }
        )

    def draw(axes: Axes) -> None:
        below = [0.0] * len(rows)
        for column in ("location ms", "change ms", "extraction ms"):
            values = [1e3 * row[column] / row["points"] for row in rows]
            axes.bar(
                [str(row["points"]) for row in rows], values, bottom=below, label=column.removesuffix(" ms")
            )
            below = [b + v for b, v in zip(below, values, strict=True)]
        axes.set(xlabel="points", ylabel="microseconds per point", title=f"sequential, {order} order")
        axes.legend()

    outside = [f"{row['points']:,}" for row in rows if not 60 <= row["location %"] <= 70]
    note = (
        f"Location is outside of the paper's 60 to 70 % for {' and '.join(outside) or 'no size'}. "
        "Uniform points, DAG. The paper frees its structure too, in what is neither location nor change; and "
        "here location waits for memory the more, the larger the set."
    )
    publish("kohout-phases", "Kohout et al. 2004, Fig. 1: phases", rows, out, console, draw, note)
    return rows
