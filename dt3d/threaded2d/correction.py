"""The sequential correction of swaps that were given up (Kohout et al. 2004, section 3.4).

Any triangulation becomes the Delaunay triangulation when illegal edges are flipped until there are none (C.
L. Lawson: Transforming triangulations, Discrete Mathematics 3, 1972). This is done in place: the history is
not needed any more.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numba
import numpy as np

from ..predicates.borrowed import borrowed
from .atomics import load
from .cavity import in_conflict
from .store import INFINITE, NEIGHBOR, STOP, USED, Store
from .suspects import leaves_below
from .threads import together


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


@numba.njit(cache=True)
def _flip_illegal(points, nodes, shared, edges, w):
    """Flip ``edges``, and those that get illegal thereby, until no edge is illegal or all threads have to
    stop; how many flips.

    There may be quadratically many.
    """
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


@numba.njit(nogil=True, cache=True)
def _correct(points, nodes, shared, origins, seen, stack, leaves, w):
    """Flip what is illegal among the leaves below ``origins``, and what gets illegal thereby."""
    points, nodes, shared, w = borrowed(points), borrowed(nodes), borrowed(shared), borrowed(w)
    count = leaves_below(nodes, origins, seen, stack, leaves)
    edges = np.empty(3 * count, np.int64)
    for i in range(count):
        for k in range(3):
            edges[3 * i + k] = 4 * leaves[i] + k
    return _flip_illegal(points, nodes, shared, edges, w)


def correct(store: Store, origins: np.ndarray, work: np.ndarray, stop: Callable[[], None]) -> int:
    """Flip edges until no leaf below ``origins``, int32 (k,), has an illegal one, nor any other that had none
    before; how many flips.

    ``work`` is the array of the predicates; ``stop`` sets the store's `STOP`.
    """
    used = int(store.shared[USED, 0])
    scratch = np.zeros(used, np.bool_), np.empty(used, np.int32), np.empty(used, np.int32)
    task = partial(_correct, store.points, store.nodes, store.shared, origins, *scratch, work)
    (flips,) = together([task], stop)
    return int(flips)
