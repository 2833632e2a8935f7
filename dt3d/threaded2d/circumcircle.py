"""The circum-circle method: geometry tells which thread waits.

Algorithm 3 of Kohout et al. 2004 (section 3.4). An insertion changes only triangles that are in conflict with
its site, or have it as a vertex. Every thread publishes its site in a pool before it changes anything. It
subdivides or flips when no other site of the pool is in conflict with, or a vertex of, the triangles that
change and their neighbours; otherwise it waits for the thread whose site that is to finish it. As each
publishes before it looks, of two that want the same at least one sees the other.

Two that see each other would wait for ever. So a thread looks, in a short critical section, whether the one
it would wait for waits for it, through others perhaps. Then it goes on, since those cannot, and flags their
exceptional state: after they wake they locate again, or, if they were legalising, give up their remaining
swaps. The paper makes up for those in the end. Here all threads pause as soon as their insertions have ended
(`illegal_edges`, `correction`): what is left open spreads, on some sets to quadratically many swaps.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._errors import InternalError
from .._numba.atomics import load, load_acquire
from .._numba.kernel_cache import cached_njit
from ..predicates.plane import orient2d
from . import columns as c
from .columns import side, triangle
from .configuration import Options
from .flips import flip, illegal, subdivide
from .illegal_edges import mark_star, no_marks
from .location import DAG, WALK, find_again
from .lookahead.located import Lookahead, locate_ahead, next_located, nothing_located
from .mesh import Store
from .pool import (
    EXCEPTIONAL,
    NOBODY,
    blocker_of,
    clear_exception,
    empty_pool,
    publish,
    retire,
    still_waits,
    wait_for,
)  # fmt: skip
from .steps import CHANGED, FINISHED, LOCATED, WAITING, method
from .work_sharing import TAKEN, Schedule, ahead_of_all

HEAD_START = 1024


class Tools(NamedTuple):
    """What the method needs beside the mesh.

    Attributes
    ----------
    pool : int64 (threads, k)
        The sites that are being inserted.
    marks : int32 (threads, k)
        Triangles beside which illegal edges may be left.
    alone : int
        The other threads begin when thread 0 has inserted so many sites.
    test_all : bool
        Before a flip, test both triangles and all four neighbours, as in the paper, and not only those that
        another thread may change.
    """

    schedule: Schedule
    lookahead: Lookahead
    pool: np.ndarray
    marks: np.ndarray
    alone: int
    location: int
    test_all: bool


def head_start(n: int, threads: int) -> int:
    """How many sites of each part the first thread inserts alone.

    Where there are but a few triangles, every insertion meets the others', and what is left open there
    spreads over all that follows. They are of all parts, so that the threads are then equally far.
    """
    return min(HEAD_START, n // (8 * threads)) // threads


def with_head_start(order: np.ndarray, bounds: np.ndarray, options: Options) -> tuple[np.ndarray, np.ndarray]:
    """The order and the bounds of the parts with the sites of the head start, if there is one, in front."""
    if options.method != "circumcircle" or options.threads == 1 or not options.head_start:
        return order, bounds
    return ahead_of_all(order, bounds, head_start(len(order), options.threads))


def tools(store: Store, schedule: Schedule, options: Options) -> Tools:
    """For a run with these options; what lies in front of all parts is for the first thread."""
    alone = int(schedule.parts[0, TAKEN])
    store.state[0, c.CHUNK_END] = alone
    store.state[1:, c.PHASE] = c.HEAD_START if alone else c.BEGIN
    schedule.taker[:alone] = 0
    return Tools(
        schedule,
        nothing_located(options.threads, options.searches),
        empty_pool(options.threads),
        no_marks(options.threads),
        alone,
        WALK if options.location == "walk" else DAG,
        options.test_all,
    )


@cached_njit(forceinline=True)
def _beyond(nodes, t, k):
    """The edge on the other side of edge k of t."""
    return load_acquire(nodes, (t, c.NEIGHBOR + k))


@cached_njit(forceinline=True)
def _is_leaf(nodes, t):
    return load_acquire(nodes, (t, c.CHILD)) < 0


@cached_njit(forceinline=True)
def _edge_through(mesh, t, q):
    """Which edge of t site q, which t contains, lies on; -1 where on none.

    Edges at infinity pass through no site.
    """
    points, nodes, w = mesh.points, mesh.nodes, mesh.workspace
    v0, v1, v2 = nodes[t, 0], nodes[t, 1], nodes[t, 2]
    if v1 >= 0 and v2 >= 0 and orient2d(points, v1, v2, q, w) == 0:
        return 0
    if v2 >= 0 and v0 >= 0 and orient2d(points, v2, v0, q, w) == 0:
        return 1
    if v0 >= 0 and v1 >= 0 and orient2d(points, v0, v1, q, w) == 0:
        return 2
    return -1


@cached_njit(forceinline=True)
def _try_subdivision(mesh, me, tools):
    """Subdivide the leaf that contains the site of ``me``, or find which thread to wait for."""
    nodes, state, pool = mesh.nodes, mesh.state, tools.pool
    q = state[me, c.SITE]
    t, visited = find_again(mesh, state[me, c.NODE], q, tools.location)
    state[me, c.NODE] = t
    state[me, c.VISITED] += visited
    state[me, c.ACCESSES] += 1
    beyond0, beyond1, beyond2 = _beyond(nodes, t, 0), _beyond(nodes, t, 1), _beyond(nodes, t, 2)
    k = _edge_through(mesh, t, q)
    if k >= 0:
        # q lies on an edge, and the triangle beyond is subdivided too
        across = beyond0 if k == 0 else (beyond1 if k == 1 else beyond2)
        u, j = triangle(across), side(across)
        d, e = _beyond(nodes, u, (j + 1) % 3), _beyond(nodes, u, (j + 2) % 3)
        last, next_to_last = triangle(e), triangle(d)
    else:
        u, j, d, e = t, 0, beyond0, beyond1
        last = next_to_last = t
    looked_at = (t, triangle(beyond0), triangle(beyond1), triangle(beyond2), next_to_last, last)
    i, serial = blocker_of(mesh, me, pool, looked_at, 4 if k < 0 else 6)
    if i != NOBODY:
        # where i waits for this thread, the next look leaves it out of account
        return WAITING if wait_for(mesh.shared, pool, me, i, serial) else CHANGED
    # what was looked at must be what is there
    if (
        not _is_leaf(nodes, t)
        or beyond0 != _beyond(nodes, t, 0)
        or beyond1 != _beyond(nodes, t, 1)
        or beyond2 != _beyond(nodes, t, 2)
    ):
        return CHANGED
    if k >= 0 and not (
        _is_leaf(nodes, u) and d == _beyond(nodes, u, (j + 1) % 3) and e == _beyond(nodes, u, (j + 2) % 3)
    ):
        return CHANGED
    first = subdivide(mesh, me, t, q, 0)
    if k >= 0:
        # the flat one of the three goes at once: no thread ever meets it, and it cannot be given up
        flat = first + 1 if k == 0 else (first + 2 if k == 1 else first)
        made = flip(mesh, me, flat, 0, 0)
        first = made if flat == first else first
    state[me, c.NODE], state[me, c.LAST], state[me, c.PHASE] = first, nodes[first, 1], c.LEGALISE
    return CHANGED


@cached_njit(forceinline=True)
def _try_flip(mesh, me, tools, f):
    """Flip the edge of star triangle f opposite the site of ``me``, or find which thread to wait for."""
    nodes, state, pool = mesh.nodes, mesh.state, tools.pool
    state[me, c.ACCESSES] += 1
    beyond = _beyond(nodes, f, 0)
    u, j = triangle(beyond), side(beyond)
    a, b = _beyond(nodes, u, (j + 1) % 3), _beyond(nodes, u, (j + 2) % 3)
    # f and its other neighbours are star triangles of this thread's site; the paper tests them too
    before, after = triangle(_beyond(nodes, f, 1)), triangle(_beyond(nodes, f, 2))
    looked_at = (u, triangle(a), triangle(b), f, before, after)
    i, serial = blocker_of(mesh, me, pool, looked_at, 6 if tools.test_all else 3)
    if i != NOBODY:
        return WAITING if wait_for(mesh.shared, pool, me, i, serial) else CHANGED
    if (
        beyond == _beyond(nodes, f, 0)
        and _is_leaf(nodes, u)
        and a == _beyond(nodes, u, (j + 1) % 3)
        and b == _beyond(nodes, u, (j + 2) % 3)
    ):
        state[me, c.NODE] = flip(mesh, me, f, 0, 0)
    return CHANGED


@cached_njit(forceinline=True)
def _try_legalisation(mesh, me, tools):
    """Go round the star to the next edge to be flipped, and try that; or end the insertion."""
    nodes, state = mesh.nodes, mesh.state
    f = state[me, c.NODE]
    if load(tools.pool, (me, EXCEPTIONAL)) != 0 or not _is_leaf(nodes, f):
        state[me, c.GIVEN_UP] += 1
        state[me, c.STAR_MARKED] = 1
    else:
        # the star is this thread's own, and goes round
        for _ in range(len(nodes)):
            if illegal(mesh, f):
                return _try_flip(mesh, me, tools, f)
            if nodes[f, 2] == state[me, c.LAST]:
                break
            f = triangle(_beyond(nodes, f, 1))
            state[me, c.NODE] = f
        else:
            msg = "a star of a 2D triangulation does not close"
            raise InternalError(msg)
    if state[me, c.STAR_MARKED] != 0:
        mark_star(mesh, me, tools.marks, f, state[me, c.SITE])
        state[me, c.STAR_MARKED] = 0
    state[me, c.HINT] = f
    retire(tools.pool, me)
    state[me, c.INSERTED] += 1
    state[me, c.PHASE] = c.BEGIN
    return CHANGED


@cached_njit(forceinline=True)
def step(mesh, me, tools):
    """One step of thread ``me``: locate a site, publish one, try to subdivide, or try to flip an edge."""
    state, pool = mesh.state, tools.pool
    if still_waits(pool, me):
        return WAITING
    if state[me, c.PHASE] == c.SUBDIVIDE:
        clear_exception(pool, me)  # it locates again in any case
        return _try_subdivision(mesh, me, tools)
    if state[me, c.PHASE] == c.LEGALISE:
        return _try_legalisation(mesh, me, tools)
    if state[me, c.PHASE] == c.HEAD_START:
        if load(state, (0, c.INSERTED)) < tools.alone:
            return WAITING
        state[me, c.PHASE] = c.BEGIN
    if state[me, c.LOCATED_END] < tools.lookahead.most and locate_ahead(
        mesh, me, tools.schedule, tools.lookahead, tools.location
    ):
        return LOCATED
    if state[me, c.LOCATED_AT] == state[me, c.LOCATED_END]:
        return FINISHED
    q, t = next_located(mesh, me, tools.lookahead)
    state[me, c.SITE], state[me, c.NODE], state[me, c.PHASE] = q, t, c.SUBDIVIDE
    publish(pool, me, q)
    return CHANGED


METHOD = method(tools, step)
