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
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from rich.console import Console

DPI = 200  # of pictures, and of what is rasterized in a PDF

# points, for a figure that is printed at the size it has, or somewhat smaller
TITLE, LABEL, SMALL = 10.0, 9.0, 8.0
LINE, MARKER, FRAME = 1.2, 4.0, 0.6
MOST_VECTORS = 20_000  # marks of one artist; a PDF with more is slow to show


def publish(
    console: Console,
    out: Path,
    name: str,
    header: Sequence[str],
    rows: Iterable[Sequence[object]],
    figure: Figure,
    dpi: float = DPI,
) -> None:
    """Write ``name``.csv, ``name``.png and ``name``.pdf to the folder ``out``, and say so.

    The figure gets the style of `style`. OSError if a file cannot be written.
    """
    table, *pictures = written(out, name)
    write_csv(table, header, rows)
    style(figure)
    for picture in pictures:
        save_figure(figure, picture, dpi)
    names = [str(table), *map(str, pictures)]
    console.print(f"wrote {', '.join(names[:-1])} and {names[-1]}", markup=False, soft_wrap=True)


def written(out: Path, name: str) -> tuple[Path, Path, Path]:
    """The files that `publish` writes: the table, and the picture as PNG and as PDF."""
    return out / f"{name}.csv", out / f"{name}.png", out / f"{name}.pdf"


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


def style(figure: Figure) -> None:
    """One modest style for print: sizes of letters, widths of lines, no frame above and to the right.

    It is given to a finished figure, as settings of matplotlib would be those of the whole process. What a
    drawing has chosen itself, such as the size of its markers, stays.
    """
    chosen = optional("matplotlib", "a picture").rcParams
    for axes in figure.axes:
        axes.title.set_fontsize(TITLE)
        for axis in (axes.xaxis, axes.yaxis):
            axis.label.set_fontsize(LABEL)
            axis.set_tick_params(which="major", labelsize=SMALL, width=FRAME)
        for side, spine in axes.spines.items():
            spine.set_linewidth(FRAME)
            if side in ("top", "right"):
                spine.set_visible(False)
        for line in axes.lines:
            if line.get_linewidth() == chosen["lines.linewidth"]:
                line.set_linewidth(LINE)
            if line.get_markersize() == chosen["lines.markersize"]:
                line.set_markersize(MARKER)
        for artist in (*axes.lines, *axes.collections):
            if _marks(artist) > MOST_VECTORS:
                artist.set_rasterized(True)
        _shrink_legends(axes)
    for legend in figure.legends:
        for text in legend.get_texts():
            text.set_fontsize(SMALL)


def _shrink_legends(axes: Axes) -> None:
    legend = axes.get_legend()
    if legend is not None:
        legend.get_frame().set_linewidth(FRAME)
        for line in legend.get_lines():
            line.set_linewidth(min(LINE, line.get_linewidth()))
        for text in legend.get_texts():
            text.set_fontsize(SMALL)


def _marks(artist: Artist) -> int:
    """The points of a line, or the faces or places of a collection."""
    for name in ("get_xdata", "get_facecolors", "get_offsets"):
        if hasattr(artist, name):
            return len(getattr(artist, name)())
    return 0


def save_figure(figure: Figure, path: Path, dpi: float | None = None) -> None:
    """A matplotlib figure as a picture, by the extension; OSError if it cannot be written.

    It is drawn into memory: on a full disk the libraries below would cut a .jpg short without a word, and end
    a .pdf with an error of zlib's. A .pdf has letters that can be searched, and no date: the same figure
    gives the same file.
    """
    picture = io.BytesIO()
    kind = path.suffix[1:].lower()
    with optional("matplotlib", "a picture").rc_context({"pdf.fonttype": 42}):
        figure.savefig(
            picture,
            format=kind,
            dpi=figure.dpi if dpi is None else dpi,
            metadata={"CreationDate": None} if kind == "pdf" else None,
        )
    with written_aside(path) as aside:
        # a copy, since a view would outlive an error, and then the buffer complains where nobody hears it
        aside.write_bytes(picture.getvalue())
