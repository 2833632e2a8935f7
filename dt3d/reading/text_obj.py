"""Vertices of Wavefront OBJ files."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .text_lines import Lines, content, read_lines, shown
from .text_numbers import numbers

_STATEMENTS = """
v vt vn vp p l f fo o g s mg usemtl mtllib usemap maplib bevel c_interp d_interp lod
deg bmat step cstype curv curv2 surf parm trim hole scrv sp end con call csh
shadow_obj trace_obj ctech stech bsp bzp cdc cdp res
"""
KEYWORDS = set(_STATEMENTS.split())
"""The statements of the format, B1 of Wavefront's Advanced Visualizer manual, those of version 2 included."""

NUMERIC = {"v", "vt", "vn", "vp", "f", "fo", "l", "p"}
"""The statements that numbers alone follow."""

_VERTEX_WITHIN = re.compile(r"v(?:\s+[-+]?[0-9.]+){3}|(?:\s[-+]?[0-9]*\.[0-9]+){3}")
"""What a line that is lost leaves in the name before it."""

WIDTHS = {4, 5, 7, 8}
"""Cells of a vertex: v x y z, also with a weight, a colour, or both."""


def read_obj(path: Path) -> np.ndarray:
    """The vertices (``v x y z``, with or without a weight or a colour) in double precision.

    Returns
    -------
    float64 (n, 3)

    Raises
    ------
    ValueError
        If there are no vertices, or a line is no statement of the format: it could be a damaged vertex.
    """
    lines = _continued(content(read_lines(path), ("#",)))
    vertices: dict[int, list[int]] = {}
    kept: list[int] = []
    for k, line in enumerate(lines.text):
        cells = line.split()
        if cells[0] not in KEYWORDS:
            msg = f"{shown(cells[0])} is not a statement of an OBJ file"
            raise lines.error(k, msg, 1)
        if "v" in line.lstrip()[2:] and cells[0] in NUMERIC:
            msg = f"a second statement on the line: {shown(line)}"
            raise lines.error(k, msg)
        if cells[0] not in NUMERIC and _VERTEX_WITHIN.search(line):
            msg = f"a vertex within a name: {shown(line)}"
            raise lines.error(k, msg)
        if cells[0] == "v":
            if len(cells) not in WIDTHS:
                msg = f"{len(cells) - 1} numbers in a vertex where 3, 4, 6 or 7 are expected: {shown(line)}"
                raise lines.error(k, msg)
            vertices.setdefault(len(cells), []).append(len(kept))
            kept.append(k)
    if not kept:
        msg = f"{path} holds no vertices (lines that start with 'v')"
        raise ValueError(msg)
    rows = lines.with_text(kept)
    points = np.empty((len(rows), 3))
    for width, which in vertices.items():
        group = rows if len(vertices) == 1 else rows.with_text(which)
        points[which] = numbers(group, None, list(range(1, width)), width)[:, :3]
    return points


def _continued(lines: Lines) -> Lines:
    """A backslash at the end of a line joins it with the next."""
    if not any(line.endswith("\\") for line in lines.text):
        return lines
    text, numbers_ = [], []
    joined = ""
    for k, line in enumerate(lines.text):
        if not joined:
            numbers_.append(lines.numbers[k])
        joined += line.removesuffix("\\") + " "
        if not line.endswith("\\"):
            text.append(joined)
            joined = ""
    if joined:
        text.append(joined)
    return Lines(lines.path, text, numbers_)
