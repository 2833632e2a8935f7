"""Tables and pictures, written aside like every file (`dt3d._paths.written_aside`)."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ._optional import optional
from ._paths import written_aside

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.console import Console


def publish(
    console: Console,
    out: Path,
    name: str,
    header: Sequence[str],
    rows: Iterable[Sequence[object]],
    figure: Figure,
    dpi: float = 120,
) -> None:
    """Write ``name``.csv and ``name``.png to the folder ``out``, and say so; OSError if that fails."""
    table, picture = written(out, name)
    write_csv(table, header, rows)
    save_figure(figure, picture, dpi)
    console.print(f"wrote {table} and {picture}", markup=False)


def written(out: Path, name: str) -> tuple[Path, Path]:
    """The files that `publish` writes: the table and the picture."""
    return out / f"{name}.csv", out / f"{name}.png"


def write_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """A line of names, and a line for each row; OSError if they cannot be written."""
    with written_aside(path) as aside, aside.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        writer.writerows(rows)


def new_figure(width: float, height: float, purpose: str = "a picture") -> Figure:
    """A figure of matplotlib, its size in inches, without a window.

    Raises ImportError, saying what to install and for which purpose, where matplotlib is missing.
    """
    backend = optional("matplotlib.backends.backend_agg", purpose)
    figure: Figure = optional("matplotlib.figure", purpose).Figure(
        figsize=(width, height), layout="constrained"
    )
    backend.FigureCanvasAgg(figure)
    return figure


def save_figure(figure: Figure, path: Path, dpi: float | None = None) -> None:
    """A matplotlib figure as a picture, by the extension; OSError if it cannot be written.

    It is drawn into memory: on a full disk the libraries below would cut a .jpg short without a word, and end
    a .pdf with an error of zlib's.
    """
    picture = io.BytesIO()
    figure.savefig(picture, format=path.suffix[1:].lower(), dpi=figure.dpi if dpi is None else dpi)
    with written_aside(path) as aside:
        # a copy, since a view would outlive an error, and then the buffer complains where nobody hears it
        aside.write_bytes(picture.getvalue())
