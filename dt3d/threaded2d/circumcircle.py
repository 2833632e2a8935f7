"""The circum-circle method: geometry tells who has to wait (Kohout et al. 2004, section 3.4, Algorithm 3).

An insertion changes only triangles that are in conflict with its site, or have it as a vertex. Every thread
publishes its site in a pool before it changes anything. It subdivides or flips when no other site of the pool
is in conflict with, or a vertex of, the triangles that change and their neighbours; otherwise it waits for
the thread whose site that is to finish it. As each publishes before it looks, of two that want the same at
least one sees the other.

Two that see each other would wait for ever. So a thread looks, in a short critical section, whether the one
it would wait for waits for it, through others perhaps. Then it goes on, since those cannot, and flags their
exceptional state: after they wake they locate again, or, if they were legalising, give up their remaining
swaps. Those are made up for at the end (`correction`).
"""

from __future__ import annotations

import numba
import numpy as np

from ..predicates.borrowed import borrowed
from ..predicates.filtered2d import orient2d
from .atomics import acquire, cycles, load, load_acquire, release, store, wait_a_little
from .batch import CHANGED, FINISHED, LOCATED, WAITING
from .dag import descend, locate
from .flips import flip, illegal, subdivide
from .geometry import conflicts
from .sequential import DONE, FULL, STOPPED
from .store import (
    ACCESSES,
    BLOCKED_SINCE,
    BLOCKER,
    CHANGE_CYCLES,
    CHILD,
    CRITICAL,
    END,
    EXCEPTIONS,
    GIVEN_UP,
    HINT,
    INSERTED,
    LAST,
    LOCATION_CYCLES,
    NEIGHBOR,
    NEXT,
    NODE,
    PHASE,
    SITE,
    SOFT_LIMIT,
    STOP,
    TESTS,
    USED,
    VISITED,
    WAIT_CYCLES,
    WAITS,
    stumble,
)
from .walk import walk_history

# columns of `pool`, a row for each thread: its site or -1, how many it has finished, for whom it waits or -1,
# and whether another one made use of its waiting
POOL_SITE, SERIAL, WAITS_FOR, EXCEPTIONAL = range(4)

# phases: next site, subdivision, legalisation
BEGIN, SUBDIVIDE, LEGALISE = range(3)

NOBODY = -1


def empty_pool(threads: int) -> np.ndarray:
    """The pool of sites being inserted, int64 (threads, 16)."""
    pool = np.zeros((threads, 16), np.int64)
    pool[:, [POOL_SITE, WAITS_FOR]] = -1
    return pool


@numba.njit(cache=True, forceinline=True)
def _leads_to(pool, i, me):
    """Whether thread i waits for thread ``me``, through others perhaps."""
    for _ in range(len(pool)):
        i = load(pool, (i, WAITS_FOR))
        if i == me:
            return True
        if i == NOBODY:
            return False
    return False


@numba.njit(cache=True, forceinline=True)
def _touches(points, nodes, t, q, w):
    """Whether the insertion of q may change t: it is in conflict, or a vertex already."""
    a, b, c = nodes[t, 0], nodes[t, 1], nodes[t, 2]
    return a == q or b == q or c == q or conflicts(points, a, b, c, q, w)


@numba.njit(cache=True, forceinline=True)
def _blocker(points, nodes, state, pool, me, triangles, count, w):
    """A thread whose insertion may change one of the first ``count`` triangles, and how many it had finished;
    or `NOBODY`."""
    for i in range(len(pool)):
        if i == me:
            continue
        serial = load(pool, (i, SERIAL))
        q = load(pool, (i, POOL_SITE))
        if q < 0:
            continue
        for x in range(count):
            t = triangles[x]
            state[me, TESTS] += 1
            if _touches(points, nodes, t, q, w):
                if not _leads_to(pool, i, me):
                    return i, serial
                store(pool, (i, EXCEPTIONAL), 1)
                state[me, EXCEPTIONS] += 1
                break
    return NOBODY, 0


@numba.njit(cache=True, forceinline=True)
def _wait_for(shared, state, pool, me, i, serial):
    """Enter that ``me`` waits for i to finish; where i waits for ``me`` already, do not."""
    acquire(shared, (CRITICAL, 0), me + 1)
    deadlock = _leads_to(pool, i, me)
    if not deadlock:
        store(pool, (me, WAITS_FOR), i)
        state[me, BLOCKER], state[me, BLOCKED_SINCE] = i, serial
    release(shared, (CRITICAL, 0))
    if deadlock:
        return CHANGED  # the next look leaves i out of account
    return WAITING


@numba.njit(cache=True, forceinline=True)
def _edge(nodes, t, k):
    return load_acquire(nodes, (t, NEIGHBOR + k))


@numba.njit(cache=True, forceinline=True)
def _is_leaf(nodes, t):
    return load_acquire(nodes, (t, CHILD)) < 0


@numba.njit(cache=True, forceinline=True)
def _edge_through(points, nodes, t, q, w):
    """Which edge of t site q, which t contains, lies on; -1 where on none. Edges at infinity pass through no
    site."""
    a, b, c = nodes[t, 0], nodes[t, 1], nodes[t, 2]
    if b >= 0 and c >= 0 and orient2d(points, b, c, q, w) == 0:
        return 0
    if c >= 0 and a >= 0 and orient2d(points, c, a, q, w) == 0:
        return 1
    if a >= 0 and b >= 0 and orient2d(points, a, b, q, w) == 0:
        return 2
    return -1


@numba.njit(cache=True, forceinline=True)
def _try_subdivision(points, nodes, shared, state, pool, me, walking, w):
    q = state[me, SITE]
    if walking:
        t, visited = walk_history(points, nodes, state[me, NODE], q, w)
    else:
        t, visited = descend(points, nodes, state[me, NODE], q, w)
    state[me, NODE] = t
    state[me, VISITED] += visited
    state[me, ACCESSES] += 1
    a, b, c = _edge(nodes, t, 0), _edge(nodes, t, 1), _edge(nodes, t, 2)
    k = _edge_through(points, nodes, t, q, w)
    if k >= 0:
        # q lies on an edge, and the triangle beyond is subdivided too
        across = a if k == 0 else (b if k == 1 else c)
        u, j = across >> 2, across & 3
        d, e = _edge(nodes, u, (j + 1) % 3), _edge(nodes, u, (j + 2) % 3)
        looked_at = (t, a >> 2, b >> 2, c >> 2, d >> 2, e >> 2)
    else:
        u, j, d, e = t, 0, a, b
        looked_at = (t, a >> 2, b >> 2, c >> 2, t, t)
    i, serial = _blocker(points, nodes, state, pool, me, looked_at, 4 if k < 0 else 6, w)
    if i != NOBODY:
        return _wait_for(shared, state, pool, me, i, serial)
    # what was looked at must be what is there
    if (
        not _is_leaf(nodes, t)
        or a != _edge(nodes, t, 0)
        or b != _edge(nodes, t, 1)
        or c != _edge(nodes, t, 2)
    ):
        return CHANGED
    if k >= 0 and not (
        _is_leaf(nodes, u) and d == _edge(nodes, u, (j + 1) % 3) and e == _edge(nodes, u, (j + 2) % 3)
    ):
        return CHANGED
    first = subdivide(nodes, shared, state, me, t, q, 0)
    if k >= 0:
        # the flat one of the three goes at once: nobody ever meets it, and it cannot be given up
        flat = first + 1 if k == 0 else (first + 2 if k == 1 else first)
        made = flip(nodes, shared, state, me, flat, 0)
        first = made if flat == first else first
    state[me, NODE], state[me, LAST], state[me, PHASE] = first, nodes[first, 1], LEGALISE
    return CHANGED


@numba.njit(cache=True, forceinline=True)
def _try_legalisation(points, nodes, shared, state, by, pool, me, w):
    f = state[me, NODE]
    given_up = load(pool, (me, EXCEPTIONAL)) != 0 or not _is_leaf(nodes, f)
    while not given_up and not illegal(points, nodes, f, w):
        if nodes[f, 2] == state[me, LAST]:
            break
        f = _edge(nodes, f, 1) >> 2
        state[me, NODE] = f
    else:
        if not given_up:
            state[me, ACCESSES] += 1
            edge = _edge(nodes, f, 0)
            u, j = edge >> 2, edge & 3
            a, b = _edge(nodes, u, (j + 1) % 3), _edge(nodes, u, (j + 2) % 3)
            i, serial = _blocker(points, nodes, state, pool, me, (u, a >> 2, b >> 2), 3, w)
            if i != NOBODY:
                return _wait_for(shared, state, pool, me, i, serial)
            if (
                edge == _edge(nodes, f, 0)
                and _is_leaf(nodes, u)
                and a == _edge(nodes, u, (j + 1) % 3)
                and b == _edge(nodes, u, (j + 2) % 3)
            ):
                state[me, NODE] = flip(nodes, shared, state, me, f, 0)
            return CHANGED
        state[me, GIVEN_UP] += 1
    q = state[me, SITE]
    by[q] = me
    state[me, HINT] = f
    store(pool, (me, EXCEPTIONAL), 0)
    store(pool, (me, POOL_SITE), -1)
    store(pool, (me, SERIAL), load(pool, (me, SERIAL)) + 1)
    state[me, INSERTED] += 1
    state[me, NEXT] += 1
    state[me, PHASE] = BEGIN
    return CHANGED


@numba.njit(cache=True, forceinline=True)
def step(points, nodes, shared, state, order, by, pool, me, walking, w):
    """One step of thread ``me``: locate a site, try to subdivide, or try to flip an edge."""
    i = state[me, BLOCKER]
    if i != NOBODY:
        if load(pool, (i, SERIAL)) == state[me, BLOCKED_SINCE]:
            return WAITING
        store(pool, (me, WAITS_FOR), NOBODY)
        state[me, BLOCKER] = NOBODY
    if state[me, PHASE] == SUBDIVIDE:
        store(pool, (me, EXCEPTIONAL), 0)  # it locates again in any case
        return _try_subdivision(points, nodes, shared, state, pool, me, walking, w)
    if state[me, PHASE] == LEGALISE:
        return _try_legalisation(points, nodes, shared, state, by, pool, me, w)
    while state[me, NEXT] < state[me, END] and by[order[state[me, NEXT]]] >= 0:
        state[me, NEXT] += 1  # a vertex of the first triangle
    if state[me, NEXT] == state[me, END]:
        return FINISHED
    q = order[state[me, NEXT]]
    if walking:
        t, visited = walk_history(points, nodes, state[me, HINT], q, w)
    else:
        t, visited = locate(points, nodes, q, w)
    state[me, SITE], state[me, NODE], state[me, PHASE] = q, t, SUBDIVIDE
    state[me, VISITED] += visited
    store(pool, (me, POOL_SITE), q)
    return LOCATED


@numba.njit(nogil=True, cache=True)
def run(points, nodes, shared, state, order, by, me, pool, walking, w):
    """Insert order[NEXT] to order[END - 1] of this thread; `DONE`, or why it came back before."""
    points, nodes, shared, state = borrowed(points), borrowed(nodes), borrowed(shared), borrowed(state)
    order, by, pool, w = borrowed(order), borrowed(by), borrowed(pool), borrowed(w)
    waiting = 0
    begun = cycles()
    while True:
        if load(shared, (STOP, 0)) != 0:
            return STOPPED
        if state[me, PHASE] == BEGIN and load(shared, (USED, 0)) > shared[SOFT_LIMIT, 0]:
            return FULL
        did = step(points, nodes, shared, state, order, by, pool, me, walking, w)
        if did == FINISHED:
            return DONE
        if did != CHANGED or waiting > 0 or state[me, PHASE] == BEGIN:
            # a location, a wait or an insertion ends
            ended = cycles()
            column = WAIT_CYCLES if did == WAITING else (LOCATION_CYCLES if did == LOCATED else CHANGE_CYCLES)
            state[me, column] += ended - begun
            begun = ended
        if did == WAITING:
            state[me, WAITS] += waiting == 0
            wait_a_little(waiting)
            waiting += 1
        else:
            waiting = 0
        stumble(shared, state, me)
