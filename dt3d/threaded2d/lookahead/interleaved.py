"""Location of several sites at a time in the history, node by node in turn: interleaved searches.

On its way to a leaf a location waits for memory at nearly every node, since the next node is not known
before. Several of them wait together.
"""

from __future__ import annotations

import numpy as np

from ..._errors import InternalError
from ..._numba.atomics import load_acquire, rows_apart
from ..._numba.kernel_cache import cached_njit
from ..._numba.prefetch import prefetch
from .. import columns as c
from ..columns import first_child
from ..dag import child_of
from ..geometry import root_of

# columns of a thread's searches: the site or `IDLE`, the node that it has come to, its children, its
# parent
SEARCH_SITE, SEARCH_NODE, SEARCH_CHILDREN, SEARCH_PARENT = range(4)

IDLE = -1


def idle_searches(threads: int, count: int) -> np.ndarray:
    """``count`` searches of each thread: int64 (threads, count or a few more, 4)."""
    searches = rows_apart(threads, 4 * count)
    searches[:] = IDLE
    return searches.reshape(threads, -1, 4)


@cached_njit(forceinline=True)
def _look_ahead(nodes, searches, i, t):
    """Let search i go on from node t; whether t is a leaf."""
    children = load_acquire(nodes, (t, c.CHILD))
    searches[i, SEARCH_PARENT] = searches[i, SEARCH_NODE]
    searches[i, SEARCH_NODE], searches[i, SEARCH_CHILDREN] = t, children
    if children < 0:
        return True
    # three children may lie on two lines of the cache
    prefetch(nodes, first_child(children))
    prefetch(nodes, first_child(children) + 2)
    return False


@cached_njit(forceinline=True)
def start(mesh, searches, i, q):
    """Let search i begin for site q, at its root, which counts as its own parent."""
    root = root_of(mesh, q)
    searches[i, SEARCH_SITE], searches[i, SEARCH_NODE] = q, root
    _look_ahead(mesh.nodes, searches, i, root)


@cached_njit(forceinline=True)
def advance(mesh, searches, count):
    """Go on with the first ``count`` searches until a site is located.

    Returns its search, or `IDLE` where all are idle; and how many nodes were visited.
    """
    visited = 0
    while True:
        busy = False
        for i in range(count):
            q = searches[i, SEARCH_SITE]
            if q == IDLE:
                continue
            busy = True
            children = searches[i, SEARCH_CHILDREN]
            if children < 0:
                return i, visited
            t = child_of(mesh, searches[i, SEARCH_NODE], children, q)
            visited += 1
            if _look_ahead(mesh.nodes, searches, i, t):
                return i, visited
            if visited > count * len(mesh.nodes):  # each search visits a node once (`dag`)
                msg = "the history of a 2D triangulation goes round in circles"
                raise InternalError(msg)
        if not busy:
            return IDLE, visited
