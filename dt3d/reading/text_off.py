"""Vertices of OFF files, Geomview's Object File Format, as they are in the wild."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .text_lines import Lines, content, read_lines, shown
from .text_numbers import numbers

_MAGIC = re.compile(r"(ST)?(C)?(N)?(4)?(n)?OFF", re.ASCII)
_COUNTS = re.compile(r"([0-9]{1,18})\s+([0-9]{1,18})(?:\s+[0-9]{1,18})?")


def read_off(path: Path) -> np.ndarray:
    """The vertices of a file; its faces are counted but not read.

    The first line may be ``OFF``, any of ``COFF NOFF CNOFF STOFF`` ..., may have the counts behind it, with
    or without a blank, or be missing. Behind a vertex there may be its normal, colour and texture.

    Returns
    -------
    float64 (n, 3)

    Raises
    ------
    ValueError
        If the lines are fewer, or more, than the counts promise, the file is binary, or not of three
        dimensions.
    """
    lines = content(read_lines(path), ("#",))
    if not len(lines):
        msg = f"{path} is empty; expected OFF"
        raise ValueError(msg)
    counts, at = _counts(lines)
    vertices, faces = counts
    rows = lines[at:]
    if len(rows) != vertices + faces:
        msg = f"{path} promises {vertices} vertices and {faces} faces, but {len(rows)} lines follow"
        raise ValueError(msg)
    if not vertices:
        msg = f"{path} holds no vertices"
        raise ValueError(msg)
    _check_faces(rows[vertices:], vertices)
    rows = rows[:vertices]
    width = len(rows.text[0].split())
    if width < 3:
        msg = f"{width} coordinates where 3 are expected"
        raise rows.error(0, msg)
    return numbers(rows, None, list(range(width)), width)[:, :3]


def _counts(lines: Lines) -> tuple[tuple[int, int], int]:
    """The numbers of vertices and faces, and how many lines stand before the vertices."""
    first = lines.text[0].strip()
    magic = _MAGIC.match(first)
    if magic and (magic[4] or magic[5]):
        msg = f"{magic[0]} has other than three dimensions"
        raise lines.error(0, msg)
    behind = first[magic.end() :].strip() if magic else first
    if magic and behind.upper().startswith("BINARY"):
        msg = "a binary OFF file; write it as text"
        raise lines.error(0, msg)
    k = 0
    if not behind and len(lines) > 1:
        k, behind = 1, lines.text[1].strip()
    found = _COUNTS.fullmatch(behind)
    if not found:
        msg = f"{shown(behind)} where the numbers of vertices and faces are expected"
        raise lines.error(k, msg)
    return (int(found[1]), int(found[2])), k + 1


def _check_faces(faces: Lines, vertices: int) -> None:
    """Whether lines look like faces: a vertex too many among them would else be taken for one."""
    for k, line in enumerate(faces.text):
        cells = line.split()
        size = int(cells[0]) if cells[0].isdecimal() and len(cells[0]) < 10 else -1
        corners = cells[1 : size + 1]
        if size < 1 or len(corners) < size or not all(c.isdecimal() and len(c) < 19 for c in corners):
            msg = f"{shown(line)} is not a face: the number of its vertices, and their indices"
            raise faces.error(k, msg)
        if any(int(corner) >= vertices for corner in corners):
            msg = f"a face has a vertex that is not there; they are numbered 0 to {vertices - 1}"
            raise faces.error(k, msg)
