"""The batch method: searching threads, a queue, one specialised thread (section 3.3, Algorithm 2).

A searching thread locates sites, several at a time, and puts each into the queue with the leaf that contains
it, or as in the paper, on request, one at a time and with the leaf's parent. The specialised thread, which is
the last, finishes the location, as there may be children by then, subdivides and legalises. In the variant of
the paper's reviewer a searching thread that finds the queue full takes an element, finishes its location, and
puts it back.

The specialised thread knows which sites come next, and loads their leaves while it inserts others.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._numba.atomics import nap
from .._numba.kernel_cache import cached_njit
from .._numba.prefetch import prefetch
from . import columns as c
from .configuration import Options
from .flips import insert
from .location import DAG, WALK, find_again
from .lookahead.located import Lookahead, locate_ahead, next_located, nothing_located
from .mesh import Store
from .patience import LOOKS_AT_QUEUE, NAP, STEP
from .queue import ITEM_NODE, ITEM_SITE, empty_queue, fill_of, get, put
from .steps import CHANGED, FINISHED, LOCATED, QUEUED, WAITING, Clock, method
from .work_sharing import Schedule


class Tools(NamedTuple):
    """What the method needs beside the mesh; ``cells`` are those of the queue."""

    schedule: Schedule
    cells: np.ndarray
    lookahead: Lookahead
    location: int
    helping: bool


def tools(store: Store, schedule: Schedule, options: Options) -> Tools:
    """For a run with these options."""
    location = WALK if options.location == "walk" else DAG
    cells = empty_queue(options.queue_length)
    lookahead = nothing_located(options.threads, options.searches, parents=options.queue_parents)
    return Tools(schedule, cells, lookahead, location, options.helping)


@cached_njit(forceinline=True)
def _search(mesh, me, tools):
    """One step of a searching thread: locate a site, put some into the queue, or help."""
    state, shared, cells = mesh.state, mesh.shared, tools.cells
    located, most = tools.lookahead.located[me], tools.lookahead.most
    if state[me, c.HELPED] != 0:
        if put(cells, shared, located, most, 1) == 0:
            return WAITING
        state[me, c.HELPED] = 0
        return QUEUED
    left = state[me, c.LOCATED_END] - state[me, c.LOCATED_AT]
    if state[me, c.LOCATED_END] < most and locate_ahead(
        mesh, me, tools.schedule, tools.lookahead, tools.location
    ):
        return LOCATED
    if left == 0:
        return FINISHED
    count = put(cells, shared, located, state[me, c.LOCATED_AT], left)
    if count > 0:
        state[me, c.LOCATED_AT] += count
        if count == left:
            state[me, c.LOCATED_AT] = state[me, c.LOCATED_END] = 0
        return QUEUED
    if tools.helping and get(cells, shared, located, most, 1) == 1:
        q, t = located[most, ITEM_SITE], located[most, ITEM_NODE]
        t, visited = find_again(mesh, t, q, tools.location)
        state[me, c.VISITED] += visited
        located[most, ITEM_NODE] = t
        state[me, c.HELPED] = 1
        return LOCATED
    return WAITING


@cached_njit(forceinline=True)
def _insert_next(mesh, me, tools):
    """One step of the specialised thread: an element from the queue is inserted."""
    state = mesh.state
    if state[me, c.INSERTED] == len(mesh.points) - 3:
        return FINISHED
    if state[me, c.LOCATED_AT] == state[me, c.LOCATED_END]:
        located, fill = tools.lookahead.located[me], fill_of(mesh.shared)
        count = get(tools.cells, mesh.shared, located, 0, tools.lookahead.most)
        if count == 0:
            return WAITING
        state[me, c.QUEUE_FILL] += fill * count
        state[me, c.LOCATED_AT], state[me, c.LOCATED_END] = 0, count
        for i in range(count):
            prefetch(mesh.nodes, located[i, ITEM_NODE])
    q, t = next_located(mesh, me, tools.lookahead)
    t, visited = find_again(mesh, t, q, tools.location)
    insert(mesh, me, t, q, 0)
    state[me, c.VISITED] += visited
    state[me, c.INSERTED] += 1
    return CHANGED


@cached_njit(forceinline=True)
def step(mesh, me, tools):
    """One step of a searching thread, or of the specialised one."""
    if me == len(mesh.state) - 1:
        return _insert_next(mesh, me, tools)
    return _search(mesh, me, tools)


@cached_njit(forceinline=True)
def _wait(mesh, me, waited):
    """Look again, then sleep.

    A nap does not empty a long queue, nor fill it. Giving way would be worse with more threads than
    processors: a scheduler may then let another one run for milliseconds.
    """
    mesh.state[me, c.WAITS] += waited == 0
    if waited > LOOKS_AT_QUEUE:
        nap()
        return NAP
    return STEP


METHOD = method(tools, step, wait=_wait, clock=Clock.BY_WAITS)
