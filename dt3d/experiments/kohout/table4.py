"""Table 4: the methods compared."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from . import sets
from .busy import warn_if_busy
from .costs import SHIPPED_NAME, chosen_costs, described
from .paper import TABLE4
from .report import Row, publish
from .runs import SpeedupSet, note_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console


def table4(
    out: Path, console: Console, *, points: int = 100_000, repeats: int = 5, costs: str = SHIPPED_NAME
) -> list[Row]:
    """Kohout et al. 2004, Table 4: the methods as published, about 100,000 uniform points, on 2 and 4.

    Hardwick's algorithm is another one, and only the paper's values are printed.
    """
    warn_if_busy(console)
    table = chosen_costs(costs, [("uniform", points, 1)])
    given = SpeedupSet("uniform", sets.uniform(points), table)
    rows: list[Row] = []
    for method, (two, four) in TABLE4.items():
        row: Row = {"method": method, "paper 2": two, "paper 4": four}
        if method == "Hardwick":
            row |= dict.fromkeys(("virtual 2", "virtual 4", "measured"), None) | {"quartiles": ""}
            row["off the paper's 4, %"] = None
        else:
            row |= given.row(method, repeats)
            row["off the paper's 4, %"] = 100 * (row["virtual 4"] / four - 1)
        rows.append(row)

    def draw(axes: Axes) -> None:
        for k, column in enumerate(("paper 2", "virtual 2", "measured", "paper 4", "virtual 4")):
            axes.bar(
                [i + 0.15 * k for i in range(len(rows))],
                [row[column] or 0 for row in rows],
                0.14,
                label=column,
            )
        axes.set_xticks([i + 0.3 for i in range(len(rows))], [row["method"] for row in rows])
        axes.set(ylabel="speed-up")
        axes.figure.legend(loc="outside upper center", ncols=5)

    note = f"{note_of(table.source, repeats)} Costs: {described(table.of('uniform', points))}."
    publish(
        "kohout-table4", "Kohout et al. 2004, Table 4: methods as published", rows, out, console, draw, note
    )
    return rows
