"""Which vertices are joined by an edge."""

from __future__ import annotations

import numpy as np

from ._memory import require
from ._numba.kernel_cache import cached_njit


@cached_njit
def _around(simplices, n, corners):
    """The tetrahedra around each vertex: where those of vertex v begin, and all of them."""
    begin = np.zeros(n + 1, np.int64)
    for t in range(len(simplices)):
        for k in range(len(corners)):
            begin[simplices[t, k] + 1] += 1
    for v in range(n):
        begin[v + 1] += begin[v]
    at, around = begin[:-1].copy(), np.empty(simplices.size, np.int32)
    for t in range(len(simplices)):
        for k in range(len(corners)):
            v = simplices[t, k]
            around[at[v]] = t
            at[v] += 1
    return begin, around


def neighbors_of_vertices(simplices: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray]:
    """The vertices that an edge joins with each of n sites, of simplices int (m, d + 1): (indptr, indices).

    Both are int32: indices[indptr[v]:indptr[v + 1]] are those of vertex v, in ascending order.

    Raises
    ------
    MemoryError
        If the system does not have the memory.
    """
    m, corners = simplices.shape
    every = 4 * corners * m  # bytes of the simplices around each vertex; an edge is in several simplices
    least, most = every + 12 * m, corners * every + 4 * m
    require(f"finding the neighbors of {n} vertices", 16 * n + least, 16 * n + most)
    # a tuple, whose length the compiler knows
    indptr, indices = _neighbors(simplices, n, tuple(range(corners)))
    return indptr, indices


@cached_njit
def _neighbors(simplices, n, corners):
    begin, around = _around(simplices, n, corners)
    indptr = np.zeros(n + 1, np.int32)
    indices = np.empty((len(corners) - 1) * simplices.size, np.int32)  # only what is used gets memory
    seen = np.full(n, -1, np.int32)
    count = 0
    for v in range(n):
        first = count
        for i in range(begin[v], begin[v + 1]):
            for k in range(len(corners)):
                u = simplices[around[i], k]
                if u != v and seen[u] != v:
                    seen[u] = v
                    indices[count] = u
                    count += 1
        indices[first:count].sort()
        indptr[v + 1] = count
    return indptr, indices[:count].copy()
