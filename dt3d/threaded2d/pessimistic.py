"""The pessimistic method: location in all threads, changes in one critical section (Kolingerova and Kohout
2000)."""

from __future__ import annotations

import numba

from ..predicates.borrowed import borrowed
from .atomics import compare_and_swap, cycles, give_way, load, release
from .dag import descend, locate
from .flips import insert
from .sequential import DONE, FULL, STOPPED
from .store import (
    CHANGE_CYCLES,
    CRITICAL,
    END,
    HINT,
    INSERTED,
    LOCATION_CYCLES,
    NEXT,
    SOFT_LIMIT,
    STOP,
    USED,
    VISITED,
    WAIT_CYCLES,
    WAITS,
    stumble,
)
from .walk import walk_history


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
        stumble(shared, state, me)
        if not compare_and_swap(shared, (CRITICAL, 0), 0, me + 1):
            state[me, WAITS] += 1
            while not compare_and_swap(shared, (CRITICAL, 0), 0, me + 1):
                if load(shared, (STOP, 0)) != 0:
                    return STOPPED
                give_way()
        entered = cycles()
        # what was a leaf before may have children now
        if walking:
            t, more = walk_history(points, nodes, t, q, w)
        else:
            t, more = descend(points, nodes, t, q, w)
        state[me, HINT] = insert(points, nodes, shared, state, me, t, q, 0, w)
        release(shared, (CRITICAL, 0))
        by[q] = me
        stumble(shared, state, me)
        state[me, LOCATION_CYCLES] += located - begun
        state[me, WAIT_CYCLES] += entered - located
        state[me, CHANGE_CYCLES] += cycles() - entered
        state[me, VISITED] += visited + more
        state[me, INSERTED] += 1
        state[me, NEXT] += 1
    return DONE
