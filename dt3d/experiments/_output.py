"""What the experiments print, and the figures that they draw on."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import scanvec as sv

from .._output import new_figure, publish
from .._table import Sheet

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from rich.console import Console

__all__ = ["new_table", "off", "panels", "print_model", "publish"]


def new_table(title: str, texts: Iterable[str], numbers: Iterable[str]) -> Sheet:
    """A table with columns of texts and of numbers, none of which is cut where a screen is narrow."""
    texts = list(texts)
    return Sheet(title, [*texts, *numbers], texts, keep=max(1, len(texts)))


def panels(count: int, width: float = 4.2) -> tuple[Figure, list[Axes]]:
    """A figure, and axes of so many inches: at most two side by side, as more would be small in print."""
    columns, lines = min(count, 2), -(-count // 2)
    figure = new_figure(width * columns, 3.8 * lines)
    axes = list(figure.subplots(lines, columns, squeeze=False).flat)
    for extra in axes[count:]:
        extra.remove()
    return figure, axes[:count]


def print_model(console: Console, model: sv.Model) -> None:
    """A model's constants and where each is from."""
    console.print(str(model), markup=False, soft_wrap=True)


def off(value: float, paper: float) -> float:
    """Relative deviation from the paper's value."""
    return value / paper - 1
