"""Insertion in place, without a history: the conflicts give way to the star of the site.

The two triangles that an insertion adds have the numbers 4 + 2 i and 5 + 2 i, where i is the site's place in
the order, so that threads need not ask each other for memory.
"""

from __future__ import annotations

from ..._errors import InternalError
from ..._numba.atomics import TURNS, load, store_release, wait_a_little
from ..._numba.kernel_cache import cached_njit
from ..._numba.unowned import unowned
from ..mesh import (
    CHILD,
    END,
    FLIPS,
    HINT,
    INSERTED,
    LOCK,
    NEIGHBOR,
    NEXT,
    RETRIES,
    ROOTS,
    STOP,
    VISITED,
    stumble,
)
from ..patience import NAP, STEP, strive
from ..steps import DONE, STOPPED
from ..work_sharing import take, unowned_sites
from .cavity import BUSY, claim, give_back
from .walk import walk

AT_ONCE = 4  # attempts before a thread that does not get its triangles gives way


@cached_njit(forceinline=True)
def _put(nodes, t, q, a, b, edge, following, previous, maker, lock):
    """The star triangle qab, whose edge ab is ``edge`` from beyond."""
    store_release(nodes, (t, LOCK), lock)
    store_release(nodes, (t, 0), q)
    store_release(nodes, (t, 1), a)
    store_release(nodes, (t, 2), b)
    store_release(nodes, (t, NEIGHBOR), edge)
    store_release(nodes, (t, NEIGHBOR + 1), 4 * following + 2)
    store_release(nodes, (t, NEIGHBOR + 2), 4 * previous + 1)
    store_release(nodes, (t, CHILD), -1 - maker)
    store_release(nodes, (edge >> 2, NEIGHBOR + (edge & 3)), 4 * t)


@cached_njit(forceinline=True)
def fill(nodes, q, cavity, size, rim, edges, fresh, maker, lock):
    """Replace the cavity by the star of q, which has two triangles more: ``fresh`` and the one after it."""
    cavity[size], cavity[size + 1] = fresh, fresh + 1
    previous, t = cavity[edges - 1], cavity[0]
    for i in range(edges):
        following = cavity[i + 1] if i + 1 < edges else cavity[0]
        _put(nodes, t, q, rim[3 * i + 1], rim[3 * i + 2], rim[3 * i], following, previous, maker, lock)
        previous, t = t, following
    return cavity[0]


@cached_njit(nogil=True)
def run(points, nodes, shared, state, sites, me, lock, scratch, w):
    """Insert sites until none is left for this thread, each from the triangle where the last one was.

    With ``lock`` 0 for one thread; with another for each of several threads, every insertion has exclusive
    access to its conflicts and the triangles around them, and begins again where it does not get it.
    """
    points, nodes, shared, state = unowned(points), unowned(nodes), unowned(shared), unowned(state)
    sites, w = unowned_sites(sites), unowned(w)
    held, cavity, rim = unowned(scratch[0]), unowned(scratch[1]), unowned(scratch[2])
    hint, at, end = state[me, HINT], state[me, NEXT], state[me, END]
    visited = flips = retries = 0
    inserted = state[me, INSERTED]
    tries, effort, result = 0, 0, DONE
    while True:
        if at == end:
            state[me, NEXT] = at
            if not take(state, sites, me):
                break
            at, end = state[me, NEXT], state[me, END]
        if load(shared, (STOP, 0)) != 0:
            result = STOPPED
            break
        q = sites[0][at]
        t, steps = walk(points, nodes, hint, q, w)
        visited += steps
        if steps > len(nodes):
            if lock == 0:
                msg = "a walk through a 2D triangulation goes round in circles"
                raise InternalError(msg)
            effort = strive(shared, state, me, effort, steps)
        stumble(shared, state, me)
        size, edges, count = claim(points, nodes, t, q, lock, held, cavity, rim, w)
        if size == BUSY:
            give_back(nodes, held, count)
            retries += 1
            tries += 1
            if tries > AT_ONCE:
                wait_a_little(tries - AT_ONCE)
            effort = strive(shared, state, me, effort, STEP if tries < AT_ONCE + TURNS else NAP)
            hint = t
            continue
        stumble(shared, state, me)
        tries = effort = 0
        fresh = ROOTS + 2 * at
        hint = fill(nodes, q, cavity, size, rim, edges, fresh, me, lock)
        if lock != 0:
            give_back(nodes, held, count)
            store_release(nodes, (fresh, LOCK), 0)
            store_release(nodes, (fresh + 1, LOCK), 0)
        flips += size - 1
        inserted += 1
        store_release(state, (me, INSERTED), inserted)  # others look at it while they wait
        at += 1
    state[me, HINT] = hint
    state[me, NEXT] = at
    state[me, VISITED] += visited
    state[me, FLIPS] += flips
    state[me, RETRIES] += retries
    return result
