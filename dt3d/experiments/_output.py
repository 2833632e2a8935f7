"""What every experiment writes: a CSV, and a picture without a screen."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import scanvec as sv

from .._output import save_figure, write_csv

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

__all__ = ["new_table", "off", "panels", "print_model", "save_figure", "write_csv", "wrote"]


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


def panels(count: int, width: float = 5.0) -> tuple[Any, list[Any]]:
    """A figure, and axes side by side."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width * count, 3.8), layout="constrained")
    FigureCanvasAgg(figure)
    return figure, list(figure.subplots(1, count, squeeze=False)[0])


def print_model(console: Console, model: sv.Model) -> None:
    """A model's constants and where each is from."""
    console.print(str(model), markup=False, soft_wrap=True)


def wrote(console: Console, out: Path, name: str) -> None:
    console.print(f"wrote {out / name}.csv and {out / name}.png", markup=False)


def off(value: float, paper: float) -> float:
    """Relative deviation from the paper's value."""
    return value / paper - 1
