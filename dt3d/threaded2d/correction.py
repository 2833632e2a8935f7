"""The sequential correction of swaps that were given up (Kohout et al. 2004, section 3.4).

Any triangulation becomes the Delaunay triangulation when illegal edges are flipped until there are none (C.
L. Lawson: Transforming triangulations, Discrete Mathematics 3, 1972). This is done in place: the history is
not needed any more.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise

import numba
import numpy as np

from ..predicates.borrowed import borrowed
from .atomics import load
from .cavity import in_conflict
from .prefetch import prefetch, prefetch_around
from .store import CHILD, INFINITE, NEIGHBOR, STOP, USED, Store
from .threads import together

AHEAD = 8  # leaves between asking for a leaf's surroundings and for what lies beyond them


@numba.njit(cache=True)
def _illegal(points, nodes, t, k, w):
    """Whether edge k of t is: the far vertex of one side in conflict with the triangle on the other."""
    edge = nodes[t, NEIGHBOR + k]
    if nodes[t, k] != INFINITE:
        return in_conflict(points, nodes, edge >> 2, nodes[t, k], w)
    far = nodes[edge >> 2, edge & 3]
    return far != INFINITE and in_conflict(points, nodes, t, far, w)


@numba.njit(cache=True)
def _set(nodes, t, k, edge):
    nodes[t, NEIGHBOR + k] = edge
    nodes[edge >> 2, NEIGHBOR + (edge & 3)] = 4 * t + k


@numba.njit(cache=True)
def _flip(nodes, t, k):
    """Flip edge k of t: t and its neighbour u become the two triangles on both sides of the new edge."""
    edge = nodes[t, NEIGHBOR + k]
    u, j = edge >> 2, edge & 3
    k1, k2, j1, j2 = (k + 1) % 3, (k + 2) % 3, (j + 1) % 3, (j + 2) % 3
    p, a, b, d = nodes[t, k], nodes[t, k1], nodes[t, k2], nodes[u, j]
    beyond_bp, beyond_pa = nodes[t, NEIGHBOR + k1], nodes[t, NEIGHBOR + k2]
    beyond_ad, beyond_db = nodes[u, NEIGHBOR + j1], nodes[u, NEIGHBOR + j2]
    nodes[t, 0], nodes[t, 1], nodes[t, 2] = p, a, d
    nodes[u, 0], nodes[u, 1], nodes[u, 2] = p, d, b
    _set(nodes, t, 0, beyond_ad)
    _set(nodes, t, 2, beyond_pa)
    _set(nodes, u, 0, beyond_db)
    _set(nodes, u, 1, beyond_bp)
    _set(nodes, t, 1, 4 * u + 2)


@numba.njit(nogil=True, cache=True)
def find_illegal(points, nodes, leaves, begin, end, found, w):
    """Enter the illegal edges of leaves[begin : end], as 4 t + k, into ``found``; how many there are."""
    points, nodes, leaves, w = borrowed(points), borrowed(nodes), borrowed(leaves), borrowed(w)
    count = 0
    for i in range(begin, end):
        prefetch_around(points, nodes, leaves[min(i + 2 * AHEAD, end - 1)])
        ahead = leaves[min(i + AHEAD, end - 1)]
        for k in range(3):
            edge = nodes[ahead, NEIGHBOR + k]
            prefetch(points, nodes[edge >> 2, edge & 3])
        t = leaves[i]
        for k in range(3):
            # an edge is illegal from both sides or from none
            if nodes[t, NEIGHBOR + k] >> 2 < t and _illegal(points, nodes, t, k, w):
                found[count] = 4 * t + k
                count += 1
    return count


@numba.njit(nogil=True, cache=True)
def flip_illegal(points, nodes, shared, edges, w):
    """Flip ``edges``, and those that get illegal thereby, until no edge is illegal or all threads have to
    stop; how many flips.

    There may be quadratically many.
    """
    points, nodes, shared, w = borrowed(points), borrowed(nodes), borrowed(shared), borrowed(w)
    top, flips = len(edges), 0
    stack = np.empty(2 * top + 4, np.int64)
    stack[:top] = edges
    while top > 0 and load(shared, (STOP, 0)) == 0:
        top -= 1
        t, k = stack[top] >> 2, stack[top] & 3
        if not _illegal(points, nodes, t, k, w):
            continue
        u = nodes[t, NEIGHBOR + k] >> 2
        _flip(nodes, t, k)
        flips += 1
        if top + 4 > len(stack):
            longer = np.empty(2 * len(stack), np.int64)
            longer[:top] = stack[:top]
            stack = longer
        # the edges around the two triangles; the one between them is legal now
        stack[top], stack[top + 1], stack[top + 2], stack[top + 3] = 4 * t, 4 * t + 2, 4 * u, 4 * u + 1
        top += 4
    return flips


def correct(store: Store, works: Sequence[np.ndarray], stop: Callable[[], None]) -> int:
    """Flip edges until none is illegal; how many flips.

    Illegal edges are looked for by as many threads as there are work arrays of the predicates. ``stop`` sets
    the store's `STOP`.
    """
    points, nodes, shared = store.points, store.nodes, store.shared
    used = int(shared[USED, 0])
    leaves = np.flatnonzero(nodes[:used, CHILD] < 0)
    bounds = [len(leaves) * k // len(works) for k in range(len(works) + 1)]
    found = [np.empty(3 * (end - begin), np.int64) for begin, end in pairwise(bounds)]

    def task(k: int) -> int:
        return find_illegal(points, nodes, leaves, bounds[k], bounds[k + 1], found[k], works[k])

    counts = together([partial(task, k) for k in range(len(works))], stop)
    edges = np.concatenate([f[:count] for f, count in zip(found, counts, strict=True)])
    (flips,) = together([partial(flip_illegal, points, nodes, shared, edges, works[0])], stop)
    return int(flips)
