"""The circum-circle method: geometry tells who has to wait (Kohout et al. 2004, section 3.4, Algorithm 3).

An insertion changes only triangles that are in conflict with its site, or have it as a vertex. Every thread
publishes its site in a pool before it changes anything. It subdivides or flips when no other site of the pool
is in conflict with, or a vertex of, the triangles that change and their neighbours; otherwise it waits for
the thread whose site that is to finish it. As each publishes before it looks, of two that want the same at
least one sees the other.

Two that see each other would wait for ever. So a thread looks, in a short critical section, whether the one
it would wait for waits for it, through others perhaps. Then it goes on, since those cannot, and flags their
exceptional state: after they wake they locate again, or, if they were legalising, give up their remaining
swaps. The paper makes up for those in the end. Here all threads pause as soon as their insertions have ended
(`suspects`, `correction`): what is left open spreads, on some sets to quadratically many swaps.
"""

from __future__ import annotations

from .._errors import InternalError
from .._numba.atomics import TURNS, cycles, load, load_acquire, wait_a_little
from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from ..predicates.filtered2d import orient2d
from .dag import descend
from .flips import flip, illegal, subdivide
from .illegal_edges import note_star
from .in_place.walk import walk_history
from .lookahead.located import AT_ONCE, locate_one, prepare
from .mesh import (
    ACCESSES,
    AT,
    CHANGE_CYCLES,
    CHILD,
    GIVEN_UP,
    HINT,
    IN_HAND,
    INSERTED,
    LAST,
    LOCATION_CYCLES,
    NEIGHBOR,
    NODE,
    OPEN,
    PHASE,
    SITE,
    SUSPECT,
    VISITED,
    WAIT_CYCLES,
    WAITS,
    stumble,
)
from .patience import GIVING_WAY, NAP, STEP, strive
from .pool import (
    BEGIN,
    EXCEPTIONAL,
    LEGALISE,
    NOBODY,
    SUBDIVIDE,
    blocker_of,
    clear_exception,
    publish,
    retire,
    still_waits,
    wait_for,
)
from .queue import ITEM_NODE, ITEM_SITE
from .steps import (
    CHANGED,
    DONE,
    FINISHED,
    GO_ON,
    LOCATED,
    OPEN_SWAPS,
    WAITING,
    spend,
    verdict,
)
from .work_sharing import unowned_sites

HEAD_START = 1024


def ahead(n: int, threads: int) -> int:
    """How many sites of each part the first thread inserts alone.

    Where there are but a few triangles, every insertion meets the others', and what is left open there
    spreads over all that follows. They are of all parts, so that the threads are then equally far.
    """
    return min(HEAD_START, n // (8 * threads)) // threads


@cached_njit(forceinline=True)
def _edge(nodes, t, k):
    return load_acquire(nodes, (t, NEIGHBOR + k))


@cached_njit(forceinline=True)
def _is_leaf(nodes, t):
    return load_acquire(nodes, (t, CHILD)) < 0


@cached_njit(forceinline=True)
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


@cached_njit(forceinline=True)
def _try_subdivision(points, nodes, shared, state, pool, me, walking, w):
    """Subdivide the leaf that contains the site of ``me``, or find whom to wait for."""
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
    i, serial = blocker_of(points, nodes, state, pool, me, looked_at, 4 if k < 0 else 6, w)
    if i != NOBODY:
        # where i waits for this thread, the next look leaves it out of account
        return WAITING if wait_for(shared, pool, me, i, serial) else CHANGED
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
        made = flip(nodes, shared, state, me, flat, 0, 0)
        first = made if flat == first else first
    state[me, NODE], state[me, LAST], state[me, PHASE] = first, nodes[first, 1], LEGALISE
    return CHANGED


@cached_njit(forceinline=True)
def _try_flip(points, nodes, shared, state, pool, me, f, w):
    """Flip the edge of star triangle f opposite the site of ``me``, or find whom to wait for."""
    state[me, ACCESSES] += 1
    edge = _edge(nodes, f, 0)
    u, j = edge >> 2, edge & 3
    a, b = _edge(nodes, u, (j + 1) % 3), _edge(nodes, u, (j + 2) % 3)
    i, serial = blocker_of(points, nodes, state, pool, me, (u, a >> 2, b >> 2), 3, w)
    if i != NOBODY:
        return WAITING if wait_for(shared, pool, me, i, serial) else CHANGED
    if (
        edge == _edge(nodes, f, 0)
        and _is_leaf(nodes, u)
        and a == _edge(nodes, u, (j + 1) % 3)
        and b == _edge(nodes, u, (j + 2) % 3)
    ):
        state[me, NODE] = flip(nodes, shared, state, me, f, 0, 0)
    return CHANGED


@cached_njit(forceinline=True)
def _try_legalisation(points, nodes, shared, state, pool, notes, me, w):
    """Go round the star to the next edge to be flipped, and try that; or end the insertion."""
    f = state[me, NODE]
    if load(pool, (me, EXCEPTIONAL)) != 0 or not _is_leaf(nodes, f):
        state[me, GIVEN_UP] += 1
        state[me, SUSPECT] = 1
    else:
        # the star is this thread's own, and goes round
        for _ in range(len(nodes)):
            if illegal(points, nodes, f, w):
                return _try_flip(points, nodes, shared, state, pool, me, f, w)
            if nodes[f, 2] == state[me, LAST]:
                break
            f = _edge(nodes, f, 1) >> 2
            state[me, NODE] = f
        else:
            msg = "a star of a 2D triangulation does not close"
            raise InternalError(msg)
    if state[me, SUSPECT] != 0:
        note_star(nodes, shared, state, notes, me, f, state[me, SITE])
        state[me, SUSPECT] = 0
    state[me, HINT] = f
    retire(pool, me)
    state[me, INSERTED] += 1
    state[me, PHASE] = BEGIN
    return CHANGED


@cached_njit(forceinline=True)
def step(points, nodes, shared, state, sites, pool, notes, lanes, hands, me, walking, w):
    """One step of thread ``me``: locate a site, publish one, try to subdivide, or try to flip an edge."""
    if still_waits(pool, me):
        return WAITING
    if state[me, PHASE] == SUBDIVIDE:
        clear_exception(pool, me)  # it locates again in any case
        return _try_subdivision(points, nodes, shared, state, pool, me, walking, w)
    if state[me, PHASE] == LEGALISE:
        return _try_legalisation(points, nodes, shared, state, pool, notes, me, w)
    if state[me, IN_HAND] < AT_ONCE and locate_one(points, nodes, state, sites, lanes, hands, me, walking, w):
        return LOCATED
    at, count = state[me, AT], state[me, IN_HAND]
    if at == count:
        return FINISHED
    prepare(points, nodes, hands, at, count)
    q = hands[at, ITEM_SITE]
    state[me, SITE], state[me, NODE], state[me, PHASE] = q, hands[at, ITEM_NODE], SUBDIVIDE
    if at + 1 < count:
        state[me, AT] = at + 1
    else:
        state[me, AT] = state[me, IN_HAND] = 0
    publish(pool, me, q)
    return CHANGED


@cached_njit(nogil=True)
def run(points, nodes, shared, state, sites, me, pool, notes, lanes, hands, alone, walking, w):
    """Insert sites until none is left for this thread; `DONE`, or why it came back before.

    The others begin when thread 0 has inserted ``alone`` sites.
    """
    points, nodes, shared, state = unowned(points), unowned(nodes), unowned(shared), unowned(state)
    sites, pool, w = unowned_sites(sites), unowned(pool), unowned(w)
    notes, lanes, hands = unowned(notes), unowned(lanes), unowned(hands)
    waiting, effort = 0, 0
    while me > 0 and load(state, (0, INSERTED)) < alone:
        reason = verdict(shared, True, True)
        if reason != GO_ON:
            return reason
        wait_a_little(waiting)
        effort = strive(shared, state, me, effort, GIVING_WAY if waiting < TURNS else NAP)
        waiting += 1
    waiting = 0
    begun = cycles()
    while True:
        between = state[me, PHASE] == BEGIN
        reason = verdict(shared, True, between)
        if reason != GO_ON:
            return reason
        if between and load(shared, (OPEN, 0)) != 0:
            return OPEN_SWAPS
        did = step(points, nodes, shared, state, sites, pool, notes, lanes, hands, me, walking, w)
        if did == FINISHED:
            return DONE
        if did != CHANGED or waiting > 0 or state[me, PHASE] == BEGIN:
            # a location, a wait or an insertion ends
            column = WAIT_CYCLES if did == WAITING else (LOCATION_CYCLES if did == LOCATED else CHANGE_CYCLES)
            begun = spend(state, me, column, begun)
        if did == WAITING:
            state[me, WAITS] += waiting == 0
            wait_a_little(waiting)
            effort = strive(shared, state, me, effort, GIVING_WAY if waiting < TURNS else NAP)
            waiting += 1
        else:
            # it may find again and again that what it looked at has changed
            effort = strive(shared, state, me, effort, STEP)
            waiting = 0
        stumble(shared, state, me)
