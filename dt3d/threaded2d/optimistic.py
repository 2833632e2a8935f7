"""The optimistic method: exclusive access node by node (Kolingerova and Kohout 2002).

Before a thread changes anything it has locked all triangles in conflict with its site and those around them;
if it does not get one, it gives all of them back and locates again from where it was. So every insertion
begins and ends with a Delaunay triangulation, no swap is given up, and no thread waits for another while it
holds anything.
"""

from __future__ import annotations

from .._errors import InternalError
from .._numba.atomics import TURNS, cycles, store_release, wait_a_little
from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from .dag import descend, locate
from .flips import insert
from .in_place.cavity import BUSY, claim, give_back
from .mesh import (
    ACCESSES,
    CHANGE_CYCLES,
    HELD,
    HINT,
    INSERTED,
    LOCATION_CYCLES,
    LOCK,
    NEIGHBOR,
    NEXT,
    NODE,
    PHASE,
    RETRIES,
    SITE,
    VISITED,
    WAIT_CYCLES,
    stumble,
)
from .patience import GIVING_WAY, NAP, strive
from .steps import CHANGED, DONE, FINISHED, GO_ON, LOCATED, WAITING, spend, verdict
from .work_sharing import next_site, unowned_sites

# phases: next site, exclusive access, change
BEGIN, CLAIM, CHANGE = range(3)


@cached_njit(forceinline=True)
def _unlock_star(nodes, f):
    """Unlock the star triangles about the first vertex of f, which this thread made locked."""
    last = nodes[f, 1]
    for _ in range(len(nodes)):  # more than any star has
        following = nodes[f, NEIGHBOR + 1] >> 2
        ends = nodes[f, 2] == last
        store_release(nodes, (f, LOCK), 0)
        if ends:
            return
        f = following
    msg = "a star of a 2D triangulation does not close"
    raise InternalError(msg)


@cached_njit(forceinline=True)
def step(points, nodes, shared, state, sites, held, cavity, rim, me, w):
    """One step of thread ``me``: locate a site, get exclusive access, or subdivide and legalise."""
    if state[me, PHASE] == BEGIN:
        q = next_site(state, sites, me)
        if q < 0:
            return FINISHED
        t, visited = locate(points, nodes, q, w)
        state[me, SITE], state[me, NODE], state[me, PHASE] = q, t, CLAIM
        state[me, VISITED] += visited
        return LOCATED
    q = state[me, SITE]
    if state[me, PHASE] == CLAIM:
        t, visited = descend(points, nodes, state[me, NODE], q, w)
        state[me, NODE] = t
        state[me, VISITED] += visited
        state[me, ACCESSES] += 1
        size, _, count = claim(points, nodes, t, q, me + 1, held, cavity, rim, w)
        if size == BUSY:
            give_back(nodes, held, count)
            state[me, RETRIES] += 1
            return WAITING
        state[me, HELD], state[me, PHASE] = count, CHANGE
        return CHANGED
    f = insert(points, nodes, shared, state, me, state[me, NODE], q, me + 1, w)
    _unlock_star(nodes, f)
    give_back(nodes, held, state[me, HELD])
    state[me, HINT] = f
    state[me, INSERTED] += 1
    state[me, NEXT] += 1
    state[me, PHASE] = BEGIN
    return CHANGED


@cached_njit(nogil=True)
def run(points, nodes, shared, state, sites, me, scratch, w):
    """Insert sites until none is left for this thread; `DONE`, or why it came back before."""
    points, nodes, shared, state = unowned(points), unowned(nodes), unowned(shared), unowned(state)
    sites, w = unowned_sites(sites), unowned(w)
    held, cavity, rim = unowned(scratch[0]), unowned(scratch[1]), unowned(scratch[2])
    waiting, effort = 0, 0
    begun = cycles()
    while True:
        # whoever holds triangles goes on until it has given them back
        phase = state[me, PHASE]
        reason = verdict(shared, phase != CHANGE, phase == BEGIN)
        if reason != GO_ON:
            return reason
        did = step(points, nodes, shared, state, sites, held, cavity, rim, me, w)
        if did == FINISHED:
            return DONE
        column = WAIT_CYCLES if did == WAITING else (LOCATION_CYCLES if did == LOCATED else CHANGE_CYCLES)
        begun = spend(state, me, column, begun)
        if did == WAITING:
            wait_a_little(waiting)
            effort = strive(shared, state, me, effort, GIVING_WAY if waiting < TURNS else NAP)
            waiting += 1
            begun = spend(state, me, WAIT_CYCLES, begun)
        else:
            waiting = 0
        stumble(shared, state, me)
