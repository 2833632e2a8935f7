"""Points as columns of numbers, with or without a header: .csv, .tsv, .txt and .dat."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .point_data import PointData
from .text_cells import is_integer, is_missing, is_number, split
from .text_header import coordinate_columns, is_header, plain_name
from .text_lines import COMMENT_MARKS, Lines, content, read_lines, shown, shown_names
from .text_numbers import decimal_mark, numbers
from .text_values import keep_columns

_QUOTED = re.compile(r'"[^"]*"')
_COMMAS_WITHIN = re.compile(r"[-+]?[0-9]+(,[0-9]+)*(\.[0-9]*)?([eEdD][-+]?[0-9]+)?")

_WANTED = "expected three, or a header that names x, y and z"


def read_columns(path: Path, keep: PointData | None = None) -> np.ndarray:
    """Two or three columns of numbers, or those that a header calls x, y and z.

    The delimiter is a semicolon, a tab, a comma or white space. Decimal commas are understood where they can
    be nothing else. Lines that start with ``#``, ``//``, ``%`` or ``!`` are comments; one before the first
    row that names x, y and z is a header, as is a first line in which no cell is a number (see
    `text_header.is_header`). A header of two or three columns that names no axes leaves them in order.
    Before the rows, there may be their number, or what Qhull's rbox writes. ``keep`` gets the other columns.

    Returns
    -------
    float64 (n, 3) or (n, 2)

    Raises
    ------
    ValueError
        If there are no numbers, rows differ in length, a cell is missing or not a number, or the columns are
        more than three and not named. The first three of more columns are not taken: the first may well be an
        index or a time.
    """
    return columns_of(read_lines(path), keep=keep)


def read_leading_columns(path: Path, keep: PointData | None = None) -> np.ndarray:
    """As `read_columns`, but of more than three columns without names the first three: .asc.

    Raises
    ------
    ValueError
        As `read_columns`, and if the first column of more than three counts the rows.
    """
    return columns_of(read_lines(path), leading=True, keep=keep)


def columns_of(lines: Lines, *, leading: bool = False, keep: PointData | None = None) -> np.ndarray:
    """The points in the lines of a table; with ``leading``, the first three columns where none are named.

    ``keep`` gets the other columns.
    """
    path, rows = lines.path, content(lines)
    if not len(rows):
        what = "holds only comments" if any(map(str.strip, lines.text)) else "is empty"
        msg = f"{path} {what}; expected rows of x, y, z"
        raise ValueError(msg)
    rows = _without_counts(_without_hint(rows))
    delimiter = delimiter_of(rows.text[0])
    names = _cells(rows, 0, delimiter)
    if is_header(names):
        rows = rows[1:]
        if not len(rows):
            msg = f"{path} has a header but no rows of numbers"
            raise ValueError(msg)
        if delimiter is None or delimiter not in rows.text[0]:
            delimiter = delimiter_of(rows.text[0])
        first = _cells(rows, 0, delimiter)
    else:
        first, names = names, _names_in_comments(lines, rows.numbers[0], len(names))
    if delimiter == "\t" and not _is_tabbed(rows):
        delimiter = None
        first = _cells(rows, 0, delimiter)

    width = len(first)
    used = width
    if not first[-1] and not (len(names) == width and names[-1]) and _is_never_used(rows, delimiter):
        used -= 1  # a delimiter after each last cell
    if names:
        names = _fitted_names(rows, names, first, used)
    else:
        _check_numbered_header(rows, first, delimiter)
    columns = _chosen_columns(rows, names, first[:used], delimiter, leading)
    decimal = decimal_mark(rows, delimiter, columns)
    found = numbers(rows, delimiter, columns, width, decimal)
    if keep is not None and names:
        keep_columns(rows, delimiter, names, columns, decimal, keep)
    elif keep is not None and used > len(columns):
        keep.leave_out(f"columns {len(columns) + 1} to {used}", f"they have no names, as by {_example(used)}")
    return found


def delimiter_of(line: str) -> str | None:
    """What stands between the cells of a line: a semicolon, a tab, a comma or white space (None)."""
    if '"' in line:
        line = _QUOTED.sub('""', line)  # what is in quotes tells nothing
    if ";" in line:
        return ";"
    if "\t" in line and not all(cell.strip().endswith(",") for cell in line.split("\t")[:-1]):
        return "\t"
    if "," not in line:
        return None
    words = line.split()
    within = all("," not in word or _COMMAS_WITHIN.fullmatch(word) for word in words)
    return None if len(words) > 1 and within else ","


def _cells(rows: Lines, k: int, delimiter: str | None) -> list[str]:
    try:
        return split(rows.text[k], delimiter)
    except ValueError as error:
        raise rows.error(k, str(error)) from None


def _is_tabbed(rows: Lines) -> bool:
    """Whether tabs alone stand between cells, rather than tabs and blanks in any number."""
    tabs = {row.count("\t") for row in rows.text}
    return len(tabs) == 1 or any(not cell.strip() for row in rows.text for cell in row.split("\t"))


def _is_never_used(rows: Lines, delimiter: str | None) -> bool:
    """Whether the last column, which has no name, is empty.

    Raises
    ------
    ValueError
        If it is empty in most rows but not in all: those may have a decimal comma.
    """
    odd = [k for k, row in enumerate(rows.text) if not row.rstrip().endswith(delimiter or "")]
    if odd and 2 * len(odd) <= len(rows):
        msg = f"a value behind the last column: {shown(rows.text[odd[0]])}"
        raise rows.error(odd[0], msg)
    return not odd


def _without_hint(rows: Lines) -> Lines:
    """The rows behind ``sep=;``, which tells Excel the delimiter; the rows tell it as well."""
    return rows[1:] if len(rows) > 1 and re.fullmatch(r"\s*sep=.\s*", rows.text[0], re.IGNORECASE) else rows


def _without_counts(rows: Lines) -> Lines:
    """The rows behind a line with their number, or behind rbox's lines with dimension and number."""
    for ahead in (1, 2):
        if len(rows) <= ahead:
            return rows
        counted = is_integer(rows.text[ahead - 1].strip()) and len(rows.text[ahead].strip()) > 1
        words = rows.text[0].split()
        rbox = words[0] in ("2", "3") and not any(map(is_number, words[1:2]))
        if counted and not is_integer(rows.text[ahead].strip()) and (ahead == 1 or rbox):
            promised = rows.text[ahead - 1].strip()
            if promised != str(len(rows) - ahead):
                msg = f"{shown(promised)} rows are promised, but {len(rows) - ahead} follow"
                raise rows.error(ahead - 1, msg)
            return rows[ahead:]
    return rows


def _names_in_comments(lines: Lines, first: int, width: int) -> list[str]:
    """The names in the last comment before line ``first`` that has as many as columns, axes among them."""
    for line in reversed(lines.text[: first - 1]):
        bare = line.strip().lstrip("".join(COMMENT_MARKS) + " \t")
        names = [cell.strip() for cell in bare.split(delimiter_of(bare))] if bare else []
        if len(names) == width and {"x", "y"} <= set(map(plain_name, names)):
            return names
    return []


def _fitted_names(rows: Lines, names: list[str], first: list[str], used: int) -> list[str]:
    """As many names as columns in use."""
    if len(names) > used and not any(names[used:]):
        names = names[:used]
    row_names = rows.text[0].lstrip().startswith('"') or not (is_number(first[0]) or is_number(first[0], ","))
    if len(names) == used - 1 and row_names and {"x", "y", "z"} <= set(map(plain_name, names)):
        names = ["", *names]  # R does not name the column of row names
    if len(names) != used:
        msg = f"{used} columns, but the header names {len(names)}: {shown_names(names)}"
        raise rows.error(0, msg)
    return names


def _chosen_columns(
    rows: Lines, names: list[str], first: list[str], delimiter: str | None, leading: bool
) -> list[int]:
    width = len(first)
    if names:
        found = coordinate_columns(rows.path, names)
        if found is not None:
            return found
        unnamed = 1 if width > 1 and not names[0] else 0  # pandas' index
        plain = [plain_name(name) for name in names[unnamed:]]
        axes = ["x", "y", "z"]
        misplaced = any(name in axes and name != axis for name, axis in zip(plain, axes, strict=False))
        if len(plain) in (2, 3) and not misplaced:
            return list(range(unnamed, width))
        msg = f"{rows.path}: found columns {shown_names(names)}; {_WANTED}"
        raise ValueError(msg)
    if width in (2, 3):
        return list(range(width))
    for j, cell in enumerate(first):
        if not is_number(cell) and not is_number(cell, ","):
            text = "" if is_missing(cell) else "; lines of text before the rows must start with '#'"
            msg = f"{shown(cell)} is not a number{text}"
            raise rows.error(0, msg, j + 1)
    if width > 3 and leading:
        if _counts_rows(rows, delimiter):
            msg = f"the first of {width} columns counts the rows; name them first, such as {_example(width)}"
            raise rows.error(0, msg)
        return [0, 1, 2]
    example = f", such as {_example(width)}" if width > 3 else ""
    msg = f"{rows.path}: found {width} column{'s' * (width > 1)}; {_WANTED}{example}"
    raise ValueError(msg)


def _example(width: int) -> str:
    more = [f"c{k}" for k in range(4, width + 1)]
    return f"'# x y z {' '.join(more if width < 13 else [more[0], '...', more[-1]])}'"


def _counts_rows(rows: Lines, delimiter: str | None) -> bool:
    """Whether the first column of four rows or more is 0, 1, 2 ... or 1, 2, 3 ..."""
    cells = [row.split(delimiter, 1)[0].strip() for row in rows.text]
    return len(rows) > 3 and cells in ([str(k + start) for k in range(len(rows))] for start in (0, 1))


def _check_numbered_header(rows: Lines, first: list[str], delimiter: str | None) -> None:
    """pandas calls columns 0, 1, 2: an error where all other numbers have decimal points."""
    if first != [str(k) for k in range(len(first))] or len(rows) < 2:
        return
    if not any(map(is_integer, " ".join(rows[1:].text).replace(delimiter or " ", " ").split())):
        msg = f"{','.join(first)} may be a header (pandas writes such) or a point; delete it, or write 0.0"
        raise rows.error(0, msg)
