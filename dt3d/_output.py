"""Tables and pictures, written aside like every file (`dt3d._paths.written_aside`)."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from ._paths import written_aside


def write_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[Any]]) -> None:
    """A line of names, and a line for each row; OSError if they cannot be written."""
    with written_aside(path) as aside, aside.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(header)
        writer.writerows(rows)


def save_figure(figure: Any, path: Path, dpi: float | None = None) -> None:
    """A matplotlib figure as a picture, by the extension; OSError if it cannot be written.

    It is drawn into memory: on a full disk the libraries below would cut a .jpg short without a word, and end
    a .pdf with an error of zlib's.
    """
    picture = io.BytesIO()
    figure.savefig(picture, format=path.suffix[1:].lower(), dpi=figure.dpi if dpi is None else dpi)
    with written_aside(path) as aside:
        # a copy, since a view would outlive an error, and then the buffer complains where nobody hears it
        aside.write_bytes(picture.getvalue())
