"""One order of the tetrahedra and of their vertices, whatever the order in which they were found.

Vertices ascend, but for the last two, which change places where the orientation asks for it. Tetrahedra are
in the lexicographic order of their first three vertices: an oriented facet has one tetrahedron on its
positive side, so no two have the same.
"""

from __future__ import annotations

import numpy as np

from ..outcome import Outcome

VERTEX_BITS = 21  # of a vertex where three of them fit into a word


def canonical(
    simplices: np.ndarray, neighbors: np.ndarray, iteration: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The same triangulation in canonical order.

    Parameters
    ----------
    simplices, neighbors : ndarray of int32 (m, 4)
        All tetrahedra positive; no neighbor is a negative number.
    iteration : ndarray of int32 (m,)
        Of each tetrahedron.
    """
    # each vertex carries its place in the two lowest bits
    columns = [np.left_shift(simplices[:, k], 2) + np.int32(k) for k in range(4)]
    odd = np.zeros(len(simplices), bool)
    for i, j in ((0, 1), (2, 3), (0, 2), (1, 3), (1, 2)):
        odd ^= columns[i] > columns[j]
        columns[i], columns[j] = np.minimum(columns[i], columns[j]), np.maximum(columns[i], columns[j])
    columns[2], columns[3] = np.where(odd, columns[3], columns[2]), np.where(odd, columns[2], columns[3])
    order = _order(*(c >> 2 for c in columns[:3]))
    rows = np.stack([c >> 2 for c in columns], axis=1)
    sides = np.ascontiguousarray(neighbors.T)
    # np.choose would do, more slowly
    turned = np.stack([_chosen(c & 3, sides) for c in columns], axis=1)
    place = np.empty(len(order) + 1, np.int32)
    place[order] = np.arange(len(order), dtype=np.int32)
    place[-1] = -1  # where there is no neighbor
    return np.take(rows, order, axis=0), place[np.take(turned, order, axis=0)], iteration[order]


def in_canonical_order(out: Outcome) -> Outcome:
    """The outcome, its tetrahedra in an order that does not depend on the machine."""
    rows = canonical(out.simplices, out.neighbors, out.iteration)
    out.simplices, out.neighbors, out.iteration = rows
    return out


def _chosen(k: np.ndarray, values: np.ndarray) -> np.ndarray:
    low = np.where(k & 1, values[1], values[0])
    chosen: np.ndarray = np.where(k & 2, np.where(k & 1, values[3], values[2]), low)
    return chosen


def _order(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    if max(x.max(initial=0) for x in (a, b, c)) >= 1 << VERTEX_BITS:
        return np.lexsort((c, b, a))
    first, second = a.astype(np.int64) << 2 * VERTEX_BITS, b.astype(np.int64) << VERTEX_BITS
    return np.argsort(first | second | c)
