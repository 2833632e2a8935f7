"""The pessimistic method: location in all threads, changes in one critical section (Kolingerova and Kohout
2000)."""

from __future__ import annotations

from .._numba.atomics import compare_and_swap, cycles, give_way, load, release
from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from .dag import descend
from .flips import insert
from .in_place.walk import walk_history
from .mesh import (
    CHANGE_CYCLES,
    CRITICAL,
    HINT,
    INSERTED,
    LOCATION_CYCLES,
    NEXT,
    STOP,
    VISITED,
    WAIT_CYCLES,
    WAITS,
    stumble,
)
from .patience import GIVING_WAY, strive
from .steps import DONE, GO_ON, STOPPED, find, spend, verdict
from .work_sharing import next_site, unowned_sites


@cached_njit(nogil=True)
def run(points, nodes, shared, state, sites, me, walking, w):
    """Insert sites until none is left for this thread; `DONE`, or why it came back before."""
    points, nodes, shared, state = unowned(points), unowned(nodes), unowned(shared), unowned(state)
    sites, w = unowned_sites(sites), unowned(w)
    effort = 0
    begun = cycles()
    while True:
        reason = verdict(shared, True, True)
        if reason != GO_ON:
            return reason
        q = next_site(state, sites, me)
        if q < 0:
            return DONE
        t, visited = find(points, nodes, state, me, q, walking, w)
        begun = spend(state, me, LOCATION_CYCLES, begun)
        stumble(shared, state, me)
        if not compare_and_swap(shared, (CRITICAL, 0), 0, me + 1):
            state[me, WAITS] += 1
            while not compare_and_swap(shared, (CRITICAL, 0), 0, me + 1):
                if load(shared, (STOP, 0)) != 0:
                    return STOPPED
                give_way()
                effort = strive(shared, state, me, effort, GIVING_WAY)
        begun = spend(state, me, WAIT_CYCLES, begun)
        # what was a leaf before may have children now
        if walking:
            t, more = walk_history(points, nodes, t, q, w)
        else:
            t, more = descend(points, nodes, t, q, w)
        state[me, HINT] = insert(points, nodes, shared, state, me, t, q, 0, w)
        release(shared, (CRITICAL, 0))
        stumble(shared, state, me)
        begun = spend(state, me, CHANGE_CYCLES, begun)
        state[me, VISITED] += visited + more
        state[me, INSERTED] += 1
        state[me, NEXT] += 1
