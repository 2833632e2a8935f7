"""Section 3.4: how rare triangles that are not Delaunay are, where the correction is left out."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...threaded2d.options import PlaneOptions
from ...threaded2d.virtual_time.costs import Costs
from ...threaded2d.virtual_time.scheduler import simulate
from . import sets
from .costs import SHIPPED_NAME, chosen_costs, described, points_of
from .paper import WRONG
from .report import Row, publish
from .runs import PAPER, note_of, options_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console

WAYS: dict[str, PlaneOptions] = {
    "published": PAPER,
    "outer tested": {**PAPER, "tested": "outer"},
    "head start": {**PAPER, "tested": "outer", "head_start": True},
}


def wrong_triangles(
    out: Path, console: Console, *,
    points: int | str = "10000,50000", seeds: int = 3, elements: str = "2,4,8,16,32",
    data: str = "uniform,cluster", costs: str = SHIPPED_NAME,
) -> list[Row]:  # fmt: skip
    """Kohout et al. 2004, section 3.4: swaps that deadlocks leave undone, per million triangles.

    The circum-circle method in virtual time, means of some seeds: as published; testing only triangles that
    another thread may change; and with a head start too. At the end the swaps are made up for, and counted:
    an illegal edge has a wrong triangle on either side. The paper: no more than five wrong triangles in
    2,000,000. Not on the arc, where the number of swaps may be quadratic.
    """
    names, sizes, counts = data.split(","), sets.sizes(points), sets.sizes(elements)
    table = chosen_costs(costs, [(name, n, 1) for name in names for n in sizes])
    rows: list[Row] = []
    for name in names:
        for n in sizes:
            for count in counts:
                with console.status(f"{name}, {n:,} points, {count} elements ..."):
                    rows.append({"set": name, "points": n, "elements": count})
                    rows[-1] |= _row(name, n, count, seeds, table.of(name, n).costs)

    def draw(axes: Axes) -> None:
        for name in names:
            for n, style in zip(sizes, ("o-", "s--", "^:"), strict=False):
                of_set = [row for row in rows if row["set"] == name and row["points"] == n]
                for way, colour in zip(WAYS, ("C3", "C1", "C0"), strict=True):
                    axes.plot(
                        [row["elements"] for row in of_set], [row[f"swaps, {way}"] for row in of_set],
                        style if name == names[0] else style.replace("o", "v"), color=colour,
                        label=f"{name}, {n:,} points, {way}",
                    )  # fmt: skip
        axes.axhline(
            1e6 * WRONG[0] / WRONG[1], color="0.6", linestyle="--", label="paper: at most 5 in 2,000,000"
        )
        axes.set(xscale="log", xlabel="elements", ylabel="swaps left undone per million triangles")
        axes.set_yscale("symlog", linthresh=1.0)
        axes.set_ylim(bottom=0)
        axes.set_xticks(counts, [str(k) for k in counts])
        axes.minorticks_off()
        axes.figure.legend(loc="outside right upper")

    note = (
        f"{_found(rows)} The paper's at most {WRONG[0]} wrong triangles in {WRONG[1]:,} are "
        f"{1e6 * WRONG[0] / WRONG[1]:g} per million, on up to four processors and up to 1,000,000 points. "
        "Virtual elements never pause inside a step, so deadlocks that need a pause there are missing. "
        f"{note_of(table.source)} Costs: {described(table.of(names[0], sizes[-1]))}."
    )
    publish(
        "kohout-wrong", "Kohout et al. 2004, section 3.4: wrong triangles, per million triangles", rows, out,
        console, draw, note,
    )  # fmt: skip
    return rows


def _row(name: str, n: int, elements: int, seeds: int, costs: Costs) -> Row:
    row: Row = {}
    sites = [points_of(name, n, seed) for seed in range(seeds)]
    for way, own in WAYS.items():
        options = options_of(n, "circumcircle", elements, own)
        runs = [simulate(points, options, elements, costs, count_corrected=True) for points in sites]
        million = 1e6 / np.mean([run.triangles for run in runs])
        row[f"deadlocks, {way}"] = float(million * np.mean([run.exceptions for run in runs]))
        row[f"given up, {way}"] = float(million * np.mean([run.given_up for run in runs]))
        row[f"swaps, {way}"] = float(million * np.mean([run.corrected for run in runs]))
    return row


def _found(rows: list[Row]) -> str:
    parts = []
    for text, of_range in (
        ("up to four elements", [row for row in rows if row["elements"] <= 4]),
        ("more", [row for row in rows if row["elements"] > 4]),
    ):
        for way in WAYS if of_range else ():
            values = [row[f"swaps, {way}"] for row in of_range]
            parts.append(f"{way} with {text} {min(values):.3g} to {max(values):.3g}")
    return f"Swaps left undone per million triangles: {'; '.join(parts)}."
