"""Location of several sites at a time in the history, node by node in turn.

On its way to a leaf a location waits for memory at nearly every node, in vain: the next node is not known
before. Several of them wait together.
"""

from __future__ import annotations

import numpy as np

from ..._errors import InternalError
from ..._numba.atomics import load_acquire
from ..._numba.kernel_cache import cached_njit
from ..._numba.prefetch import prefetch
from ..dag import child_of
from ..geometry import root_of
from ..mesh import CHILD

LANES = 8

# columns of `lanes`
LANE_SITE, LANE_NODE, LANE_CHILD = range(3)

EMPTY = -1


def empty_lanes(threads: int) -> np.ndarray:
    """The sites on their way, of each thread: int64 (threads, LANES, 4)."""
    return np.full((threads, LANES, 4), EMPTY, np.int64)


@cached_njit(forceinline=True)
def _look_ahead(nodes, lanes, i, t):
    """Let lane i go on from node t; whether t is a leaf."""
    child = load_acquire(nodes, (t, CHILD))
    lanes[i, LANE_NODE], lanes[i, LANE_CHILD] = t, child
    if child < 0:
        return True
    # three children may lie on two lines
    prefetch(nodes, child >> 1)
    prefetch(nodes, (child >> 1) + 2)
    return False


@cached_njit(forceinline=True)
def start(points, nodes, lanes, i, q, w):
    """Let site q begin in lane i, at its root."""
    lanes[i, LANE_SITE] = q
    _look_ahead(nodes, lanes, i, root_of(points, nodes, q, w))


@cached_njit(forceinline=True)
def advance(points, nodes, lanes, w):
    """Go on in all lanes until a site is located: its lane, or `EMPTY` where all are empty; and how many
    nodes were visited."""
    visited = 0
    while True:
        busy = False
        for i in range(LANES):
            q = lanes[i, LANE_SITE]
            if q == EMPTY:
                continue
            busy = True
            child = lanes[i, LANE_CHILD]
            if child < 0:
                return i, visited
            t = child_of(points, nodes, lanes[i, LANE_NODE], child, q, w)
            visited += 1
            if _look_ahead(nodes, lanes, i, t):
                return i, visited
            if visited > LANES * len(nodes):  # each lane visits a node once (`dag`)
                msg = "the history of a 2D triangulation goes round in circles"
                raise InternalError(msg)
        if not busy:
            return EMPTY, visited
