"""Figure 12, and the paper's open question: how points are shared among threads, on 2 to 64 elements."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from . import sets
from .costs import SHIPPED_NAME, chosen_costs, described, points_of
from .report import Row, publish
from .runs import PAPER, SpeedupSet, note_of, options_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console

KINDS = ("random", "x-slabs", "distance")
SORTED = tuple(f"{kind}, sorted" for kind in KINDS[1:])


def subdivision(
    out: Path, console: Console, *,
    points: int = 50_000, seeds: int = 3, data: str = "uniform", elements: str = "2,4,6,8,16,32,64",
    costs: str = SHIPPED_NAME,
) -> list[Row]:  # fmt: skip
    """Kohout et al. 2004, Figure 12: the subdivision of the input, without and with the time of sorting.

    The circum-circle method as published, in virtual time, means of some seeds. The paper, two processors:
    slabs and distances cost more than they save; it expects better with six, and could not try. The time of
    sorting is that of one selection of a median per site and level of a subdivision into halves, by one
    element, as the master thread makes it.
    """
    names, counts = data.split(","), sets.sizes(elements)
    table = chosen_costs(costs, [(name, points, 1) for name in names])
    rows: list[Row] = []
    for name in names:
        given = [SpeedupSet(name, points_of(name, points, seed), table) for seed in range(seeds)]
        rows += [{"set": name, "elements": count} | _row(given, count) for count in counts]
    one = [row for row in rows if row["set"] == names[0]]

    def draw(axes: Axes) -> None:
        for column, style in {
            KINDS[0]: "o-",
            KINDS[1]: "s-",
            KINDS[2]: "^-",
            SORTED[0]: "s:",
            SORTED[1]: "^:",
        }.items():
            axes.plot([row["elements"] for row in one], [row[column] for row in one], style, label=column)
        axes.plot(counts, counts, color="0.8", label="linear")
        axes.set(xscale="log", yscale="log", xlabel="elements", ylabel=f"circum-circle, speed-up, {names[0]}")
        axes.set_xticks(counts, [str(k) for k in counts])
        axes.minorticks_off()
        axes.legend()

    publish(
        "kohout-subdivision", f"Kohout et al. 2004, Fig. 12: subdivision of {points:,} points", rows,
        out, console, draw, f"{_found(rows)} {seeds} seeds. {note_of(table.source)} Costs: "
        + "; ".join(described(table.of(name, points)) for name in names) + ".",
    )  # fmt: skip
    return rows


def _row(given: list[SpeedupSet], elements: int) -> Row:
    """Mean speed-ups of each kind, without and with the time of sorting, and deadlocks per million sites."""
    row: Row = {}
    n = len(given[0].points)
    found = given[0].table.of(given[0].name, n)
    sorting = found.select * n * np.log2(elements)
    deadlocks = {}
    for kind in KINDS:
        options = options_of(n, "circumcircle", elements, PAPER, subdivision=kind)
        runs = [(one.alone, one.simulated(options, elements)) for one in given]
        row[kind] = float(np.mean([alone / run.seconds for alone, run in runs]))
        deadlocks[kind] = 1e6 * float(np.mean([run.exceptions for _, run in runs])) / n
        if kind != "random":
            row[f"{kind}, sorted"] = float(np.mean([alone / (run.seconds + sorting) for alone, run in runs]))
    for kind in KINDS[:2]:
        row[f"deadlocks per 10^6, {kind}"] = deadlocks[kind]
    row["paper"] = "random best" if elements == 2 else ("open" if elements > 4 else "")
    return row


def _found(rows: list[Row]) -> str:
    """From how many elements on slabs are better, in words."""
    parts = []
    for name in dict.fromkeys(row["set"] for row in rows):
        of_set = [row for row in rows if row["set"] == name]
        for column in ("x-slabs", "x-slabs, sorted"):
            better = [str(row["elements"]) for row in of_set if row[column] > row["random"]]
            parts.append(
                f"{name}, {column}: better than random on {', '.join(better) if better else 'no number of'} "
                "elements"
            )
    return "; ".join(parts) + "."
