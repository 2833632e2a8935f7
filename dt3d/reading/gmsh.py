"""Nodes and elements of Gmsh's .msh files, formats 2.2 and 4.1, in text and binary.

Source: Gmsh's manual, sections "MSH file format" and "MSH file format version 2 (Legacy)". meshio is not
used: it leaves rows of uninitialised memory where blocks have fewer nodes than promised, takes node -1 where
an element names one that is not there, and ends the process where it does not understand.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .cursor import Cursor
from .gmsh_data import node_data, nodes_of
from .point_data import PointData

NODES = {
    1: 2, 2: 3, 3: 4, 4: 4, 5: 8, 6: 6, 7: 5, 8: 3, 9: 6, 10: 9, 11: 10, 12: 27, 13: 18, 14: 14, 15: 1,
    16: 8, 17: 20, 18: 15, 19: 13, 20: 9, 21: 10, 22: 12, 23: 15, 24: 15, 25: 21, 26: 4, 27: 5, 28: 6,
    29: 20, 30: 35, 31: 56, 92: 64, 93: 125,
}  # fmt: skip
"""Nodes of an element, by Gmsh's type."""

VTK_TYPES = {
    2: 5, 4: 10, 5: 12, 6: 13, 7: 14, 11: 24, 12: 29, 13: 26, 14: 27, 17: 25, 18: 26, 19: 27,
    29: 71, 30: 71, 31: 71, 92: 29, 93: 29,
}  # fmt: skip
"""VTK's type of triangles and of elements that fill space, by Gmsh's."""


def read_gmsh_points(path: Path, keep: PointData | None = None) -> np.ndarray:
    """All nodes, float64 (n, 3), in the order of the file; ``keep`` gets their data."""
    cursor, points, tags, _ = _open(path)
    if keep is not None:
        node_data(cursor, tags, keep)
    return points


def read_gmsh(path: Path, keep: PointData | None = None) -> dict[str, np.ndarray]:
    """Nodes and elements; ``keep`` gets the data of the nodes.

    Returns
    -------
    dict
        "points" (n, 3); "types" (m,), VTK's for triangles and what fills space, and 0 for all others;
        "offsets" (m + 1,); "connectivity", in which nodes are numbered by their order in the file rather than
        by their tags.

    Raises
    ------
    ValueError
        If the file is cut off, promises what it does not hold, or an element names a node that is not there.
    """
    cursor, points, tags, version = _open(path)
    _section(cursor, "Elements")
    kinds, sizes, named = (_elements_4 if version == "4.1" else _elements_2)(cursor)
    _end(cursor, "Elements")
    if keep is not None:
        node_data(cursor, tags, keep)
    nodes, known = nodes_of(tags, named)
    if not known.all():
        msg = f"{path}: an element names node {named[~known][0]}, which is not among the {len(tags)} nodes"
        raise ValueError(msg)
    types = np.zeros(len(kinds), np.int64)
    for gmsh, vtk in VTK_TYPES.items():
        types[kinds == gmsh] = vtk
    offsets = np.append(0, np.cumsum(sizes))
    return {"points": points, "types": types, "offsets": offsets, "connectivity": nodes}


def _open(path: Path) -> tuple[Cursor, np.ndarray, np.ndarray, str]:
    """A cursor behind the nodes, the nodes (n, 3), their tags (n,), and the version."""
    cursor = Cursor(path, path.read_bytes())
    if cursor.data.lstrip()[:11] != b"$MeshFormat":
        msg = f"{path} is no Gmsh file: it should start with $MeshFormat"
        raise ValueError(msg)
    cursor.word("$MeshFormat")
    version, binary, size = (cursor.word("the format") for _ in range(3))
    if version not in ("2", "2.0", "2.1", "2.2", "4.1") or binary not in ("0", "1") or size != "8":
        found = f"{version} {binary} {size}"[:40]
        msg = f"{path}: Gmsh format {found!r} is not read; save it as version 2.2 or 4.1, for example in Gmsh"
        raise ValueError(msg)
    if binary == "1":
        cursor.line()
        cursor.order = "<"
        one = int(cursor.binary(1, np.dtype("i4"), "the number one")[0])
        if one not in (1, 1 << 24):
            msg = f"{path} is damaged: the number that tells the byte order is {one}"
            raise ValueError(msg)
        cursor.order = "<" if one == 1 else ">"
    _section(cursor, "Nodes")
    points, tags = (_nodes_4 if version == "4.1" else _nodes_2)(cursor)
    _end(cursor, "Nodes")
    if not len(points):
        msg = f"{path} holds no nodes"
        raise ValueError(msg)
    if len(np.unique(tags)) != len(tags):
        msg = f"{path}: two nodes have one tag"
        raise ValueError(msg)
    return cursor, points, tags, version


def _section(cursor: Cursor, name: str) -> None:
    """Go to the numbers of a section; others may lie before it."""
    start = cursor.data.find(f"\n${name}".encode(), max(0, cursor.at - 1))
    if start < 0:
        msg = f"{cursor.path} is cut off, or has no section ${name}"
        raise ValueError(msg)
    cursor.at = start + 1
    cursor.line()


def _end(cursor: Cursor, name: str) -> None:
    found = cursor.word(f"$End{name}")
    if found != f"$End{name}":
        msg = f"{cursor.path} is damaged: expected $End{name}, found {found[:40]!r}"
        raise ValueError(msg)


def _nodes_2(cursor: Cursor) -> tuple[np.ndarray, np.ndarray]:
    n = cursor.count("the number of nodes")
    if cursor.order is None:
        rows = cursor.text(4 * n, False, "nodes").reshape(n, 4)
        return rows[:, 1:], _tags(cursor, rows[:, 0])
    cursor.line()
    record = np.dtype([("tag", f"{cursor.order}i4"), ("x", f"{cursor.order}f8", 3)])
    rows = cursor.binary(n, record, "nodes")
    return rows["x"], rows["tag"].astype(np.int64)


def _tags(cursor: Cursor, column: np.ndarray) -> np.ndarray:
    if not (np.isfinite(column) & (np.floor(column) == column) & (np.abs(column) < 2.0**53)).all():
        msg = f"{cursor.path}: the tags of nodes should be whole numbers"
        raise ValueError(msg)
    return column.astype(np.int64)


def _nodes_4(cursor: Cursor) -> tuple[np.ndarray, np.ndarray]:
    blocks, n, _, _ = _counts(cursor, 4, "the numbers of nodes")
    points, tags, there = [np.empty((0, 3))], [np.empty(0, np.int64)], 0
    for _ in range(blocks):
        dimension, _, parametric = cursor.array(3, "i4", "the head of a block").tolist()
        (size,) = _counts(cursor, 1, "the number of nodes in a block")
        tags.append(cursor.array(size, "u8", "tags of nodes").astype(np.int64))
        width = 3 + (dimension if parametric else 0)  # x y z, and parameters on the entity
        if width not in (3, 4, 5, 6):
            msg = f"{cursor.path} is damaged: a block of nodes has dimension {dimension}"
            raise ValueError(msg)
        points.append(cursor.array(width * size, "f8", "nodes").reshape(size, width)[:, :3])
        there += size
    if there != n:
        msg = f"{cursor.path} is damaged: its blocks have {there} nodes, and {n} are promised"
        raise ValueError(msg)
    return np.concatenate(points), np.concatenate(tags)


def _counts(cursor: Cursor, count: int, what: str) -> list[int]:
    counts: list[int] = cursor.array(count, "u8", what).tolist()
    # the first two are of things of which each takes a byte at least; tags may be any numbers
    if any(not 0 <= number <= len(cursor.data) for number in counts[:2]):
        msg = f"{cursor.path} is damaged: {what} are {counts[:2]} in {len(cursor.data)} bytes"
        raise ValueError(msg)
    return counts


def _elements_2(cursor: Cursor) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Gmsh's type and the number of nodes of every element (m,), and the nodes' tags, all in a row."""
    m = cursor.count("the number of elements")
    cursor.line()
    if cursor.order is None:
        return _elements_in_text(cursor, m)
    kinds, sizes, named = [np.empty(0, np.int64)], [np.empty(0, np.int64)], [np.empty(0, np.int64)]
    there = 0
    while there < m:
        kind, size, more = cursor.binary(3, np.dtype("i4"), "the head of a block").tolist()
        if not (0 < size <= m - there and 0 <= more <= len(cursor.data)):
            msg = f"{cursor.path} is damaged: a block has {size} elements of {m} with {more} tags"
            raise ValueError(msg)
        width = _size(cursor, kind)
        block = cursor.binary(size * (1 + more + width), np.dtype("i4"), "elements").reshape(size, -1)
        kinds.append(np.full(size, kind))
        sizes.append(np.full(size, width))
        named.append(block[:, 1 + more :].astype(np.int64).ravel())
        there += size
    return np.concatenate(kinds), np.concatenate(sizes), np.concatenate(named)


def _elements_in_text(cursor: Cursor, m: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lines of a number, a type, the number of tags, tags, nodes; as `_elements_2`."""
    kinds, sizes, named = [], [], []
    for element in range(m):
        words = cursor.line().split()
        try:
            row = [int(word) for word in words]
            _, kind, more = row[:3]
        except ValueError:
            msg = f"{cursor.path} is damaged: {' '.join(words)[:40]!r} is no element"
            raise ValueError(msg) from None
        size = _size(cursor, kind)
        if len(row) != 3 + more + size or more < 0:
            msg = f"{cursor.path}: element {element + 1} of {m} has {len(row)} numbers on its line"
            raise ValueError(msg)
        kinds.append(kind)
        sizes.append(size)
        named += row[3 + more :]
    try:
        return np.array(kinds, np.int64), np.array(sizes, np.int64), np.array(named, np.int64)
    except OverflowError:
        msg = f"{cursor.path} is damaged: an element names a node beyond 2^63"
        raise ValueError(msg) from None


def _elements_4(cursor: Cursor) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """As `_elements_2`."""
    blocks, m, _, _ = _counts(cursor, 4, "the numbers of elements")
    kinds, sizes, named = [np.empty(0, np.int64)], [np.empty(0, np.int64)], [np.empty(0, np.int64)]
    there = 0
    for _ in range(blocks):
        kind = cursor.array(3, "i4", "the head of a block").tolist()[2]
        (size,) = _counts(cursor, 1, "the number of elements in a block")
        width = _size(cursor, kind)
        rows = cursor.array(size * (1 + width), "u8", "elements").reshape(size, 1 + width)
        kinds.append(np.full(size, kind))
        sizes.append(np.full(size, width))
        named.append(rows[:, 1:].astype(np.int64).ravel())
        there += size
    if there != m:
        msg = f"{cursor.path} is damaged: its blocks have {there} elements, and {m} are promised"
        raise ValueError(msg)
    return np.concatenate(kinds), np.concatenate(sizes), np.concatenate(named)


def _size(cursor: Cursor, kind: int) -> int:
    if kind not in NODES:
        msg = f"{cursor.path}: elements of Gmsh's type {kind} are not known"
        raise ValueError(msg)
    return NODES[kind]
