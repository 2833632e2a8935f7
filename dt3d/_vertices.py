"""Which vertices are joined by an edge."""

from __future__ import annotations

import numpy as np

from ._memory import require
from ._numba.kernel_cache import cached_njit


@cached_njit
def _around(simplices, n):
    """The tetrahedra around each vertex: where those of vertex v begin, and all of them."""
    begin = np.zeros(n + 1, np.int64)
    for t in range(len(simplices)):
        for k in range(4):
            begin[simplices[t, k] + 1] += 1
    for v in range(n):
        begin[v + 1] += begin[v]
    at, around = begin[:-1].copy(), np.empty(4 * len(simplices), np.int32)
    for t in range(len(simplices)):
        for k in range(4):
            v = simplices[t, k]
            around[at[v]] = t
            at[v] += 1
    return begin, around


def neighbors_of_vertices(simplices: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray]:
    """(indptr, indices), int32: indices[indptr[v]:indptr[v + 1]] are the vertices that an edge joins with v,
    in ascending order; for tetrahedra int (m, 4) of n sites.

    Raises
    ------
    MemoryError
        If the system does not have the memory.
    """
    m = len(simplices)
    require(f"finding the neighbors of {n} vertices", 16 * n + 28 * m, 16 * n + 68 * m)
    return _neighbors(simplices, n)


@cached_njit
def _neighbors(simplices, n):
    begin, around = _around(simplices, n)
    indptr = np.zeros(n + 1, np.int32)
    indices = np.empty(12 * len(simplices), np.int32)  # only what is used gets memory
    seen = np.full(n, -1, np.int32)
    count = 0
    for v in range(n):
        first = count
        for i in range(begin[v], begin[v + 1]):
            for k in range(4):
                u = simplices[around[i], k]
                if u != v and seen[u] != v:
                    seen[u] = v
                    indices[count] = u
                    count += 1
        indices[first:count].sort()
        indptr[v + 1] = count
    return indptr, indices[:count].copy()
