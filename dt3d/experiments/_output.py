"""What the experiments print, and the figures that they draw on."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import scanvec as sv

from .._output import new_figure, publish

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from rich.console import Console
    from rich.table import Table

__all__ = ["new_table", "off", "panels", "print_model", "publish"]


def new_table(title: str, texts: Iterable[str], numbers: Iterable[str]) -> Table:
    """A table with columns of texts and of numbers, none of which is cut where a screen is narrow."""
    from rich.box import SIMPLE
    from rich.table import Table

    table = Table(title=title, box=SIMPLE)
    for column in texts:
        table.add_column(column, no_wrap=True)
    for column in numbers:
        table.add_column(column, justify="right", overflow="fold")
    return table


def panels(count: int, width: float = 5.0) -> tuple[Figure, list[Axes]]:
    """A figure, and axes side by side."""
    figure = new_figure(width * count, 3.8)
    return figure, list(figure.subplots(1, count, squeeze=False)[0])


def print_model(console: Console, model: sv.Model) -> None:
    """A model's constants and where each is from."""
    console.print(str(model), markup=False, soft_wrap=True)


def off(value: float, paper: float) -> float:
    """Relative deviation from the paper's value."""
    return value / paper - 1
