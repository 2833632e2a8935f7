"""The pool of sites that are being inserted, and who waits for whom (Kohout et al. 2004, section 3.4).

Each thread has a row of its own, which the others read.
"""

from __future__ import annotations

import numpy as np

from .._numba.atomics import (
    acquire,
    load,
    load_acquire,
    release,
    rows_apart,
    store,
    store_release,
)
from .._numba.kernel_cache import cached_njit
from . import columns as c
from .geometry import in_conflict

# columns of `pool`: a thread's site or -1, how many it has finished, for which insertion of which thread it
# waits or -1, and whether another one made use of its waiting; then room for a path of waiting threads
POOL_SITE, SERIAL, WAITS_FOR, EXCEPTIONAL = range(4)
PATH = 16

THREAD_BITS = 8  # of a word of WAITS_FOR; above them is how many that thread had finished

NOBODY = -1


def empty_pool(threads: int) -> np.ndarray:
    """A pool without sites, int64 (threads, 16 k)."""
    pool = rows_apart(threads, PATH + threads)
    pool[:, [POOL_SITE, WAITS_FOR]] = NOBODY
    return pool


@cached_njit(forceinline=True)
def publish(pool, me, q):
    """Enter site q, visibly to all before this thread looks for the sites of others."""
    store(pool, (me, POOL_SITE), q)


@cached_njit(forceinline=True)
def retire(pool, me):
    """Take the site of this thread, which is inserted, out of the pool."""
    clear_exception(pool, me)
    store_release(pool, (me, POOL_SITE), NOBODY)
    store_release(pool, (me, SERIAL), pool[me, SERIAL] + 1)


@cached_njit(forceinline=True)
def clear_exception(pool, me):
    """Take the flag back. No thread sets it now: that is done only to threads that wait."""
    if load(pool, (me, EXCEPTIONAL)) != 0:
        store_release(pool, (me, EXCEPTIONAL), 0)


@cached_njit(forceinline=True)
def _unfinished(pool, waits):
    """Whether the insertion that a word of WAITS_FOR names has not ended."""
    return load_acquire(pool, (waits & ((1 << THREAD_BITS) - 1), SERIAL)) == waits >> THREAD_BITS


@cached_njit(forceinline=True)
def still_waits(pool, me):
    """Whether the insertion that ``me`` waits for, if any, has not ended."""
    waits = pool[me, WAITS_FOR]
    if waits == NOBODY:
        return False
    if _unfinished(pool, waits):
        return True
    store(pool, (me, WAITS_FOR), NOBODY)
    return False


@cached_njit
def _leads_to(pool, i, me):
    """Whether thread i waits for the present insertion of ``me``, through others perhaps.

    One whose wait is over may not have noticed, so every step of the path is looked at again: the last of
    them cannot end before ``me`` says so, hence not the one before if it is for the same insertion still, and
    so on.
    """
    length = 0
    while i != me:
        waits = load(pool, (i, WAITS_FOR))
        if waits == NOBODY or length == len(pool):
            return False
        pool[me, PATH + length] = waits
        length += 1
        i = waits & ((1 << THREAD_BITS) - 1)
    for k in range(length):  # noqa: SIM110 - numba has no all()
        if not _unfinished(pool, pool[me, PATH + k]):
            return False
    return True


@cached_njit(forceinline=True)
def touches(mesh, t, q):
    """Whether the insertion of q may change t: it is in conflict, or a vertex already."""
    nodes = mesh.nodes
    return nodes[t, 0] == q or nodes[t, 1] == q or nodes[t, 2] == q or in_conflict(mesh, t, q)


@cached_njit(forceinline=True)
def blocker_of(mesh, me, pool, triangles, count):
    """A thread whose insertion may change one of the first ``count`` triangles, or `NOBODY`.

    Returns it and how many insertions it had finished. Threads that wait for this one are left out, and
    flagged; where their stars are unfinished, that of this one may keep illegal edges.
    """
    state = mesh.state
    for i in range(len(pool)):
        if i == me:
            continue
        serial = load_acquire(pool, (i, SERIAL))
        q = load_acquire(pool, (i, POOL_SITE))
        if q < 0:
            continue
        for x in range(count):
            t = triangles[x]
            state[me, c.TESTS] += 1
            if touches(mesh, t, q):
                if not _leads_to(pool, i, me):
                    return i, serial
                store(pool, (i, EXCEPTIONAL), 1)
                state[me, c.EXCEPTIONS] += 1
                if load(state, (i, c.PHASE)) == c.LEGALISE:
                    state[me, c.STAR_MARKED] = 1
                break
    return NOBODY, 0


@cached_njit(forceinline=True)
def wait_for(shared, pool, me, i, serial):
    """Enter that ``me`` waits for i, which had finished ``serial`` insertions, to finish one more.

    Not where i waits for ``me`` already. Returns whether ``me`` has to wait, be it to try again since others
    are about to enter the same.

    The waits that are entered make no circle, as each is looked through and entered in the critical section.
    """
    if not acquire(shared, (c.CRITICAL, 0), me + 1):
        return True
    deadlock = _leads_to(pool, i, me)
    if not deadlock:
        store(pool, (me, WAITS_FOR), serial << THREAD_BITS | i)
    release(shared, (c.CRITICAL, 0))
    return not deadlock
