"""Facets of tetrahedra, by index only: no coordinates here."""

from __future__ import annotations

import numpy as np

OUTSIDE = -1
"""The neighbour beyond a facet of the convex hull."""

# Row k: the facet opposite the k-th vertex of a positive tetrahedron, counter-clockwise from outside.
OUTWARD = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])


def hull_facets(simplices: np.ndarray, neighbors: np.ndarray) -> np.ndarray:
    """The facets without neighbour, int32 (h, 3), oriented outwards."""
    tetrahedron, k = np.nonzero(neighbors == OUTSIDE)
    return simplices[tetrahedron[:, None], OUTWARD[k]]


def open_edges(facets: np.ndarray) -> int:
    """How many directed edges of a surface lack their opposite; 0 if it is closed."""
    edges = np.concatenate([facets[:, [0, 1]], facets[:, [1, 2]], facets[:, [2, 0]]]).astype(np.int64)
    forth = edges[:, 0] << 32 | edges[:, 1]
    back = edges[:, 1] << 32 | edges[:, 0]
    return len(np.setxor1d(forth, back)) // 2
