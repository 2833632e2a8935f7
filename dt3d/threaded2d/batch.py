"""The batch method: searching threads, a queue, one specialised thread (Kohout et al. 2004, section 3.3,
Algorithm 2).

A searching thread locates a site as far as the parents of the leaves and puts it into the queue. The
specialised thread finishes the location, subdivides and legalises. In the paper's variant a searching thread
that finds the queue full takes an element, finishes its location, and puts it back.

Both kinds of thread go in steps that return what happened, so that a scheduler can run them in virtual time
too.
"""

from __future__ import annotations

import numba

from ..predicates.borrowed import borrowed
from .atomics import cycles, load, load_acquire, wait_a_little
from .dag import child_of, descend
from .flips import insert
from .geometry import root_of
from .queue import fill_of, get, put
from .sequential import DONE, FULL, STOPPED
from .store import (
    CHANGE_CYCLES,
    CHILD,
    END,
    HINT,
    INSERTED,
    LOCATION_CYCLES,
    NEXT,
    NODE,
    OTHER_NODE,
    OTHER_SITE,
    PHASE,
    QUEUE_FILL,
    SITE,
    SOFT_LIMIT,
    STOP,
    USED,
    VISITED,
    WAIT_CYCLES,
    WAITS,
    stumble,
)
from .walk import walk_history

# what a step returns
LOCATED, CHANGED, WAITING, FINISHED = range(4)

# phases of a searching thread: nothing in hand, its own site, its own and a helped one
EMPTY, OWN, BOTH = range(3)


@numba.njit(cache=True, forceinline=True)
def locate_parent(points, nodes, q, w):
    """The last node on the way to q that has children, and how many were visited; a root where none has."""
    t = root_of(points, nodes, q, w)
    parent, visited = t, 0
    child = load_acquire(nodes, (t, CHILD))
    while child >= 0:
        parent = t
        t = child_of(points, nodes, t, child, q, w)
        child = load_acquire(nodes, (t, CHILD))
        visited += 1
    return parent, visited


@numba.njit(cache=True, forceinline=True)
def _finish(points, nodes, t, q, walking, w):
    return walk_history(points, nodes, t, q, w) if walking else descend(points, nodes, t, q, w)


@numba.njit(cache=True, forceinline=True)
def search_step(points, nodes, shared, state, order, by, cells, me, walking, helping, w):
    """One step of searching thread ``me``: locate a site, put it into the queue, or help."""
    if state[me, PHASE] == EMPTY:
        while state[me, NEXT] < state[me, END] and by[order[state[me, NEXT]]] >= 0:
            state[me, NEXT] += 1  # a vertex of the first triangle
        if state[me, NEXT] == state[me, END]:
            return FINISHED
        q = order[state[me, NEXT]]
        if walking:
            t, visited = walk_history(points, nodes, state[me, HINT], q, w)
            state[me, HINT] = t
        else:
            t, visited = locate_parent(points, nodes, q, w)
        state[me, SITE], state[me, NODE], state[me, PHASE] = q, t, OWN
        state[me, VISITED] += visited
        return LOCATED
    if state[me, PHASE] == BOTH:
        if not put(cells, shared, state[me, OTHER_SITE], state[me, OTHER_NODE]):
            return WAITING
        state[me, PHASE] = OWN
    if put(cells, shared, state[me, SITE], state[me, NODE]):
        by[state[me, SITE]] = me
        state[me, NEXT] += 1
        state[me, PHASE] = EMPTY
        return CHANGED
    if helping:
        found, q, t = get(cells, shared)
        if found:
            t, visited = _finish(points, nodes, t, q, walking, w)
            state[me, VISITED] += visited
            state[me, OTHER_SITE], state[me, OTHER_NODE], state[me, PHASE] = q, t, BOTH
            return LOCATED
    return WAITING


@numba.njit(cache=True, forceinline=True)
def specialised_step(points, nodes, shared, state, cells, me, walking, w):
    """One step of the specialised thread: an element from the queue is inserted."""
    if state[me, INSERTED] == len(points) - 3:
        return FINISHED
    fill = fill_of(shared)
    found, q, t = get(cells, shared)
    if not found:
        return WAITING
    state[me, QUEUE_FILL] += fill
    t, visited = _finish(points, nodes, t, q, walking, w)
    insert(points, nodes, shared, state, me, t, q, 0, w)
    state[me, VISITED] += visited
    state[me, INSERTED] += 1
    return CHANGED


@numba.njit(nogil=True, cache=True)
def run_searching(points, nodes, shared, state, order, by, me, cells, walking, helping, w):
    """A searching thread until its sites are in the queue; `DONE`, or why it came back before."""
    points, nodes, shared, state = borrowed(points), borrowed(nodes), borrowed(shared), borrowed(state)
    order, by, cells, w = borrowed(order), borrowed(by), borrowed(cells), borrowed(w)
    waiting = 0
    begun = cycles()
    while True:
        if load(shared, (STOP, 0)) != 0:
            return STOPPED
        if load(shared, (USED, 0)) > shared[SOFT_LIMIT, 0]:
            return FULL
        did = search_step(points, nodes, shared, state, order, by, cells, me, walking, helping, w)
        if did == FINISHED:
            state[me, LOCATION_CYCLES] += cycles() - begun
            return DONE
        if (did == WAITING) != (waiting > 0):
            # a wait begins or ends
            ended = cycles()
            state[me, WAIT_CYCLES if waiting else LOCATION_CYCLES] += ended - begun
            begun = ended
            state[me, WAITS] += did == WAITING
        if did == WAITING:
            wait_a_little(waiting)
            waiting += 1
        else:
            waiting = 0
        stumble(shared, state, me)


@numba.njit(nogil=True, cache=True)
def run_specialised(points, nodes, shared, state, me, cells, walking, w):
    """The specialised thread until all sites are inserted; `DONE`, or why it came back before."""
    points, nodes, shared, state = borrowed(points), borrowed(nodes), borrowed(shared), borrowed(state)
    cells, w = borrowed(cells), borrowed(w)
    waiting = 0
    begun = cycles()
    while True:
        if load(shared, (STOP, 0)) != 0:
            return STOPPED
        if load(shared, (USED, 0)) > shared[SOFT_LIMIT, 0]:
            return FULL
        did = specialised_step(points, nodes, shared, state, cells, me, walking, w)
        if did == FINISHED:
            state[me, CHANGE_CYCLES] += cycles() - begun
            return DONE
        if (did == WAITING) != (waiting > 0):
            # a wait begins or ends
            ended = cycles()
            state[me, WAIT_CYCLES if waiting else CHANGE_CYCLES] += ended - begun
            begun = ended
            state[me, WAITS] += did == WAITING
        if did == WAITING:
            wait_a_little(waiting)
            waiting += 1
        else:
            waiting = 0
        stumble(shared, state, me)
