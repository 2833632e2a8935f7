"""The batch method: searching threads, a queue, one specialised thread (Kohout et al. 2004, section 3.3,
Algorithm 2).

A searching thread locates sites, several at a time, and puts each into the queue with the leaf that contains
it; the paper sends the leaf's parent. The specialised thread finishes the location, as there may be children
by then, subdivides and legalises. In the paper's variant a searching thread that finds the queue full takes
an element, finishes its location, and puts it back.

The specialised thread knows which sites come next, and asks for their leaves while it inserts others.
"""

from __future__ import annotations

from .._numba.atomics import cycles
from .._numba.kernel_cache import cached_njit
from .._numba.prefetch import prefetch
from .._numba.unowned import unowned
from .dag import descend
from .flips import insert
from .in_place.walk import walk_history
from .lookahead.located import AT_ONCE, locate_one, prepare
from .mesh import (
    AT,
    CHANGE_CYCLES,
    HELPED,
    IN_HAND,
    INSERTED,
    LOCATION_CYCLES,
    QUEUE_FILL,
    VISITED,
    stumble,
)
from .patience import NAP, STEP, strive
from .queue import ITEM_NODE, ITEM_SITE, fill_of, get, put
from .steps import CHANGED, DONE, FINISHED, GO_ON, LOCATED, LOOKS, WAITING, pause, verdict
from .work_sharing import unowned_sites


@cached_njit(forceinline=True)
def _finish(points, nodes, t, q, walking, w):
    return walk_history(points, nodes, t, q, w) if walking else descend(points, nodes, t, q, w)


@cached_njit(forceinline=True)
def search_step(points, nodes, shared, state, sites, cells, lanes, hands, me, walking, helping, w):
    """One step of searching thread ``me``: locate a site, put some into the queue, or help."""
    if state[me, HELPED] != 0:
        if put(cells, shared, hands, AT_ONCE, 1) == 0:
            return WAITING
        state[me, HELPED] = 0
        return CHANGED
    left = state[me, IN_HAND] - state[me, AT]
    if state[me, IN_HAND] < AT_ONCE and locate_one(points, nodes, state, sites, lanes, hands, me, walking, w):
        return LOCATED
    if left == 0:
        return FINISHED
    count = put(cells, shared, hands, state[me, AT], left)
    if count > 0:
        state[me, AT] += count
        if count == left:
            state[me, AT] = state[me, IN_HAND] = 0
        return CHANGED
    if helping and get(cells, shared, hands, AT_ONCE, 1) == 1:
        q, t = hands[AT_ONCE, ITEM_SITE], hands[AT_ONCE, ITEM_NODE]
        t, visited = _finish(points, nodes, t, q, walking, w)
        state[me, VISITED] += visited
        hands[AT_ONCE, ITEM_NODE] = t
        state[me, HELPED] = 1
        return LOCATED
    return WAITING


@cached_njit(forceinline=True)
def specialised_step(points, nodes, shared, state, cells, hands, me, walking, w):
    """One step of the specialised thread: an element from the queue is inserted."""
    if state[me, INSERTED] == len(points) - 3:
        return FINISHED
    if state[me, AT] == state[me, IN_HAND]:
        fill = fill_of(shared)
        count = get(cells, shared, hands, 0, AT_ONCE)
        if count == 0:
            return WAITING
        state[me, QUEUE_FILL] += fill * count
        state[me, AT], state[me, IN_HAND] = 0, count
        for i in range(count):
            prefetch(nodes, hands[i, ITEM_NODE])
    at = state[me, AT]
    state[me, AT] += 1
    prepare(points, nodes, hands, at, state[me, IN_HAND])
    q = hands[at, ITEM_SITE]
    t, visited = _finish(points, nodes, hands[at, ITEM_NODE], q, walking, w)
    insert(points, nodes, shared, state, me, t, q, 0, w)
    state[me, VISITED] += visited
    state[me, INSERTED] += 1
    return CHANGED


@cached_njit(nogil=True)
def run_searching(points, nodes, shared, state, sites, me, cells, lanes, hands, walking, helping, w):
    """A searching thread until its sites are in the queue; `DONE`, or why it came back before."""
    points, nodes, shared, state = unowned(points), unowned(nodes), unowned(shared), unowned(state)
    sites, cells, w = unowned_sites(sites), unowned(cells), unowned(w)
    lanes, hands = unowned(lanes), unowned(hands)
    waiting, effort = 0, 0
    begun = cycles()
    while True:
        did = search_step(points, nodes, shared, state, sites, cells, lanes, hands, me, walking, helping, w)
        waiting, begun = pause(state, me, LOCATION_CYCLES, did, waiting, begun)
        effort = strive(shared, state, me, effort, STEP if waiting <= LOOKS else NAP)
        reason = DONE if did == FINISHED else verdict(shared, True, True)
        if reason != GO_ON:
            state[me, LOCATION_CYCLES] += cycles() - begun
            return reason
        stumble(shared, state, me)


@cached_njit(nogil=True)
def run_specialised(points, nodes, shared, state, me, cells, hands, walking, w):
    """The specialised thread until all sites are inserted; `DONE`, or why it came back before."""
    points, nodes, shared, state = unowned(points), unowned(nodes), unowned(shared), unowned(state)
    cells, hands, w = unowned(cells), unowned(hands), unowned(w)
    waiting, effort = 0, 0
    begun = cycles()
    while True:
        reason = verdict(shared, True, True)
        if reason != GO_ON:
            return reason
        did = specialised_step(points, nodes, shared, state, cells, hands, me, walking, w)
        waiting, begun = pause(state, me, CHANGE_CYCLES, did, waiting, begun)
        effort = strive(shared, state, me, effort, STEP if waiting <= LOOKS else NAP)
        if did == FINISHED:
            state[me, CHANGE_CYCLES] += cycles() - begun
            return DONE
        stumble(shared, state, me)
