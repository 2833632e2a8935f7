"""Points or atoms of .xyz: plain columns, chemistry's XYZ, and extended XYZ."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .point_data import PointData
from .text_cells import is_number, split
from .text_columns import columns_of, delimiter_of
from .text_header import is_header
from .text_lines import Lines, content, read_lines, shown
from .text_numbers import decimal_mark, numbers
from .text_values import keep_columns

_COUNT = re.compile(r"[0-9]{1,18}")
_LABEL = re.compile(r"[^\W\d_][\w+\-*']*")
_ATOMIC_NUMBER = re.compile(r"[0-9]{1,3}")
_PROPERTIES = re.compile(r'\bProperties\s*=\s*("[^"]*"|\S+)', re.IGNORECASE)


def read_xyz(path: Path, keep: PointData | None = None) -> np.ndarray:
    """Points as lines ``x y z ...``, or atoms as in chemistry's XYZ.

    The latter has a line with the count, a comment, and lines ``element x y z ...``; the comment may say
    where the positions are, as extended XYZ does (``Properties=species:S:1:pos:R:3``). A count may also be
    followed by points at once. What follows x, y and z on a line (colours, normals, charges) are no
    coordinates; a header may name the columns. ``keep`` gets what has a name, and labels as ``element``.

    Returns
    -------
    float64 (n, 3)

    Raises
    ------
    ValueError
        If the count and the number of lines disagree, there is more than one frame, or a row is not like the
        first.
    """
    lines = read_lines(path)
    rows = content(lines)
    if not len(rows):
        msg = f"{path} holds no points; expected lines of x y z, or of element x y z"
        raise ValueError(msg)
    if _COUNT.fullmatch(rows.text[0].strip()):
        return _counted(lines[rows.numbers[0] - 1 :], keep)
    cells = _cells(rows, 0)
    if not is_number(cells[0]) and not is_number(cells[0], ",") and not is_header(cells):
        return _atoms(rows, keep, labelled=True)
    points = columns_of(lines, leading=True, keep=keep)
    if points.shape[1] != 3:
        msg = f"{path}: found {points.shape[1]} coordinates on a line, expected x y z"
        raise ValueError(msg)
    return points


def _counted(lines: Lines, keep: PointData | None) -> np.ndarray:
    """The points behind a count: a comment and then as many rows, or the rows at once."""
    count, rest = int(lines.text[0]), lines[1:]
    if not count or not len(rest):
        msg = f"{lines.path} holds no points; its first line promises {count}"
        raise ValueError(msg)
    comment = rest.text[0]
    rows = rest.with_text([k for k, line in enumerate(rest.text) if k and line.strip()])
    like_a_row = _is_row_like(comment, rows.text[0] if len(rows) else None)
    if like_a_row and len(rows) == count - 1:
        rows = rest.with_text([k for k, line in enumerate(rest.text) if line.strip()])
    elif len(rows) != count:
        msg = f"{lines.path}: the first line promises {count} atoms, but {len(rows)} lines follow the comment"
        if len(rows) > count and rows.text[count].strip() == lines.text[0].strip():
            msg += "; a file of several frames must be split first"
        raise ValueError(msg)
    elif like_a_row:
        msg = f"{shown(comment)} stands where the comment should, and looks like one row more than promised"
        raise rest.error(0, msg)
    elif properties := _PROPERTIES.search(comment):
        return _extended(rows, properties[1].strip('"'), keep)

    first = [row.replace(",", " ").replace(";", " ").split()[:1] for row in rows.text]
    labels = [cell[0] if cell else "" for cell in first]
    # an element may be written as its atomic number, which only the count gives away
    labelled = len(_cells(rows, 0)) > 3 and all(
        _LABEL.fullmatch(label) or _ATOMIC_NUMBER.fullmatch(label) for label in labels
    )
    return _atoms(rows, keep, labelled=labelled or not is_number(_cells(rows, 0)[0]))


def _atoms(rows: Lines, keep: PointData | None, *, labelled: bool) -> np.ndarray:
    """Rows of x y z, or of label x y z where they are labelled."""
    delimiter, width, skip = delimiter_of(rows.text[0]), len(_cells(rows, 0)), int(labelled)
    if labelled:
        for k in range(len(rows)):
            label = _cells(rows, k)[0]
            if not _LABEL.fullmatch(label) and not _ATOMIC_NUMBER.fullmatch(label):
                msg = f"{shown(label)} is not an element or a label"
                raise rows.error(k, msg, 1)
    if width < skip + 3:
        msg = f"found {width - skip} coordinates on a line, expected x y z"
        raise rows.error(0, msg)
    columns = [skip, skip + 1, skip + 2]
    decimal = decimal_mark(rows, delimiter, columns)
    found = numbers(rows, delimiter, columns, width, decimal)
    if keep is not None and labelled:
        keep_columns(rows, delimiter, ["element"], [], decimal, keep)
    if keep is not None and width > skip + 3:
        keep.leave_out(f"columns {skip + 4} to {width}", "they have no names")
    return found


def _extended(rows: Lines, properties: str, keep: PointData | None) -> np.ndarray:
    """The positions where ``name:type:number of columns:...`` puts them."""
    fields = properties.split(":")
    start, columns = 0, None
    names: list[str] = []
    for name, kind, count in zip(fields[::3], fields[1::3], fields[2::3], strict=False):
        if not _ATOMIC_NUMBER.fullmatch(count):
            break
        if name.lower() in ("pos", "positions") and kind.upper() in ("R", "I") and count == "3":
            columns = [start, start + 1, start + 2]
        start += int(count)
        names += [name] if count == "1" else [f"{name}_{axis}" for axis in range(int(count))]
    else:
        if columns and len(fields) % 3 == 0:
            found = numbers(rows, None, columns, start)
            if keep is not None:
                keep_columns(rows, None, names, columns, ".", keep)
            return found
    msg = f"{rows.path}: Properties={shown(properties)} should have pos:R:3 among name:type:count"
    raise ValueError(msg)


def _cells(rows: Lines, k: int) -> list[str]:
    try:
        return split(rows.text[k], delimiter_of(rows.text[k]))
    except ValueError as error:
        raise rows.error(k, str(error)) from None


def _is_row_like(line: str, other: str | None) -> bool:
    """Whether two lines have numbers in the same cells; without another, whether it has three or a label."""
    kinds = _kinds(line)
    if other is None:
        return kinds[:3] == [True] * 3 or kinds[:4] == [False, True, True, True]
    return bool(kinds) and kinds == _kinds(other)


def _kinds(line: str) -> list[bool]:
    return [is_number(cell) or is_number(cell, ",") for cell in line.split(delimiter_of(line))]
