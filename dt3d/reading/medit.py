"""Vertices and elements of Medit's .mesh files in text.

Source: Frey, "MEDIT, an interactive mesh visualization software", INRIA RT-0253, appendix A. meshio is not
used: it ends the process where a file is empty.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from .cursor import Cursor

ELEMENTS = {
    "edges": (2, 3), "triangles": (3, 5), "quadrilaterals": (4, 9), "tetrahedra": (4, 10),
    "hexahedra": (8, 12), "hexaedra": (8, 12), "prisms": (6, 13), "pyramids": (5, 14),
}  # fmt: skip
"""Vertices of an element and VTK's type, by keyword. A reference follows the vertices."""

SKIPPED = {
    "corners": 1, "requiredvertices": 1, "ridges": 1, "requirededges": 1, "requiredtriangles": 1,
    "requiredquadrilaterals": 1, "normalatvertices": 2, "tangentatvertices": 2, "tangentatedges": 3,
    "normalattrianglevertices": 3, "normalatquadrilateralvertices": 3,
}  # fmt: skip
"""Whole numbers in a row of what is not read, by keyword."""

VECTORS = ("normals", "tangents")


def read_medit(path: Path) -> dict[str, np.ndarray]:
    """Vertices and elements.

    Returns
    -------
    dict
        "points", float64 (n, 2) or (n, 3); "types" (m,), VTK's; "offsets" (m + 1,); "connectivity", from 0;
        "iteration" (m,): the references.

    Raises
    ------
    ValueError
        If the file is cut off, has a keyword that is not known, or rows that do not go with it.
    """
    data = re.sub(rb"#[^\r\n]*", b"", path.read_bytes())
    cursor = Cursor(path, data)
    if cursor.look() is None or cursor.word("").lower() != "meshversionformatted":
        msg = f"{path} is no Medit file: it should start with MeshVersionFormatted"
        raise ValueError(msg)
    cursor.count("the version")
    dimension, points = 0, None
    types, sizes, corners, references = [], [], [], []
    while cursor.look() is not None:
        word = cursor.word("a keyword")
        key = word.lower()
        if key == "end":
            break
        if key == "dimension":
            dimension = cursor.count("the dimension")
            continue
        n = cursor.count(f"the number after {word[:40]!r}")
        if key == "vertices":
            if dimension not in (2, 3):
                msg = f"{path}: the dimension is {dimension}, expected 2 or 3"
                raise ValueError(msg)
            points = cursor.text(n * (dimension + 1), False, "vertices").reshape(n, -1)[:, :dimension]
        elif key in ELEMENTS:
            size, kind = ELEMENTS[key]
            rows = cursor.text(n * (size + 1), True, word).reshape(n, size + 1)
            types.append(np.full(n, kind))
            sizes.append(np.full(n, size))
            corners.append(rows[:, :size].ravel() - 1)
            references.append(rows[:, size])
        elif key in SKIPPED:
            cursor.text(n * SKIPPED[key], True, word)
        elif key in VECTORS:
            cursor.text(n * dimension, False, word)
        else:
            msg = f"{path}: {word[:40]!r} is no keyword of Medit's that is known; the file may be damaged"
            raise ValueError(msg)
    if points is None or not len(points):
        msg = f"{path} holds no vertices"
        raise ValueError(msg)
    whole = np.empty(0, np.int64)
    return {
        "points": points,
        "types": np.concatenate([whole, *types]),
        "offsets": np.append(0, np.cumsum(np.concatenate([whole, *sizes]))),
        "connectivity": np.concatenate([whole, *corners]),
        "iteration": np.concatenate([whole, *references]),
    }
