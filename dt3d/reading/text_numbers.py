"""Rows of text into an array: by NumPy's compiled reader where it suffices, else cell by cell."""

from __future__ import annotations

import csv

import numpy as np

from .text_cells import DECIMAL_COMMA, THOUSANDS, WHOLE, number, split
from .text_lines import Lines, shown


def numbers(
    rows: Lines, delimiter: str | None, columns: list[int], width: int, decimal: str = "."
) -> np.ndarray:
    """The numbers in some columns of all rows.

    Parameters
    ----------
    rows : Lines
        Neither blank lines nor comments.
    delimiter : str or None
        Between cells; None for white space.
    columns : list of int
        Those that are read, counted from 0. What the others hold does not matter, but they must be there.
    width : int
        Cells that each row must have.
    decimal : "." or ","
        What parts whole numbers from fractions.

    Returns
    -------
    float64 (n, len(columns))

    Raises
    ------
    ValueError
        For the first row that has another number of cells, and the first cell that is not a number, with the
        numbers of line and column, counted from 1. So no row is dropped.
    """
    found = _fast(rows, delimiter, columns, width, decimal)
    if found is None:
        return _careful(rows, delimiter, columns, width, decimal)
    # integers that float64 does not hold, and numbers that became infinite: only great ones are suspects
    suspects = np.flatnonzero((np.abs(found) >= WHOLE).any(axis=1))
    if len(suspects):
        _careful(rows.with_text(suspects), delimiter, columns, width, decimal)
    return found


def _fast(
    rows: Lines, delimiter: str | None, columns: list[int], width: int, decimal: str
) -> np.ndarray | None:
    """What NumPy reads of rows that are plain, or None."""
    lines = rows.text
    if any('"' in line for line in lines):
        if delimiter is None:
            return None
        try:
            cells = list(csv.reader(lines, delimiter=delimiter, skipinitialspace=True, strict=True))
        except csv.Error:
            return None
        # a quote that is not closed takes the next line with it
        if len(cells) != len(lines) or any(len(row) != width for row in cells):
            return None
        lines = ["\t".join([row[j] for j in columns]) for row in cells]
        delimiter, width = "\t", len(columns)
        columns = list(range(width))
    if decimal == ",":
        if any("." in line for line in lines):
            return None
        lines = [line.replace(",", ".") for line in lines]
    usecols = columns if columns != list(range(width)) else None
    if usecols:
        # NumPy counts the cells of a row only where it takes all of them
        if delimiter is None:
            even = all(len(line.split()) == width for line in lines)
        else:
            even = all(line.count(delimiter) == width - 1 for line in lines)
        if not even:
            return None
    try:
        found = np.loadtxt(lines, delimiter=delimiter, usecols=usecols, ndmin=2, comments=None)
    except ValueError:
        return None
    return found if found.shape == (len(lines), len(columns)) else None


def _careful(rows: Lines, delimiter: str | None, columns: list[int], width: int, decimal: str) -> np.ndarray:
    found = np.empty((len(rows), len(columns)))
    for k, line in enumerate(rows.text):
        try:
            cells = split(line, delimiter)
        except ValueError as error:
            raise rows.error(k, str(error)) from None
        if len(cells) != width:
            msg = f"{len(cells)} column{'s' * (len(cells) != 1)} where {width} are expected: {shown(line)}"
            raise rows.error(k, msg)
        for i, j in enumerate(columns):
            try:
                found[k, i] = number(cells[j], decimal)
            except ValueError as error:
                raise rows.error(k, str(error), j + 1) from None
    return found


def decimal_mark(rows: Lines, delimiter: str | None, columns: list[int]) -> str:
    """Whether the numbers in some columns have decimal points or commas: "." or ",".

    Between semicolons a comma is a decimal comma, since that is why there are semicolons. Between tabs or
    blanks, ``6,251`` may be 6.251 or 6251, and some other cell must tell: ``0,251``, ``6,25`` or ``6251,1``.

    Raises
    ------
    ValueError
        If no cell tells, or one has a thousands' comma for sure.
    """
    if delimiter == "," or not any("," in line for line in rows.text):
        return "."
    ambiguous = None
    for k, line in enumerate(rows.text):
        if "," not in line:
            continue
        try:
            cells = split(line, delimiter)
        except ValueError as error:
            raise rows.error(k, str(error)) from None
        for j in columns:
            cell = cells[j] if j < len(cells) else ""
            if not THOUSANDS.fullmatch(cell):
                if DECIMAL_COMMA.fullmatch(cell):
                    return ","
            elif "." in cell or cell.count(",") > 1:
                msg = f"{shown(cell)} has thousands' commas; write numbers without them"
                raise rows.error(k, msg, j + 1)
            elif delimiter == ";":
                return ","
            elif ambiguous is None:
                ambiguous = k, j, cell
    if ambiguous is None:
        return "."
    k, j, cell = ambiguous
    point, none = cell.replace(",", "."), cell.replace(",", "")
    raise rows.error(k, f"{shown(cell)} may be {point} or {none}; write one of these, in all rows", j + 1)
