"""Points and cells of VTK's legacy files, .vtk in text and binary.

Source: "VTK File Formats", section "Simple Legacy Formats", with the cell arrays of version 5.1. VTK's own
reader is not used: where a file is cut off it hands over uninitialised memory, in text without a word.
"""

from __future__ import annotations

from pathlib import Path
from urllib.parse import unquote

import numpy as np

from .cursor import Cursor
from .lattice import image, lattice
from .point_data import PointData, as_declared

TYPES = {
    "char": "i1", "signed_char": "i1", "unsigned_char": "u1", "short": "i2", "unsigned_short": "u2",
    "int": "i4", "unsigned_int": "u4", "long": "i8", "unsigned_long": "u8",
    "vtktypeint64": "i8", "vtktypeuint64": "u8", "vtkidtype": "i4", "float": "f4", "double": "f8",
}  # fmt: skip

ATTRIBUTES = {"vectors": 3, "normals": 3, "tensors": 9, "tensors6": 6, "global_ids": 1, "pedigree_ids": 1}
"""Numbers per point or cell, of the attributes that are written ``KEYWORD name type``."""

CELL_DATA = "cell data "
"""Stands before the names of arrays of the cells."""

POINT_DATA = "point data "
"""Stands before the names of arrays of the points."""

CELL_ARRAYS = ("cells", "vertices", "lines", "polygons", "triangle_strips")


def read_legacy(path: Path, keep: PointData | None = None) -> dict[str, np.ndarray]:
    """What the file has, all of which is read.

    Parameters
    ----------
    path : Path
        The file.
    keep : PointData, optional
        Gets the data of the points.

    Returns
    -------
    dict
        "points" (n, 3); of an unstructured grid "types" (m,), "offsets" (m + 1,) and "connectivity"; and the
        arrays of the cells by their names after `CELL_DATA`.

    Raises
    ------
    ValueError
        If it is cut off, promises what it does not hold, or has words where they do not belong.
    """
    cursor = Cursor(path, path.read_bytes())
    first, _title, form = cursor.line(), cursor.line(), cursor.line().upper()
    if not first.lower().startswith("# vtk datafile version"):
        msg = f"{path} is no VTK file: it should start with '# vtk DataFile Version'"
        raise ValueError(msg)
    if form not in ("ASCII", "BINARY"):
        msg = f"{path}: the third line should be ASCII or BINARY, found {form[:40]!r}"
        raise ValueError(msg)
    cursor.order = ">" if form == "BINARY" else None
    found: dict[str, np.ndarray] = {}
    kind, of = "", ("", 0)
    while cursor.look() is not None:
        word = cursor.word("a keyword").lower()
        if word == "dataset":
            kind = cursor.word("the kind of data set").lower()
        elif word == "metadata":
            _skip_metadata(cursor)
        elif word == "field":
            _field(cursor, found, of)
        elif word in ("point_data", "cell_data"):
            of = (word, cursor.count(word.upper(), listed=False))
        elif of[0]:
            if not _attribute(cursor, word, found, of):
                # a kind of attribute that is not known; points and cells come before all of them
                if keep is not None:
                    keep.leave_out(word.upper()[:40], "what begins with this word is not understood")
                break
        else:
            _structure(cursor, word, found)
    if ("offsets" in found) != ("types" in found):
        msg = f"{path} is cut off: CELLS and CELL_TYPES go together"
        raise ValueError(msg)
    points = _points(path, kind, found)
    if not len(points):
        msg = f"{path} holds no points (data set {kind.upper()[:40] or 'missing'})"
        raise ValueError(msg)
    for name in [name for name in found if name.startswith(POINT_DATA)]:
        values = found.pop(name)
        if keep is not None:
            keep.add(name.removeprefix(POINT_DATA), values)
    return {**found, "points": points}


def _structure(cursor: Cursor, word: str, found: dict[str, np.ndarray]) -> None:
    """A part of the data set itself, into ``found`` under its keyword."""
    path = cursor.path
    if word == "points":
        n = cursor.count("the number of points")
        found["points"] = _typed(cursor, 3 * n, "points").reshape(n, 3)
    elif word in ("x_coordinates", "y_coordinates", "z_coordinates"):
        found[word] = _typed(cursor, cursor.count(f"the number of {word}"), word)
    elif word in ("dimensions", "origin", "spacing", "aspect_ratio"):
        found["spacing" if word == "aspect_ratio" else word] = cursor.text(3, word == "dimensions", word)
    elif word in CELL_ARRAYS:
        offsets, connectivity = _cells(cursor, word)
        if word == "cells":
            found["offsets"], found["connectivity"] = offsets, connectivity
    elif word == "cell_types":
        found["types"] = _after_line(cursor, cursor.count("the number of cell types"), "i4", "cell types")
    else:
        msg = f"{path}: {word[:40]!r} is no keyword of VTK's legacy format; the file may be damaged"
        raise ValueError(msg)


def _cells(cursor: Cursor, word: str) -> tuple[np.ndarray, np.ndarray]:
    """Offsets (m + 1,) and connectivity of cells, in either of the format's two ways."""
    first, second = cursor.count(f"the number of {word}"), cursor.count(f"the size of {word}")
    ahead = cursor.look()
    if ahead is not None and ahead[1].upper() == b"OFFSETS":
        cursor.word("OFFSETS")
        offsets = _typed(cursor, first, "offsets")
        if cursor.word("CONNECTIVITY").upper() != "CONNECTIVITY":
            msg = f"{cursor.path}: expected CONNECTIVITY after the offsets of {word}"
            raise ValueError(msg)
        return offsets, _typed(cursor, second, "connectivity")
    packed = _after_line(cursor, second, "i4", word).astype(np.int64)
    size = second // first if first else 0
    if first and second == size * first and (packed[::size] == size - 1).all():  # of one kind, as most are
        return np.arange(first + 1) * (size - 1), packed.reshape(first, size)[:, 1:].ravel()
    heads, at, numbers = np.empty(first, np.int64), 0, packed.tolist()
    for cell in range(first):
        if at >= second or not 0 <= numbers[at] < second - at:
            msg = f"{cursor.path}: cell {cell} of {first} reaches beyond the {second} numbers of {word}"
            raise ValueError(msg)
        heads[cell] = at
        at += 1 + numbers[at]
    if at != second:
        msg = f"{cursor.path}: the {first} {word} have {at} numbers, not the {second} that are promised"
        raise ValueError(msg)
    return np.append(0, np.cumsum(packed[heads])), np.delete(packed, heads)


def _attribute(cursor: Cursor, word: str, found: dict[str, np.ndarray], of: tuple[str, int]) -> bool:
    """Read an attribute of the points or cells; False if its keyword is not known."""
    n = of[1]
    if word in ATTRIBUTES:
        name = cursor.word("a name")
        _enter(found, of, name, _typed(cursor, n * ATTRIBUTES[word], word, cast=True), ATTRIBUTES[word])
    elif word == "texture_coordinates":
        name, width = cursor.word("a name"), cursor.count("a dimension")
        _enter(found, of, name, _typed(cursor, n * width, word, cast=True), width)
    elif word == "color_scalars":
        name, width = cursor.word("a name"), cursor.count("the number of values")
        # of 0 to 255 in binary, of 0 to 1 in text
        kind = "f4" if cursor.order is None else "u1"
        _enter(found, of, name, _after_line(cursor, n * width, kind, word).astype(kind), width)
    elif word == "lookup_table":
        cursor.word("a name")
        size = cursor.count("the size of a table")
        _after_line(cursor, 4 * size, "f4" if cursor.order is None else "u1", word)
    elif word == "scalars":
        name = cursor.word("a name")
        dtype, components = [*cursor.line().split(), "1"][:2]
        if (look := cursor.look()) is not None and look[1].upper() == b"LOOKUP_TABLE":
            cursor.word("LOOKUP_TABLE"), cursor.line()
        if dtype.lower() not in TYPES or components not in "1234":
            return False
        kind = TYPES[dtype.lower()]
        values = cursor.array(n * int(components), kind, word)
        if cursor.order is None:
            values = as_declared(values, kind, f"{cursor.path}: {name[:40]!r}")
        _enter(found, of, name, values, int(components))
    else:
        return False
    return True


def _enter(
    found: dict[str, np.ndarray], of: tuple[str, int], name: str, values: np.ndarray, width: int
) -> None:
    """Put an array of the points or cells among what is found."""
    if of[0] == "point_data":
        # this format writes %20 for blanks in names
        found[POINT_DATA + unquote(name)] = values.reshape(of[1], width) if width > 1 else values
    elif of[0] == "cell_data" and width == 1:
        found[CELL_DATA + name] = values


def _field(cursor: Cursor, found: dict[str, np.ndarray], of: tuple[str, int]) -> None:
    """Named arrays of any shape."""
    cursor.word("a name")
    for _ in range(cursor.count("the number of arrays of a field")):
        while (name := cursor.word("the name of an array")).upper() == "METADATA":
            _skip_metadata(cursor)
        components, tuples = cursor.count("components"), cursor.count("tuples")
        values = _typed(cursor, components * tuples, f"array {name!r}", cast=True)
        if of[0] == "point_data" and tuples != of[1]:
            msg = f"{cursor.path}: array {name[:40]!r} has {tuples} entries, and there are {of[1]} points"
            raise ValueError(msg)
        if tuples == of[1]:
            _enter(found, of, name, values, components)


def _skip_metadata(cursor: Cursor) -> None:
    """Names and ranges, up to an empty line."""
    cursor.line()
    while cursor.line():
        continue


def _typed(cursor: Cursor, count: int, what: str, *, cast: bool = False) -> np.ndarray:
    """An array whose type is the last word of the line before it.

    Text is read in double precision; ``cast`` gives it the type that the file says it has.
    """
    word = cursor.word(f"the type of {what}").lower()
    if word == "bit":
        bits = _after_line(cursor, count if cursor.order is None else (count + 7) // 8, "u1", what)
        return np.asarray((bits if cursor.order is None else np.unpackbits(bits)[:count]) != 0)
    if word == "string":
        return _strings(cursor, count)
    if word not in TYPES:
        msg = f"{cursor.path}: {what} are of type {word[:40]!r}; known are {', '.join(TYPES)}"
        raise ValueError(msg)
    values = _after_line(cursor, count, TYPES[word], what)
    in_text = cursor.order is None
    return as_declared(values, TYPES[word], f"{cursor.path}: {what}") if cast and in_text else values


def _strings(cursor: Cursor, count: int) -> np.ndarray:
    """Strings: lines, or in binary bytes after their length."""
    cursor.line()
    found = []
    for _ in range(count):
        if cursor.order is None:
            found.append(unquote(cursor.line()))
            continue
        # the two highest bits tell how many bytes the length takes
        width = 8 >> (int(cursor.binary(1, np.dtype("u1"), "a string's length")[0]) >> 6)
        cursor.at -= 1
        length = int(cursor.binary(1, np.dtype(f"u{width}"), "a string's length")[0]) % (1 << (8 * width - 2))
        found.append(cursor.binary(length, np.dtype("u1"), "a string").tobytes().decode("utf-8", "replace"))
    return np.array(found, np.str_)


def _after_line(cursor: Cursor, count: int, dtype: str, what: str) -> np.ndarray:
    if cursor.order is not None:
        cursor.line()  # binary numbers start after the line break
    return cursor.array(count, dtype, what)


def _points(path: Path, kind: str, found: dict[str, np.ndarray]) -> np.ndarray:
    """The points that are listed, or those of the lattice that the data set is."""
    if kind == "structured_points" and "dimensions" in found:
        last = found["dimensions"] - 1
        extent = [0, int(last[0]), 0, int(last[1]), 0, int(last[2])]
        origin, spacing = found.get("origin", np.zeros(3)), found.get("spacing", np.ones(3))
        return image(path, extent, origin.tolist(), spacing.tolist(), np.eye(3))
    axes = [found[f"{axis}_coordinates"] for axis in "xyz" if f"{axis}_coordinates" in found]
    if kind == "rectilinear_grid" and len(axes) == 3:
        if [len(axis) for axis in axes] != found.get("dimensions", np.zeros(3)).tolist():
            msg = f"{path}: the coordinates of the rectilinear grid are not as many as its dimensions say"
            raise ValueError(msg)
        return lattice(path, axes)
    points = found.get("points", np.empty((0, 3)))
    if kind == "structured_grid" and found.get("dimensions", np.zeros(3)).prod() != len(points):
        msg = f"{path}: the dimensions of the structured grid do not give its {len(points)} points"
        raise ValueError(msg)
    return points
