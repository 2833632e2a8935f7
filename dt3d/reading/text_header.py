"""Headers of tables: whether a first line is one, and which of the columns that it names are coordinates."""

from __future__ import annotations

import re
from pathlib import Path

from .text_cells import is_missing, is_number
from .text_lines import shown_names

FAMILIES = {
    "x, y, z": ({"x"}, {"y"}, {"z"}),
    # ParaView's spreadsheet, old and new
    "Points:0, Points:1, Points:2": ({"points:0"}, {"points:1"}, {"points:2"}),
    "Points_0, Points_1, Points_2": ({"points_0"}, {"points_1"}, {"points_2"}),
    "easting, northing, elevation": ({"easting", "east", "e"}, {"northing", "north", "n"}, set()),
}
"""The names of the three axes, in lower case, in each way of naming them."""

HEIGHTS = {"z", "elevation", "elev", "height", "h", "altitude", "alt"}
"""What the third axis is called beside x and y, or easting and northing."""

LONGEST_NAME = 100
"""Characters of a name that are looked at."""

_UNIT = re.compile(r"\s*(\[[^]]*\]|\([^)]*\))\s*$")
_STARTS_LIKE_A_NUMBER = re.compile(r"[-+.,]*[0-9]|[-+]?[0-9OoIl]*[.,][0-9OoIl]")


def is_header(cells: list[str]) -> bool:
    """Whether the cells of a line are the names of columns: none is a number, and all could be names.

    A cell that is empty, or that starts like a number (``0.5 m``, ``O.5`` with a letter O), makes the line a
    row with a fault rather than a header, unless the line names x, y and z. pandas' index, whose name is
    empty, is no such fault, and neither are its names 0, 1, 2 ... of columns behind it.
    """
    if len(cells) > 1 and not cells[0]:
        if cells[1:] == [str(k) for k in range(len(cells) - 1)]:
            return True
        cells = cells[1:]
    if any(is_number(cell) or is_number(cell, ",") for cell in cells):
        return False
    named = set(map(plain_name, cells))
    if {"x", "y", "z"} <= named or {"x", "y"} == named:
        return True
    *front, last = cells
    names = front if not last and front else cells  # rows may end with a delimiter
    return all(not is_missing(name) and not _STARTS_LIKE_A_NUMBER.match(name) for name in names)


def plain_name(name: str) -> str:
    """A column's name in lower case without its unit: ``X [ m ]`` is ``x``."""
    return _UNIT.sub("", name[:LONGEST_NAME]).strip().lower()


def coordinate_columns(path: Path, names: list[str]) -> list[int] | None:
    """The indices of the two or three columns that the names say are coordinates; None if they do not say.

    Raises
    ------
    ValueError
        If more than one set of columns, or more than one column, is called so.
    """
    plain = [plain_name(name) for name in names]
    sets = []
    for title, axes in FAMILIES.items():
        places = [[k for k, name in enumerate(plain) if name in axis] for axis in axes]
        if not places[0] or not places[1]:
            continue
        if not places[2] and axes[0] & {"x", "easting"}:
            heights = HEIGHTS if "x" in axes[0] else HEIGHTS | {"u", "up"}
            places[2] = [k for k, name in enumerate(plain) if name in heights]
        for axis, where in zip("xyz", places, strict=True):
            if len(where) > 1:
                same = shown_names([f"{k + 1} ({names[k]})" for k in where])
                msg = f"{path}: the header calls columns {same} the coordinate {axis}; rename all but one"
                raise ValueError(msg)
        sets.append((title, [where[0] for where in places if where]))
    if len(sets) > 1:
        titles = " and ".join(title for title, _ in sets)
        msg = f"{path}: the header names {titles}; rename all but one of these"
        raise ValueError(msg)
    return sets[0][1] if sets else None
