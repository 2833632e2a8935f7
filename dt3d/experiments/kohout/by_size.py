"""Figures 4, 5 and 7, Tables 2 and 3: speed-ups by number of points, and of searching threads."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ..._numba.cores import available_cores
from ...threaded2d.configuration import searching_threads
from . import sets
from .busy import warn_if_busy
from .costs import SHIPPED_NAME, chosen_costs, described, points_of
from .paper import BATCH, CIRCUMCIRCLE, ON_FOUR
from .report import Row, publish
from .runs import SEARCHING, SpeedupSet, lines_over, note_of, threads_for

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console

SIZES = "1000,5000,10000,50000,100000"
REAL = {"crater"}  # sets that are not generated


PAPER_STYLES = {"paper P 410, 2": "x:", "paper PE 6400, 2": "+:"}


def _on_four(method: str, data: str) -> str:
    """What the paper has on four processors, as a sentence."""
    low, high = ON_FOUR[method][data in REAL]
    return f"The paper on four processors: {low} to {high} for {'real' if data in REAL else 'uniform'} data."


def _of_paper(paper: Mapping[int, tuple[float | None, ...]], n: int, data: str) -> Row:
    known = paper.get(n) if data == "uniform" else None
    return {
        "paper P 410, 2": known[1] if known else None,
        "paper PE 6400, 2": known[2] if known else None,
    }


def batch(
    out: Path, console: Console, *,
    points: int | str = SIZES, repeats: int = 5, data: str = "uniform", costs: str = SHIPPED_NAME,
) -> list[Row]:  # fmt: skip
    """Kohout et al. 2004, Figures 4 and 5, Table 2: the batch method as published, by searching threads.

    2 to 4 searching threads on two virtual elements, 2 to 6 on four; three on this machine. ``data`` is a
    distribution, or crater: real data, of which a part is taken.
    """
    warn_if_busy(console)
    counts = sets.sizes(points)
    table = chosen_costs(costs, [(data, n, 1) for n in counts])
    rows: list[Row] = []
    for n in counts:
        given = SpeedupSet(data, points_of(data, n), table)
        row: Row = {"points": len(given.points)}
        for elements, most in ((2, 4), (4, 6)):
            for searching in range(2, most + 1):
                row[f"{searching}:1 on {elements}"] = given.virtual("batch", searching + 1, elements)
        here = given.measured("batch", SEARCHING + 1, repeats)
        row |= {"measured 3:1": here.median, "quartiles": here.quartiles}
        rows.append(row | _of_paper(BATCH, n, data))
    styles = {f"{k}:1 on 2": "o-" for k in (2, 3, 4)} | {f"{k}:1 on 4": "s--" for k in range(2, 7)}
    styles |= {"measured 3:1": "^-"} | PAPER_STYLES
    note = (
        f"{_on_four('batch', data)} "
        f"On four this package takes {searching_threads(5000, 4)}:1 from 5,000 points on, as section 4.2 "
        f"says. {note_of(table.source, repeats)} Costs: {described(table.of(data, counts[-1]))}."
    )
    title = f"Kohout et al. 2004, Figs 4 and 5, Table 2: batch as published, {data} points"
    publish("kohout-batch", title, rows, out, console, lines_over(rows, "points", styles, "speed-up"), note)
    return rows


def circumcircle(
    out: Path, console: Console, *,
    points: int | str = SIZES + ",1000000", repeats: int = 5, data: str = "uniform",
    costs: str = SHIPPED_NAME,
) -> list[Row]:  # fmt: skip
    """Kohout et al. 2004, Figure 7, Table 3: the circum-circle method as published, by number of points.

    On 2, 4 and 8 virtual elements, and on this machine. ``data`` is a distribution, or crater: real data.
    """
    warn_if_busy(console)
    counts = sets.sizes(points)
    table = chosen_costs(costs, [(data, n, 1) for n in counts])
    rows: list[Row] = []
    for n in counts:
        given = SpeedupSet(data, points_of(data, n), table)
        row: Row = {"points": len(given.points)}
        for elements in (2, 4, 8):
            row[f"virtual {elements}"] = given.virtual("circumcircle", elements, elements)
        here = given.measured("circumcircle", threads_for("circumcircle", available_cores()), repeats)
        row |= {"measured": here.median, "quartiles": here.quartiles}
        rows.append(row | _of_paper(CIRCUMCIRCLE, n, data))
    styles = {f"virtual {k}": "o-" for k in (2, 4, 8)} | {"measured": "^-"} | PAPER_STYLES
    note = (
        f"{_on_four('circumcircle', data)} "
        f"{note_of(table.source, repeats)} Costs: {described(table.of(data, counts[-1]))}."
    )
    title = f"Kohout et al. 2004, Fig. 7, Table 3: circum-circle as published, {data} points"
    publish(
        "kohout-circumcircle", title, rows, out, console, lines_over(rows, "points", styles, "speed-up"), note
    )
    return rows


def end_of_batch(
    out: Path, console: Console, *,
    points: int = 200_000, data: str = "uniform,grid", elements: str = "2,4,6,8,12,16",
    costs: str = SHIPPED_NAME,
) -> list[Row]:  # fmt: skip
    """Beyond the paper: how many elements the batch method can use, by searching threads; virtual time.

    One specialised thread makes all changes. So the speed-up cannot exceed the sequential time over that of
    the changes, which is printed beside.
    """
    names, counts = data.split(","), sets.sizes(elements)
    table = chosen_costs(costs, [(name, points, 1) for name in names])
    rows: list[Row] = []
    bounds = {}
    for name in names:
        given = SpeedupSet(name, points_of(name, points), table)
        bounds[name] = bound = _bound(given)
        for count in counts:
            row: Row = {"set": name, "elements": count}
            for searching in (2, 3, 4, 6, 8, 12):
                row[f"{searching}:1"] = given.virtual("batch", searching + 1, count)
            best = max(value for column, value in row.items() if ":" in column)
            rows.append(row | {"best": best, "bound": bound})

    def draw(axes: Axes) -> None:
        for name in names:
            of_set = [row for row in rows if row["set"] == name]
            (line,) = axes.plot(
                [row["elements"] for row in of_set], [row["best"] for row in of_set], "o-", label=name
            )
            axes.axhline(bounds[name], color=line.get_color(), linestyle=":", label=f"{name}, bound")
        axes.set(xlabel="elements", ylabel="speed-up, best number of searching threads", ylim=(0, None))
        axes.legend()

    found = "; ".join(
        f"{name}: {max(row['best'] for row in rows if row['set'] == name):.2f} at most, bound {bound:.2f}"
        for name, bound in bounds.items()
    )
    note = (
        f"{found}. The bound is the sequential time over that of the specialised thread alone: its changes "
        "and an element taken per site. A second specialised thread, on another half of the points, is not "
        "tried. "
        f"{note_of(table.source)}"
    )
    title = f"Kohout et al. 2004, section 4.2: where batch ends, {points:,} points"
    publish("kohout-batch-end", title, rows, out, console, draw, note)
    return rows


def _bound(given: SpeedupSet) -> float:
    """The sequential time over that of the changes, and of the elements taken from the queue."""
    n = len(given.points)
    run = given.simulated(given.sequential, 1)
    found = given.table.of(given.name, n).costs
    changes = run.seconds - found.visit * sum(run.visited) + found.get * sum(run.inserted)
    return run.seconds / changes
