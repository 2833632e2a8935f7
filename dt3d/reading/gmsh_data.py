"""Data of nodes in Gmsh's .msh files: $NodeData, as views of Gmsh are saved.

Source: Gmsh's manual, section "MSH file format".
"""

from __future__ import annotations

import numpy as np

from .cursor import Cursor
from .point_data import PointData

COUNTED = ("the number of text tags", "the number of real tags", "the number of integer tags")


def node_data(cursor: Cursor, tags: np.ndarray, keep: PointData) -> None:
    """Enter all data of nodes that stand behind the cursor.

    Parameters
    ----------
    cursor : Cursor
        Behind the nodes.
    tags : int (n,)
        The tags of the nodes, in their order.
    keep : PointData
        Gets the data; those that not every node has are left out.

    Raises
    ------
    ValueError
        If a section is cut off, or names a node twice or one that is not there.
    """
    while (start := cursor.data.find(b"\n$NodeData", cursor.at - 1)) >= 0:
        cursor.at = start + 1
        cursor.line()
        name, width, count = _head(cursor)
        if cursor.order is None:
            rows = cursor.text((1 + width) * count, False, f"data {name!r}").reshape(count, 1 + width)
            named, values = rows[:, 0], rows[:, 1:]
        else:
            record = np.dtype([("tag", f"{cursor.order}i4"), ("values", f"{cursor.order}f8", (width,))])
            table = cursor.binary(count, record, f"data {name!r}")
            named, values = table["tag"], table["values"]
        if (end := cursor.word("$EndNodeData")) != "$EndNodeData":
            msg = f"{cursor.path} is damaged: expected $EndNodeData after {name!r}, found {end[:40]!r}"
            raise ValueError(msg)
        nodes, known = nodes_of(tags, named)
        if not known.all() or len(np.unique(nodes)) != count:
            msg = f"{cursor.path}: data {name!r} name a node twice, or one that is not there"
            raise ValueError(msg)
        if count < len(tags):
            keep.leave_out(name, f"{count} of {len(tags)} nodes have it")
            continue
        sorted_by_node = np.empty_like(values)
        sorted_by_node[nodes] = values
        keep.add(name, sorted_by_node)


def nodes_of(tags: np.ndarray, named: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The places of named tags among the tags of the nodes, and which of them are there.

    Parameters
    ----------
    tags : int (n,)
        Of the nodes, in their order.
    named : (k,)
        Tags by which a file names nodes.

    Returns
    -------
    int (k,)
        Places; of no meaning for tags that are not there.
    bool (k,)
        Whether each is there.
    """
    order = np.argsort(tags, kind="stable")
    nodes = order[np.minimum(np.searchsorted(tags[order], named), len(tags) - 1)]
    return nodes, tags[nodes] == named


def _head(cursor: Cursor) -> tuple[str, int, int]:
    """The name of data, the numbers per node, and how many nodes have them."""
    texts = [_quoted(cursor.line()) for _ in range(_number(cursor, COUNTED[0]))]
    for _ in range(_number(cursor, COUNTED[1])):
        cursor.line()
    whole = [_number(cursor, "an integer tag") for _ in range(_number(cursor, COUNTED[2]))]
    name = texts[0] if texts else ""
    if len(whole) < 3 or not 0 < whole[1] <= 9 or whole[2] > len(cursor.data):
        msg = f"{cursor.path} is damaged: data {name!r} have the integer tags {whole[:4]}"
        raise ValueError(msg)
    return name, whole[1], whole[2]


def _number(cursor: Cursor, what: str) -> int:
    line = cursor.line()
    if not (line.isdecimal() and line.isascii() and len(line) < 19):
        msg = f"{cursor.path}: expected {what}, found {line[:40]!r}"
        raise ValueError(msg)
    return int(line)


def _quoted(line: str) -> str:
    return line.strip().strip('"')
