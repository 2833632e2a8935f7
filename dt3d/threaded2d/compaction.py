"""What is left in the end: the triangles without infinite vertex, without gaps."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from itertools import pairwise
from typing import Any

import numba
import numpy as np

from .store import CHILD, NEIGHBOR
from .threads import together


@numba.njit(nogil=True, cache=True)
def _number(nodes, begin, end, number):
    """Number the finite leaves among nodes begin to end - 1 from 0 on; how many."""
    m = 0
    for t in range(begin, end):
        if nodes[t, CHILD] < 0 and min(nodes[t, 0], nodes[t, 1], nodes[t, 2]) >= 0:
            number[t] = m
            m += 1
        else:
            number[t] = -1
    return m


@numba.njit(nogil=True, cache=True)
def _shift(number, begin, end, before):
    for t in range(begin, end):
        if number[t] >= 0:
            number[t] += before


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
    bounds = list(pairwise([used * k // threads for k in range(threads + 1)]))
    counts = _together(partial(_number, nodes, begin, end, number) for begin, end in bounds)
    before = np.concatenate([[0], np.cumsum(counts)])
    _together(partial(_shift, number, *bounds[k], before[k]) for k in range(1, threads))
    m = before[-1]
    triangles, neighbors = np.empty((m, 3), np.int32), np.empty((m, 3), np.int32)
    maker = np.empty(m, np.int16)
    _together(
        partial(_collect, nodes, begin, end, number, site, triangles, neighbors, maker)
        for begin, end in bounds
    )
    return triangles, neighbors, maker


def _together(tasks: Iterable[Callable[[], Any]]) -> list[Any]:
    """Run tasks that are too short to be stopped."""
    return together(list(tasks), lambda: None)
