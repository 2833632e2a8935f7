"""Insertion in place, without a history: the conflicts give way to the star of the site.

The two triangles that an insertion adds have the numbers 4 + 2 i and 5 + 2 i, where i is the site's place in
the order, so that threads need not ask each other for memory.
"""

from __future__ import annotations

from typing import NamedTuple

from ..._errors import InternalError
from ..._numba.atomics import TURNS, store_release, wait_a_little
from ..._numba.kernel_cache import cached_njit
from .. import columns as c
from ..columns import edge, side, triangle
from ..configuration import Options
from ..mesh import ROOTS, Store, inject_yield
from ..patience import NAP, STEP, strive
from ..steps import CHANGED, FINISHED, WAITING, Clock, method
from ..work_sharing import Schedule, next_site
from .cavity import BUSY, Scratch, empty_scratch, lock_cavity, unlock
from .walk import walk

SITES_PER_STEP = 64  # so many may go before a thread looks whether it has to stop
ATTEMPTS = 4  # before a thread that does not get its triangles gives way


class Tools(NamedTuple):
    """What the method needs beside the mesh."""

    schedule: Schedule
    scratch: Scratch


def tools(store: Store, schedule: Schedule, options: Options) -> Tools:
    """For a run with these options."""
    return Tools(schedule, empty_scratch(len(store.points), options.threads))


@cached_njit(forceinline=True)
def _write(nodes, t, vertices, edges, me, lock):
    """The star triangle t: its vertices, the first of which is the site, and the edges beyond its own."""
    store_release(nodes, (t, c.LOCK), lock)
    store_release(nodes, (t, 0), vertices[0])
    store_release(nodes, (t, 1), vertices[1])
    store_release(nodes, (t, 2), vertices[2])
    store_release(nodes, (t, c.NEIGHBOR), edges[0])
    store_release(nodes, (t, c.NEIGHBOR + 1), edges[1])
    store_release(nodes, (t, c.NEIGHBOR + 2), edges[2])
    store_release(nodes, (t, c.CHILD), -1 - me)
    store_release(nodes, (triangle(edges[0]), c.NEIGHBOR + side(edges[0])), edge(t, 0))


@cached_njit(forceinline=True)
def fill(mesh, me, q, sizes, scratch, unused, lock):
    """Replace the cavity by the star of q, which has two triangles more: ``unused`` and the one after it.

    ``sizes`` are the triangles in the cavity and the edges of its rim. Returns a triangle of the star.
    """
    cavity, rim = scratch.cavity[me], scratch.rim[me]
    size, edges = sizes
    cavity[size], cavity[size + 1] = unused, unused + 1
    previous, t = cavity[edges - 1], cavity[0]
    for i in range(edges):
        following = cavity[i + 1] if i + 1 < edges else cavity[0]
        beyond, a, b = rim[3 * i], rim[3 * i + 1], rim[3 * i + 2]
        _write(mesh.nodes, t, (q, a, b), (beyond, edge(following, 2), edge(previous, 1)), me, lock)
        previous, t = t, following
    return cavity[0]


@cached_njit(forceinline=True)
def step(mesh, me, tools):
    """Insert sites, each from the triangle where the last one was, until one has to wait; some at a time.

    Of several threads, each has exclusive access to its conflicts and the triangles around them, and begins
    again where it does not get it. What is counted is added up in registers: threads on one core share what
    writes to memory.
    """
    nodes, state = mesh.nodes, mesh.state
    lock = me + 1 if len(state) > 1 else 0
    q = next_site(mesh, tools.schedule, me)
    if q < 0:
        return FINISHED
    hint, at = state[me, c.HINT], state[me, c.NEXT]
    end = min(at + SITES_PER_STEP, state[me, c.CHUNK_END])
    visited = flips = 0
    inserted = state[me, c.INSERTED]
    outcome = CHANGED
    while at < end:
        q = tools.schedule.order[at]
        t, steps = walk(mesh, hint, q)
        visited += steps
        if steps > len(nodes):
            if lock == 0:
                msg = "a walk through a 2D triangulation goes round in circles"
                raise InternalError(msg)
            strive(mesh, me, steps)
        inject_yield(mesh, me)
        size, edges, count = lock_cavity(mesh, me, t, q, lock, tools.scratch)
        if size == BUSY:
            unlock(nodes, tools.scratch.locked[me], count)
            state[me, c.RETRIES] += 1
            hint, outcome = t, WAITING
            break
        inject_yield(mesh, me)
        unused = ROOTS + 2 * at
        hint = fill(mesh, me, q, (size, edges), tools.scratch, unused, lock)
        if lock != 0:
            unlock(nodes, tools.scratch.locked[me], count)
            store_release(nodes, (unused, c.LOCK), 0)
            store_release(nodes, (unused + 1, c.LOCK), 0)
        flips += size - 1
        inserted += 1
        store_release(state, (me, c.INSERTED), inserted)  # others look at it while they wait
        at += 1
    state[me, c.HINT], state[me, c.NEXT] = hint, at
    state[me, c.VISITED] += visited
    state[me, c.FLIPS] += flips
    return outcome


@cached_njit(forceinline=True)
def _wait(mesh, me, waited):
    """Try again at once for some times."""
    if waited >= ATTEMPTS:
        wait_a_little(waited + 1 - ATTEMPTS)
    return STEP if waited + 1 < ATTEMPTS + TURNS else NAP


METHOD = method(tools, step, wait=_wait, clock=Clock.NEVER, with_history=False)
