"""Columns of a table beside the coordinates: whole numbers, numbers or text, as their cells tell."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .point_data import PointData
from .text_cells import WHOLE, is_missing, is_number, number, split
from .text_lines import Lines


def keep_columns(
    rows: Lines,
    delimiter: str | None,
    names: Sequence[str],
    used: Sequence[int],
    decimal: str,
    keep: PointData,
) -> None:
    """Enter the columns of a table that are not used as coordinates.

    Parameters
    ----------
    rows : Lines
        Each has a cell for each name at least, as `numbers` has found out.
    delimiter : str or None
        Between cells; None for white space.
    names : sequence of str
        Of the columns; those without one are left out.
    used : sequence of int
        The columns that are coordinates, counted from 0.
    decimal : "." or ","
        What parts whole numbers from fractions.
    keep : PointData
        Gets the columns.
    """
    wanted = [j for j in range(len(names)) if j not in used]
    if not wanted:
        return
    if any('"' in line for line in rows.text):
        cells = [split(line, delimiter) for line in rows.text]
    else:  # in half of the time
        cells = [line.split(delimiter) for line in rows.text]
    for j in wanted:
        column = [row[j] for row in cells]
        if names[j]:
            keep.add(names[j], values_of(column, decimal))
        elif j or not _counts(column):  # pandas' index has no name
            keep.leave_out(f"column {j + 1}", "it has no name")


def values_of(cells: Sequence[str], decimal: str = ".") -> np.ndarray:
    """A column: int64 or uint64 where all cells are whole numbers, float64 where all are numbers, else text.

    A cell that says that its value is missing is NaN among numbers.

    Examples
    --------
    >>> values_of(["1", "2"]), values_of(["1", "2.5", ""]), values_of(["1", "C"]).tolist()
    (array([1, 2]), array([1. , 2.5, nan]), ['1', 'C'])
    """
    text = "".join(cells)
    # Python takes 1_000 and digits of other scripts for numbers
    if text.isascii() and "_" not in text:
        for kind in (np.int64, np.uint64):
            try:
                return np.array(list(map(int, cells)), kind)
            except (ValueError, OverflowError):
                continue
        try:
            return _as_numbers(cells, decimal)
        except ValueError:
            pass
    return np.array([cell.strip() for cell in cells], np.str_)


def _as_numbers(cells: Sequence[str], decimal: str) -> np.ndarray:
    """The cells as float64; a ValueError for one that is no number, or that float64 does not hold."""
    try:
        found = np.array(list(map(float, cells)))
    except ValueError:
        cells = [cell.strip() for cell in cells]
        known = [cell for cell in cells if is_number(cell, decimal)]
        if len(known) + sum(map(is_missing, cells)) < len(cells):
            msg = "text among numbers"
            raise ValueError(msg) from None
        return np.array([np.nan if is_missing(cell) else number(cell, decimal) for cell in cells])
    for k in np.flatnonzero(np.abs(found) >= WHOLE).tolist():
        number(cells[k].strip(), decimal)
    return found


def _counts(cells: Sequence[str]) -> bool:
    cells = [cell.strip() for cell in cells]
    return any(cells == [str(k + start) for k in range(len(cells))] for start in (0, 1))
