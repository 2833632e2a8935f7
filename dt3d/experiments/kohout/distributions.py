"""Figures 6 and 8: the methods as published and as they are by default, on five distributions."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from ..._numba.cores import available_cores
from .busy import warn_if_busy
from .costs import SHIPPED_NAME, chosen_costs, described, points_of
from .paper import BATCH, BETWEEN_DISTRIBUTIONS, CIRCUMCIRCLE, ON_FOUR, TABLE4
from .report import Row, publish
from .runs import OURS, PAPER, SpeedupSet, note_of, threads_for
from .sets import DISTRIBUTIONS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console

METHODS = ("batch", "circumcircle", "optimistic")
ELEMENTS = (2, 4, 8)
WAYS = {"published": PAPER, "default": OURS}


def _of_paper(method: str, n: int, name: str) -> Row:
    """What the paper has for uniform points on a PE 6400; the others are curves only."""
    if name != "uniform":
        return {"paper, 2": "", "paper, 4": ""}
    two, four = TABLE4.get(method, (None, None))
    tables: dict[str, Mapping[int, tuple[float | None, ...]]] = {
        "batch": BATCH, "circumcircle": CIRCUMCIRCLE,
    }  # fmt: skip
    known = tables[method].get(n) if method in tables else None
    low, high = ON_FOUR[method][0] if method in ON_FOUR else (four, four)
    return {
        "paper, 2": f"{known[2] if known else two}",
        "paper, 4": f"{low}-{high}" if low != high else f"{low}",
    }


def preset(
    out: Path, console: Console, *,
    points: int = 50_000, repeats: int = 5, distributions: str = "", costs: str = SHIPPED_NAME,
) -> list[Row]:  # fmt: skip
    """Kohout et al. 2004, Figures 6 and 8: preset="kohout2004" beside the default, on five distributions.

    Real threads on this machine, and 2, 4 and 8 virtual elements; all in random order. The speed-up of
    interleaved searches in one thread stands beside, so that what threads give is told apart from what
    interleaving gives.
    """
    warn_if_busy(console)
    names = distributions.split(",") if distributions else list(DISTRIBUTIONS)
    table = chosen_costs(costs, [(name, points, k) for name in names for k in (1, 8)])
    rows: list[Row] = []
    processors = available_cores()
    for name in names:
        with console.status(f"{name} ..."):
            given = SpeedupSet(name, points_of(name, points), table)
            lanes = given.measured("sequential", 1, repeats, {"interleave": 8})
            for method in METHODS:
                threads = threads_for(method, processors)
                row: Row = {"set": name, "method": method}
                for way, options in WAYS.items():
                    here = given.measured(method, threads, repeats, options)
                    row |= {f"{way} measured": here.median, f"{way} quartiles": here.quartiles}
                row["interleaving alone"] = lanes.median if method != "optimistic" else 1.0
                row["threads alone"] = row["default measured"] / row["interleaving alone"]
                for way, options in WAYS.items():
                    for elements in ELEMENTS:
                        row[f"{way} virtual {elements}"] = given.virtual(
                            method, threads_for(method, elements), elements, options
                        )
                rows.append(row | _of_paper(method, points, name))

    def draw(axes: Axes) -> None:
        places = [i + 0.4 * (i // len(METHODS)) for i in range(len(rows))]
        columns = ["published measured", "default measured", *(f"published virtual {k}" for k in ELEMENTS)]
        for k, column in enumerate(columns):
            axes.bar([x + 0.17 * (k - 2) for x in places], [row[column] for row in rows], 0.16, label=column)
        ticks = [
            f"{row['method']}\n{row['set']}" if i % 3 == 1 else row["method"] for i, row in enumerate(rows)
        ]
        axes.set_xticks(places, ticks, rotation=90)
        axes.set(ylabel="speed-up over sequential")
        axes.figure.legend(loc="outside upper center", ncols=3)

    publish(
        "kohout-preset",
        f"Kohout et al. 2004, Figs 6 and 8: as published and by default, {points:,} points",
        rows, out, console, draw, _note(rows, table.source, repeats) + " Costs: "
        + "; ".join(described(table.of(name, points)) for name in names) + ".",
    )  # fmt: skip
    return rows


def _note(rows: list[Row], source: str, repeats: int) -> str:
    """Differences between distributions, ours and the paper's."""
    parts = []
    for method, (two, four) in BETWEEN_DISTRIBUTIONS.items():
        for elements, of_paper in ((2, two), (4, four)):
            values = [
                row[f"published virtual {elements}"]
                for row in rows
                if row["method"] == method and row["set"] != "arc"
            ]
            spread = 100 * (max(values) / min(values) - 1) if values else 0.0
            parts.append(f"{method} on {elements}: {spread:.0f} % (paper {of_paper:g} %)")
    return (
        "'published': preset='kohout2004'; 'default': interleaved searches, shared parts, a head start. "
        "'interleaving alone': one thread, eight searches, over one search; 'threads alone': the rest. "
        f"Largest difference between distributions, without the arc, virtual: {', '.join(parts)}. "
        f"{note_of(source, repeats)}"
    )
