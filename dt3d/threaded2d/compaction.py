"""What is left in the end: the triangles without infinite vertex, without gaps."""

from __future__ import annotations

from functools import partial
from itertools import pairwise

import numba
import numpy as np

from .store import CHILD, NEIGHBOR
from .threads import together


@numba.njit(nogil=True, cache=True)
def _number(nodes, used, number):
    m = 0
    for t in range(used):
        if nodes[t, CHILD] < 0 and min(nodes[t, 0], nodes[t, 1], nodes[t, 2]) >= 0:
            number[t] = m
            m += 1
        else:
            number[t] = -1
    return m


@numba.njit(nogil=True, cache=True)
def _collect(nodes, begin, end, number, site, triangles, neighbors, maker):
    for t in range(begin, end):
        s = number[t]
        if s >= 0:
            for k in range(3):
                triangles[s, k] = site[nodes[t, k]]
                neighbors[s, k] = number[nodes[t, NEIGHBOR + k] >> 2]
            maker[s] = -1 - nodes[t, CHILD]


def compact(
    nodes: np.ndarray, used: int, site: np.ndarray, threads: int = 1
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Finite triangles, their neighbours, and the threads that made them: int32 (m, 3), (m, 3), int16 (m,).

    ``site`` holds the number of each row of the points, int (n,).
    """
    number = np.empty(used, np.int32)
    m = _number(nodes, used, number)
    triangles, neighbors = np.empty((m, 3), np.int32), np.empty((m, 3), np.int32)
    maker = np.empty(m, np.int16)
    bounds = [used * k // threads for k in range(threads + 1)]
    together(
        [
            partial(_collect, nodes, begin, end, number, site, triangles, neighbors, maker)
            for begin, end in pairwise(bounds)
        ],
        lambda: None,
    )
    return triangles, neighbors, maker
