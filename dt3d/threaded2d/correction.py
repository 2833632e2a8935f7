"""The sequential correction of swaps that were given up (Kohout et al. 2004, section 3.4).

Any triangulation becomes the Delaunay triangulation when illegal edges are flipped until there are none (C.
L. Lawson: Transforming triangulations, Discrete Mathematics 3, 1972). The flips are entered into the history.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from .._errors import InternalError
from .._numba.kernel_cache import cached_njit
from .._numba.threads import run_threads
from .._numba.unowned import unowned
from . import columns as c
from .columns import edge, edges_of, side, triangle
from .flips import flip
from .geometry import in_conflict
from .illegal_edges import leaves_below
from .mesh import Store
from .steps import GO_ON, stop_reason


@cached_njit
def is_illegal(mesh, t, k):
    """Whether edge k of t is: the far vertex of one side in conflict with the triangle on the other."""
    nodes = mesh.nodes
    beyond = nodes[t, c.NEIGHBOR + k]
    if nodes[t, k] != c.INFINITE:
        return in_conflict(mesh, triangle(beyond), nodes[t, k])
    far = nodes[triangle(beyond), side(beyond)]
    return far != c.INFINITE and in_conflict(mesh, t, far)


@cached_njit
def flip_edge(mesh, t, k):
    """Flip edge k of t; the first of the two new triangles. They count as made by the thread that made t."""
    me = -1 - mesh.nodes[t, c.CHILD]
    if mesh.nodes[t, k] == c.INFINITE:
        beyond = mesh.nodes[t, c.NEIGHBOR + k]
        t, k = triangle(beyond), side(beyond)
    return flip(mesh, me, t, k, 0)


@cached_njit(nogil=True)
def flip_illegal(mesh, edges):
    """Flip those of ``edges`` that are illegal, and what gets illegal thereby, until there are none.

    Or until there is no room for more triangles, or all threads have to stop. There may be quadratically many
    flips; in one call no more than there is room for their triangles. Returns how many, and the edges that
    are left.
    """
    mesh = unowned(mesh)
    top, flips = len(edges), 0
    stack = np.empty(2 * top + 4, np.int64)
    stack[:top] = edges
    while top > 0 and stop_reason(mesh, 0, True) == GO_ON:
        top -= 1
        t, k = triangle(stack[top]), side(stack[top])
        if mesh.nodes[t, c.CHILD] >= 0 or not is_illegal(mesh, t, k):
            continue
        first = flip_edge(mesh, t, k)
        flips += 1
        if top + 4 > len(stack):
            longer = np.empty(2 * len(stack), np.int64)
            longer[:top] = stack[:top]
            stack = longer
        # the edges around the two triangles; the one between them is legal now
        stack[top], stack[top + 1] = edge(first, 0), edge(first, 2)
        stack[top + 2], stack[top + 3] = edge(first + 1, 0), edge(first + 1, 1)
        top += 4
    return flips, stack[:top].copy()


def correct(store: Store, origins: np.ndarray) -> int:
    """Flip edges until no leaf below ``origins``, int32 (k,), has an illegal one.

    Nor has any other that had none before. No thread may be running. Returns how many flips.

    Raises
    ------
    InternalError
        After more flips than there are pairs of vertices, that at infinity included: a flip lowers the
        triangulation when it is lifted to the paraboloid, so that an edge that is gone does not come back.
    """
    store.shared[c.SWAPS_LEFT, 0] = 0
    vertices = len(store.points) + 1
    most = vertices * (vertices - 1) // 2
    used = store.used
    scratch = np.zeros(used, np.bool_), np.empty(used, np.int32), np.empty(used, np.int32)
    count = leaves_below(store.nodes, origins, *scratch)
    edges = edges_of(scratch[2][:count])
    flips = 0
    while len(edges):
        ((more, edges),) = run_threads([partial(flip_illegal, store.mesh(), edges)], store.stop)
        flips += more
        if flips > most:
            msg = "the correction of a 2D triangulation does not end"
            raise InternalError(msg)
        if len(edges):
            store.grow()
    return flips
