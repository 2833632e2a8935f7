"""Figures 9 to 11: points on an arc."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from . import sets
from .by_size import SIZES
from .costs import SHIPPED_NAME, chosen_costs, described
from .report import Row, publish
from .runs import SpeedupSet, lines_over, note_of, threads_for

if TYPE_CHECKING:
    from rich.console import Console


def arc(out: Path, console: Console, *, points: int | str = SIZES, costs: str = SHIPPED_NAME) -> list[Row]:
    """Kohout et al. 2004, Figures 9 to 11: points on an arc, whose narrow triangles have huge circles.

    As published. The paper: batch about 8 % slower than on uniform data; circum-circle on four processors
    slower than sequential for small sets.
    """
    counts = sets.sizes(points)
    table = chosen_costs(costs, [(name, n, 1) for name in ("arc", "uniform") for n in counts])
    rows: list[Row] = []
    for n in counts:
        row: Row = {"points": n}
        given = {name: SpeedupSet(name, sets.DISTRIBUTIONS[name](n), table) for name in ("arc", "uniform")}
        for method in ("batch", "circumcircle"):
            for elements in (2, 4):
                threads = threads_for(method, elements)
                for name, chosen in given.items():
                    label = f"{method} {elements}" + ("" if name == "arc" else ", uniform")
                    row[label] = chosen.virtual(method, threads, elements)
        rows.append(row)
    styles = {column: "o--" if "uniform" in column else "o-" for column in rows[0] if column != "points"}
    slower = [
        f"{100 * (1 - row[f'batch {k}'] / row[f'batch {k}, uniform']):.0f} %" for row in rows for k in (2, 4)
    ]
    small = [f"{row['points']:,}" for row in rows if row["circumcircle 4"] < 1]
    note = (
        f"Batch is slower than on uniform points by {', '.join(slower)} (2 and 4 elements by size); the "
        "paper has about 8 % on average. Circum-circle on four elements is slower than sequential "
        f"{'for ' + ' and '.join(small) + ' points' if small else 'for none of these sizes'}; the paper: for "
        f"small sets. {note_of(table.source)} Costs: {described(table.of('arc', counts[-1]))}."
    )
    publish(
        "kohout-arc", "Kohout et al. 2004, Figs 9-11: arc, as published", rows, out, console,
        lines_over(rows, "points", styles, "speed-up, virtual"), note,
    )  # fmt: skip
    return rows
