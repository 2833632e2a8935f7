"""Facets of simplices, by index only: no coordinates here."""

from __future__ import annotations

import numpy as np

OUTSIDE = -1
"""The neighbour beyond a facet of the convex hull."""

# Row k: the facet opposite the k-th vertex of a positive tetrahedron, counter-clockwise from outside.
OUTWARD = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
# Row k: the edge opposite the k-th vertex of a positive triangle, which has the triangle on its left.
OUTWARD_IN_PLANE = np.array([[1, 2], [2, 0], [0, 1]])


def hull_facets(simplices: np.ndarray, neighbors: np.ndarray) -> np.ndarray:
    """The facets without neighbour, int32 (h, d), oriented outwards, of simplices (m, d + 1)."""
    simplex, k = np.nonzero(neighbors == OUTSIDE)
    outward = OUTWARD if simplices.shape[1] == 4 else OUTWARD_IN_PLANE
    facets: np.ndarray = simplices[simplex[:, None], outward[k]]
    return facets


def open_edges(facets: np.ndarray) -> int:
    """How many directed edges of a surface lack their opposite; 0 if it is closed."""
    edges = np.concatenate([facets[:, [0, 1]], facets[:, [1, 2]], facets[:, [2, 0]]]).astype(np.int64)
    forth = edges[:, 0] << 32 | edges[:, 1]
    back = edges[:, 1] << 32 | edges[:, 0]
    return len(np.setxor1d(forth, back)) // 2


def matched(facets: np.ndarray, backwards: np.ndarray | None = None) -> tuple[np.ndarray, int]:
    """Pairs of rows that are one facet seen from its two sides, int64 (p, 2), and the repeated rows.

    Two rows are seen from one side if an even permutation of vertices makes them equal.

    Parameters
    ----------
    facets : int (f, k)
        Of k = 1, 2 or 3 vertices below 2^25.
    backwards : bool (f,), optional
        The side from which each row is seen, for k = 1, where an order of vertices does not tell.

    Returns
    -------
    pairs : int64 (p, 2)
        With no meaning where rows are repeated.
    repeated : int
        How many rows are an earlier one seen from the same side. If 0, each row is in one pair at most.
    """
    k = facets.shape[1]
    if backwards is None:
        backwards = np.zeros(len(facets), bool)
        for i in range(k):
            for j in range(i + 1, k):
                backwards ^= facets[:, i] > facets[:, j]
    columns = np.sort(facets, axis=1)
    keys = [columns[:, -1].astype(np.int64) << 1 | backwards]
    if k > 1:
        keys.append(columns[:, 0] if k == 2 else columns[:, 0].astype(np.int64) << 32 | columns[:, 1])
    order = np.lexsort(keys)
    ordered = [key[order] for key in keys]
    ordered[0] >>= 1
    same = np.logical_and.reduce([key[1:] == key[:-1] for key in ordered])
    side = backwards[order]
    pairs = np.column_stack([order[:-1][same], order[1:][same]])
    return pairs, int((same & (side[1:] == side[:-1])).sum())
