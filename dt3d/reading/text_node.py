"""Points of .node files, which TetGen and Triangle read and write."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .text_lines import content, read_lines, shown
from .text_numbers import numbers

_HEADER = re.compile(r"([0-9]{1,18})(?:\s+([0-9]{1,3}))?(?:\s+([0-9]{1,3}))?(?:\s+([01]))?", re.ASCII)


def read_node(path: Path) -> np.ndarray:
    """The points of a file ``n dimension attributes markers``, then ``index x y [z] ...`` per point.

    Returns
    -------
    float64 (n, 3) or (n, 2)

    Raises
    ------
    ValueError
        If there are not as many points or columns as promised, or the indices do not count from 0 or 1.
    """
    lines = content(read_lines(path), ("#",))
    if not len(lines):
        msg = f"{path} is empty; expected the number of points, and points"
        raise ValueError(msg)
    found = _HEADER.fullmatch(lines.text[0].strip())
    if not found:
        msg = f"{shown(lines.text[0])} should be the numbers of points, dimensions, attributes and markers"
        raise lines.error(0, msg)
    # Triangle's dimension is 2, and TetGen takes 3 where there is none
    count, dimension, attributes, markers = (
        int(cell) if cell else default for cell, default in zip(found.groups(), (0, 3, 0, 0), strict=True)
    )
    if dimension not in (2, 3):
        msg = f"dimension {dimension}, expected 2 or 3"
        raise lines.error(0, msg)
    rows = lines[1:]
    if len(rows) != count or not count:
        msg = f"{path} promises {count} points, but {len(rows)} lines follow"
        raise ValueError(msg)
    table = numbers(rows, None, list(range(1 + dimension)), 1 + dimension + attributes + markers)
    start = table[0, 0]
    wrong = np.flatnonzero(table[:, 0] != start + np.arange(count))
    if start not in (0, 1) or len(wrong):
        k = int(wrong[0]) if len(wrong) else 0
        msg = f"index {shown(rows.text[k].split()[0])}; points are numbered in order, from 0 or from 1"
        raise rows.error(k, msg, 1)
    return table[:, 1:]
