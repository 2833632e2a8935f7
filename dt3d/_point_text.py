"""Points from text: columns of numbers, and the formats of chemistry and graphics that are simple text."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np

from ._text_columns import read_columns, read_leading_columns


def read_xyz(path: Path) -> np.ndarray:
    """Points as lines ``x y z ...``, or atoms as in chemistry's XYZ.

    The latter has a line with the count, a comment, and lines ``element x y z ...``. What follows x, y
    and z on a line (colours, normals, charges) is not read.

    Returns
    -------
    float64 (n, 3)

    Raises
    ------
    ValueError
        If the count and the number of lines disagree, or there is more than one frame.
    """
    lines = _text(path).splitlines()
    head = lines[0].split() if lines else []
    chemistry = len(head) == 1 and head[0].isdigit()
    if chemistry:
        count, rows = int(head[0]), [line for line in lines[2:] if line.strip()]
        if len(rows) != count:
            msg = f"{path}: the first line promises {count} atoms, but {len(rows)} lines follow the comment"
            if len(rows) > count and rows[count].strip() == head[0]:
                msg += "; a file of several frames must be split first"
            raise ValueError(msg)
    else:
        rows = [line for line in lines if line.strip() and not line.lstrip().startswith("#")]
    if not rows:
        msg = f"{path} holds no points; expected lines of x y z, or of element x y z"
        raise ValueError(msg)
    # an element may be written as its atomic number, which only the count above gives away
    cells = rows[0].split()
    skip = 1 if not _is_number(cells[0], None) or (chemistry and len(cells) > 3) else 0
    if (found := len(cells) - skip) < 3:
        msg = f"{path}: found {found} coordinates on a line, expected x y z"
        raise ValueError(msg)
    return _numbers(path, rows, None, [skip, skip + 1, skip + 2])


def read_pdb(path: Path) -> np.ndarray:
    """The atoms of a Protein Data Bank file: ATOM and HETATM records of all models, columns 31 to 54.

    Returns
    -------
    float64 (n, 3)
        In ångström.
    """
    rows = [line for line in _text(path).splitlines() if line.startswith(("ATOM  ", "HETATM"))]
    if not rows:
        msg = f"{path} holds no ATOM or HETATM records"
        raise ValueError(msg)
    try:
        return np.array([[float(row[k : k + 8]) for k in (30, 38, 46)] for row in rows])
    except ValueError as error:
        msg = f"{path}: an atom's coordinates (columns 31 to 54) are not numbers: {error}"
        raise ValueError(msg) from None


def read_obj(path: Path) -> np.ndarray:
    """The vertices (``v x y z``) of a Wavefront OBJ file, in double precision.

    Returns
    -------
    float64 (n, 3)
    """
    rows = [line for line in _text(path).splitlines() if line.startswith(("v ", "v\t"))]
    if not rows:
        msg = f"{path} holds no vertices (lines that start with 'v')"
        raise ValueError(msg)
    return _numbers(path, rows, None, [1, 2, 3])


def _text(path: Path) -> str:
    # a spreadsheet's byte-order mark goes; letters of another encoding matter only in comments
    return path.read_text(encoding="utf-8-sig", errors="replace")


def _split(line: str, delimiter: str | None) -> list[str]:
    if delimiter is None:
        return line.split()
    return [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter))]


def _is_number(cell: str, delimiter: str | None) -> bool:
    try:
        float(cell.replace(",", ".") if delimiter == ";" else cell)
    except ValueError:
        return False
    return True


def _numbers(path: Path, rows: list[str], delimiter: str | None, columns: list[int] | None) -> np.ndarray:
    try:
        return np.loadtxt(rows, delimiter=delimiter, usecols=columns, ndmin=2, quotechar='"')
    except ValueError as error:
        # NumPy's sentence names the row and the column
        msg = f"{path}: {str(error).partition(';')[0].rstrip('.')}"
        raise ValueError(msg) from None


TEXT_READERS: dict[str, Callable[[Path], np.ndarray]] = {
    **dict.fromkeys([".csv", ".tsv", ".txt", ".dat"], read_columns),
    ".asc": read_leading_columns,
    ".xyz": read_xyz,
    ".pdb": read_pdb,
    ".obj": read_obj,
}
"""A reader for each extension: takes a Path, gives an array of numbers (n, k)."""
