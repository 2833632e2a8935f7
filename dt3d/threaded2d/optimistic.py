"""The optimistic method: exclusive access node by node (Kolingerova and Kohout 2002).

Before a thread changes anything it has locked all triangles in conflict with its site and those around them; if it
does not get one, it gives all of them back and locates again from where it was. So every insertion begins and ends with a
Delaunay triangulation, no swap is given up, and no thread waits for another while it holds anything.
"""

from __future__ import annotations

import numba

from ..predicates.borrowed import borrowed
from .atomics import cycles, give_way, load, store_release
from .cavity import BUSY, claim, give_back
from .dag import descend, locate
from .flips import insert
from .sequential import DONE, FULL, STOPPED
from .store import (
    CHANGE_CYCLES,
    END,
    HINT,
    INSERTED,
    LOCATION_CYCLES,
    LOCK,
    NEIGHBOR,
    NEXT,
    RETRIES,
    SOFT_LIMIT,
    STOP,
    USED,
    VISITED,
    WAIT_CYCLES,
    stumble,
)


@numba.njit(cache=True, forceinline=True)
def _unlock_star(nodes, f):
    """Unlock the star triangles about the first vertex of f, which this thread made locked."""
    last = nodes[f, 1]
    while True:
        following = nodes[f, NEIGHBOR + 1] >> 2
        ends = nodes[f, 2] == last
        store_release(nodes, (f, LOCK), 0)
        if ends:
            return
        f = following


@numba.njit(nogil=True, cache=True)
def run(points, nodes, shared, state, order, by, me, scratch, w):
    """Insert order[NEXT] to order[END - 1] of this thread; `DONE`, or why it came back before."""
    points, nodes, shared, state = borrowed(points), borrowed(nodes), borrowed(shared), borrowed(state)
    order, by, w = borrowed(order), borrowed(by), borrowed(w)
    held, cavity, rim = borrowed(scratch[0]), borrowed(scratch[1]), borrowed(scratch[2])
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
        t, visited = locate(points, nodes, q, w)
        located = cycles()
        while True:
            stumble(shared, state, me)
            size, _, count = claim(points, nodes, t, q, me + 1, held, cavity, rim, w)
            if size != BUSY:
                break
            give_back(nodes, held, count)
            state[me, RETRIES] += 1
            if load(shared, (STOP, 0)) != 0:
                return STOPPED
            give_way()
            t, more = descend(points, nodes, t, q, w)
            visited += more
        claimed = cycles()
        stumble(shared, state, me)
        f = insert(points, nodes, shared, state, me, t, q, me + 1, w)
        _unlock_star(nodes, f)
        give_back(nodes, held, count)
        by[q] = me
        state[me, HINT] = f
        state[me, LOCATION_CYCLES] += located - begun
        state[me, WAIT_CYCLES] += claimed - located
        state[me, CHANGE_CYCLES] += cycles() - claimed
        state[me, VISITED] += visited
        state[me, INSERTED] += 1
        state[me, NEXT] += 1
    return DONE
