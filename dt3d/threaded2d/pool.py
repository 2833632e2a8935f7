"""The pool of sites that are being inserted, and who waits for whom (Kohout et al. 2004, section 3.4).

Each thread has a row of its own, which the others read.
"""

from __future__ import annotations

import numba
import numpy as np

from .atomics import acquire, load, load_acquire, release, store, store_release
from .geometry import conflicts
from .store import BLOCKED_SINCE, BLOCKER, CRITICAL, EXCEPTIONS, TESTS

# columns of `pool`: a thread's site or -1, how many it has finished, for whom it waits or -1, and whether
# another one made use of its waiting
POOL_SITE, SERIAL, WAITS_FOR, EXCEPTIONAL = range(4)

NOBODY = -1


def empty_pool(threads: int) -> np.ndarray:
    """A pool without sites, int64 (threads, 16)."""
    pool = np.zeros((threads, 16), np.int64)
    pool[:, [POOL_SITE, WAITS_FOR]] = NOBODY
    return pool


@numba.njit(cache=True, forceinline=True)
def publish(pool, me, q):
    """Enter site q, visibly to all before this thread looks for the sites of others."""
    store(pool, (me, POOL_SITE), q)


@numba.njit(cache=True, forceinline=True)
def retire(pool, me):
    """Take the site of this thread, which is inserted, out of the pool."""
    clear_exception(pool, me)
    store_release(pool, (me, POOL_SITE), NOBODY)
    store_release(pool, (me, SERIAL), pool[me, SERIAL] + 1)


@numba.njit(cache=True, forceinline=True)
def clear_exception(pool, me):
    """Take the flag back. Nobody sets it now: that is done only to threads that wait."""
    if load(pool, (me, EXCEPTIONAL)) != 0:
        store_release(pool, (me, EXCEPTIONAL), 0)


@numba.njit(cache=True, forceinline=True)
def still_waits(state, pool, me):
    """Whether the thread that ``me`` waits for, if any, is still at the same insertion."""
    i = state[me, BLOCKER]
    if i == NOBODY:
        return False
    if load_acquire(pool, (i, SERIAL)) == state[me, BLOCKED_SINCE]:
        return True
    store(pool, (me, WAITS_FOR), NOBODY)
    state[me, BLOCKER] = NOBODY
    return False


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
def touches(points, nodes, t, q, w):
    """Whether the insertion of q may change t: it is in conflict, or a vertex already."""
    a, b, c = nodes[t, 0], nodes[t, 1], nodes[t, 2]
    return a == q or b == q or c == q or conflicts(points, a, b, c, q, w)


@numba.njit(cache=True, forceinline=True)
def blocker_of(points, nodes, state, pool, me, triangles, count, w):
    """A thread whose insertion may change one of the first ``count`` triangles, and how many it had finished;
    or `NOBODY`.

    Threads that wait for this one are left out, and flagged.
    """
    for i in range(len(pool)):
        if i == me:
            continue
        serial = load_acquire(pool, (i, SERIAL))
        q = load_acquire(pool, (i, POOL_SITE))
        if q < 0:
            continue
        for x in range(count):
            t = triangles[x]
            state[me, TESTS] += 1
            if touches(points, nodes, t, q, w):
                if not _leads_to(pool, i, me):
                    return i, serial
                store(pool, (i, EXCEPTIONAL), 1)
                state[me, EXCEPTIONS] += 1
                break
    return NOBODY, 0


@numba.njit(cache=True, forceinline=True)
def wait_for(shared, state, pool, me, i, serial):
    """Enter that ``me`` waits for i to finish, unless i waits for ``me`` already; whether it does."""
    acquire(shared, (CRITICAL, 0), me + 1)
    deadlock = _leads_to(pool, i, me)
    if not deadlock:
        store(pool, (me, WAITS_FOR), i)
        state[me, BLOCKER], state[me, BLOCKED_SINCE] = i, serial
    release(shared, (CRITICAL, 0))
    return not deadlock
