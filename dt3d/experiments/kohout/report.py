"""What the experiments leave behind: a table on the screen, the same as CSV, a picture."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ... import _output
from ..._output import new_figure
from ..._table import Sheet

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from rich.console import Console

Row = dict[str, Any]


def publish(
    name: str,
    title: str,
    rows: Sequence[Row],
    out: Path,
    console: Console,
    draw: Callable[[Axes], None],
    note: str,
) -> None:
    """Print rows, whose keys are the columns, and write ``name``.csv, .png and .pdf into ``out``.

    ``draw`` gets empty matplotlib axes. ``note`` says what the numbers are, and what is not comparable.
    """
    out.mkdir(parents=True, exist_ok=True)
    columns = list(rows[0])
    table = Sheet(title, columns, [c for c in columns if isinstance(rows[0][c], str)])
    for row in rows:
        table.add_row(*(_text(row[c]) for c in columns))
    table.show(console)
    console.print(note, markup=False)
    figure = new_figure(7, 4.5)
    draw(figure.add_subplot())
    _output.publish(console, out, name, columns, [[row[c] for c in columns] for row in rows], figure)


def _text(value: object) -> str:
    if value is None:
        return ""
    return f"{value:#.3g}".removesuffix(".") if isinstance(value, float) else str(value)
