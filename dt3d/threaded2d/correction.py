"""The sequential correction of swaps that were given up (Kohout et al. 2004, section 3.4).

Any triangulation becomes the Delaunay triangulation when illegal edges are flipped until there are none (C.
L. Lawson: Transforming triangulations, Discrete Mathematics 3, 1972). The flips are entered into the history.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from .._errors import InternalError
from .._numba.kernel_cache import cached_njit
from .._numba.threads import run_threads
from .._numba.unowned import unowned
from .flips import flip
from .illegal_edges import leaves_below
from .in_place.cavity import in_conflict
from .mesh import CHILD, INFINITE, NEIGHBOR, USED, Store
from .steps import GO_ON, verdict


@cached_njit
def _illegal(points, nodes, t, k, w):
    """Whether edge k of t is: the far vertex of one side in conflict with the triangle on the other."""
    edge = nodes[t, NEIGHBOR + k]
    if nodes[t, k] != INFINITE:
        return in_conflict(points, nodes, edge >> 2, nodes[t, k], w)
    far = nodes[edge >> 2, edge & 3]
    return far != INFINITE and in_conflict(points, nodes, t, far, w)


@cached_njit
def _flip(nodes, shared, state, t, k):
    """Flip edge k of t; the first of the two new triangles. They count as made by the thread that made t."""
    me = -1 - nodes[t, CHILD]
    if nodes[t, k] == INFINITE:
        edge = nodes[t, NEIGHBOR + k]
        t, k = edge >> 2, edge & 3
    return flip(nodes, shared, state, me, t, k, 0)


@cached_njit(nogil=True)
def _flip_illegal(points, nodes, shared, state, edges, w):
    """Flip those of ``edges`` that are illegal, and what gets illegal thereby, until there are none, or there
    is no room for more triangles, or all threads have to stop; how many flips, and the edges that are left.

    There may be quadratically many; in one call no more than there is room for their triangles.
    """
    points, nodes, shared = unowned(points), unowned(nodes), unowned(shared)
    state, w = unowned(state), unowned(w)
    top, flips = len(edges), 0
    stack = np.empty(2 * top + 4, np.int64)
    stack[:top] = edges
    while top > 0 and verdict(shared, True, True) == GO_ON:
        top -= 1
        t, k = stack[top] >> 2, stack[top] & 3
        if nodes[t, CHILD] >= 0 or not _illegal(points, nodes, t, k, w):
            continue
        first = _flip(nodes, shared, state, t, k)
        flips += 1
        if top + 4 > len(stack):
            longer = np.empty(2 * len(stack), np.int64)
            longer[:top] = stack[:top]
            stack = longer
        # the edges around the two triangles; the one between them is legal now
        stack[top], stack[top + 1] = 4 * first, 4 * first + 2
        stack[top + 2], stack[top + 3] = 4 * first + 4, 4 * first + 5
        top += 4
    return flips, stack[:top].copy()


def correct(store: Store, origins: np.ndarray, work: np.ndarray, stop: Callable[[], None]) -> int:
    """Flip edges until no leaf below ``origins``, int32 (k,), has an illegal one, nor any other that had none
    before; how many flips.

    ``work`` is the array of the predicates; ``stop`` sets the store's `STOP`.

    Raises
    ------
    InternalError
        After more flips than there are pairs of vertices, that at infinity included: a flip lowers the
        triangulation when it is lifted to the paraboloid, so that an edge that is gone does not come back.
    """
    vertices = len(store.points) + 1
    most = vertices * (vertices - 1) // 2
    used = int(store.shared[USED, 0])
    scratch = np.zeros(used, np.bool_), np.empty(used, np.int32), np.empty(used, np.int32)
    count = leaves_below(store.nodes, origins, *scratch)
    edges = (4 * scratch[2][:count, None].astype(np.int64) + np.arange(3)).ravel()
    flips = 0
    while len(edges):
        task = partial(_flip_illegal, store.points, store.nodes, store.shared, store.state, edges, work)
        ((more, edges),) = run_threads([task], stop)
        flips += more
        if flips > most:
            msg = "the correction of a 2D triangulation does not end"
            raise InternalError(msg)
        if len(edges):
            store.grow()
    return flips
