"""The corners of STL surfaces, in text and binary.

VTK takes a file that is cut off for a smaller one; the size of a binary file tells how many triangles it has.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .cursor import numbers

HEADER, TRIANGLE = 80, 50

SHAPE = ("facet normal", "outer loop", "vertex", "vertex", "vertex", "endloop", "endfacet")
"""The lines of a triangle in text, by the words they start with."""


def read_stl(path: Path) -> np.ndarray:
    """The corners (n, 3), each once, in the order in which they first appear.

    STL repeats a corner in every triangle that has it. Text is read in double precision; binary
    files have single precision.

    Raises
    ------
    ValueError
        If the file has not the size that its number of triangles asks for, or odd lines.
    """
    data = path.read_bytes()
    n = int.from_bytes(data[HEADER : HEADER + 4], "little")
    # binary files may start with "solid", too
    if len(data) == HEADER + 4 + TRIANGLE * n and len(data) > HEADER:
        triangle = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
        corners = np.frombuffer(data, triangle, n, HEADER + 4)["corners"].reshape(-1, 3)
    elif data.lstrip()[:5].lower() == b"solid":
        corners = _text(path, data)
    elif len(data) < HEADER + 4:
        msg = f"{path} is no STL file: it has {len(data)} bytes, and does not start with 'solid'"
        raise ValueError(msg)
    else:
        size = HEADER + 4 + TRIANGLE * n
        msg = f"{path} is damaged: its {n} triangles take {size} bytes, and it has {len(data)}"
        raise ValueError(msg)
    if not len(corners):
        msg = f"{path} holds no triangles"
        raise ValueError(msg)
    _, first = np.unique(corners, axis=0, return_index=True)
    return corners[np.sort(first)]


def _text(path: Path, data: bytes) -> np.ndarray:
    """The corners of all triangles, line by line."""
    corners, expected, inside = [], 0, False
    for number, raw in enumerate(data.decode("utf-8", "replace").splitlines(), 1):
        words = raw.split()
        if not words:
            continue
        line = " ".join(words).lower()
        if not inside and words[0].lower() == "solid":
            inside = True
        elif inside and expected == 0 and words[0].lower() == "endsolid":
            inside = False
        elif inside and line.startswith(SHAPE[expected]):
            if SHAPE[expected] == "vertex":
                corners.append(_vertex(path, number, words))
            expected = (expected + 1) % len(SHAPE)
        else:
            wanted = SHAPE[expected] if inside else "solid"
            msg = f"{path}, line {number}: expected {wanted!r}, found {' '.join(words)[:40]!r}"
            raise ValueError(msg)
    if inside:
        msg = f"{path} is cut off: its last line is not 'endsolid'"
        raise ValueError(msg)
    return np.array(corners).reshape(-1, 3)


def _vertex(path: Path, number: int, words: list[str]) -> list[float]:
    try:
        _, x, y, z = (word.encode() for word in words)
        return [float(number) for number in numbers([x, y, z], False, "corners")]
    except ValueError:
        msg = f"{path}, line {number}: expected 'vertex x y z', found {' '.join(words)[:60]!r}"
        raise ValueError(msg) from None
