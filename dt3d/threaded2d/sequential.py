"""The sequential method: locate, subdivide, legalise, one site after the other."""

from __future__ import annotations

import numba

from ..predicates.borrowed import borrowed
from .atomics import cycles, load
from .dag import locate
from .flips import insert
from .store import (
    CHANGE_CYCLES,
    END,
    HINT,
    INSERTED,
    LOCATION_CYCLES,
    NEXT,
    SOFT_LIMIT,
    STOP,
    USED,
    VISITED,
)
from .walk import walk_history

# what a thread's run returns
DONE, STOPPED, FULL = range(3)


@numba.njit(cache=True)
def now():
    """The cycle counter."""
    return cycles()


@numba.njit(nogil=True, cache=True)
def run(points, nodes, shared, state, order, by, me, walking, w):
    """Insert order[NEXT] to order[END - 1] of this thread; `DONE`, or why it came back before."""
    points, nodes, shared, state = borrowed(points), borrowed(nodes), borrowed(shared), borrowed(state)
    order, by, w = borrowed(order), borrowed(by), borrowed(w)
    while state[me, NEXT] < state[me, END]:
        if load(shared, (STOP, 0)) != 0:
            return STOPPED
        if load(shared, (USED, 0)) > shared[SOFT_LIMIT, 0]:
            return FULL
        q = order[state[me, NEXT]]
        if by[q] >= 0:  # a vertex of the first triangle
            state[me, NEXT] += 1
            continue
        begun = cycles()
        if walking:
            t, visited = walk_history(points, nodes, state[me, HINT], q, w)
        else:
            t, visited = locate(points, nodes, q, w)
        located = cycles()
        state[me, HINT] = insert(points, nodes, shared, state, me, t, q, 0, w)
        by[q] = me
        state[me, LOCATION_CYCLES] += located - begun
        state[me, CHANGE_CYCLES] += cycles() - located
        state[me, VISITED] += visited
        state[me, INSERTED] += 1
        state[me, NEXT] += 1
    return DONE
