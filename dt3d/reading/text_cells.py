"""Cells of a line of text, and the numbers in them: what is a number, and what is said of the others."""

from __future__ import annotations

import csv
import re

from .text_lines import shown

INTEGER = re.compile(r"[-+]?[0-9]+")
NUMBER = re.compile(
    r"[-+]?(?:(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eEdD][-+]?[0-9]+)?|nan|inf|infinity)", re.ASCII | re.IGNORECASE
)
THOUSANDS = re.compile(r"[-+]?[1-9][0-9]{0,2}(?:,[0-9]{3})+(?:\.[0-9]*)?")
DECIMAL_COMMA = re.compile(r"[-+]?(?:[0-9]+,[0-9]*|,[0-9]+)(?:[eEdD][-+]?[0-9]+)?")
MISSING = {"", "-", "--", "---", "na", "n/a", "#n/a", "null", "none", "nil", "missing", "?", ".", "*"}
"""What is written where a value is missing, in lower case; NaN is a number."""

WHOLE = 2.0**53  # below it, float64 has every integer


def split(line: str, delimiter: str | None) -> list[str]:
    """The cells of a line between delimiters, or between white space (None), without blanks around them.

    Raises
    ------
    ValueError
        For quotes that are not closed.
    """
    if '"' not in line:
        return line.split() if delimiter is None else [cell.strip() for cell in line.split(delimiter)]
    text = line.strip()
    if delimiter is None:
        # csv takes blanks one by one, so runs of them outside quotes become one
        text = re.sub(r'("[^"]*")|\s+', lambda run: run[1] or " ", text)
    else:
        text = re.sub(f'" +(?={delimiter})', '"', text)
    try:
        cells = next(csv.reader([text], delimiter=delimiter or " ", skipinitialspace=True, strict=True))
    except csv.Error as error:
        msg = f"quotes that do not match ({error})"
        raise ValueError(msg) from None
    return [cell.strip() for cell in cells]


def is_number(cell: str, decimal: str = ".") -> bool:
    """Whether `number` reads the cell."""
    return NUMBER.fullmatch(_with_point(cell, decimal)) is not None


def is_integer(cell: str) -> bool:
    """Whether the cell is an integer that is written as one."""
    return INTEGER.fullmatch(cell) is not None


def is_missing(cell: str) -> bool:
    """Whether the cell says that there is no value."""
    return cell.lower() in MISSING


def number(cell: str, decimal: str = ".") -> float:
    """The number in a cell: as Python writes it, or with Fortran's exponent ``1.0D+00``.

    Raises
    ------
    ValueError
        For a cell that is empty or no number, for an integer (written as one) that float64 does not hold
        exactly, and for a number beyond the range of float64. Other decimal fractions are rounded to nearest.
    """
    text = _with_point(cell, decimal)
    if NUMBER.fullmatch(text) is None:
        raise ValueError(_no_number(cell, decimal))
    value = float(text.lower().replace("d", "e"))
    if value in (float("inf"), float("-inf")) and "n" not in text.lower():
        msg = f"{shown(cell)} is beyond the range of float64, which ends at 1.8e308"
        raise ValueError(msg)
    if abs(value) >= WHOLE and is_integer(text) and int(text) != int(value):
        msg = f"{shown(cell)} is an integer that float64 does not hold exactly; subtract an offset first"
        raise ValueError(msg)
    return value


def _with_point(cell: str, decimal: str) -> str:
    if decimal == ".":
        return cell
    # a decimal point beside decimal commas could as well be a separator of thousands
    return cell.replace(",", ".") if DECIMAL_COMMA.fullmatch(cell) else cell.replace(".", "..")


def _no_number(cell: str, decimal: str) -> str:
    if is_missing(cell):
        return f"a value is missing ({shown(cell)}); fill it in or delete the row"
    if decimal == "," and NUMBER.fullmatch(cell.replace(",", ".")):
        return f"{shown(cell)} has a decimal point, while other numbers of the file have decimal commas"
    if "," in cell and re.fullmatch(r"[-+0-9.,eEdD]+", cell):
        return f"{shown(cell)} has a comma within; write a decimal point, and no thousands' commas"
    return f"{shown(cell)} is not a number"
