"""Virtual time: the methods' own steps on 1 to 64 simulated processing elements.

A scheduler lets the element whose clock is least take the next step of its thread, which is the very step
that real threads take, on the very structure. It then sets the clock forward by what the step has counted
(nodes visited, edges flipped, tests ...) times costs that were measured in a sequential run. So waits,
deadlocks, lock conflicts and a queue that is full or empty come about as they would, and a run can be
repeated. What is left out: caches, which made the paper's speed-ups more than linear, the memory's bandwidth,
and the time of the correction of swaps that were given up, which comes at the end, as in the paper.

Elements take turns with their threads when a thread waits, and after a slice of time when there are more
threads than elements.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._numba.kernel_cache import cached_njit
from ..._numba.unowned import unowned
from .. import circumcircle
from .. import columns as c
from ..configuration import Options
from ..correction import correct
from ..dag import locate
from ..driver import METHODS
from ..flips import insert
from ..illegal_edges import marked
from ..patience import STEP, strive
from ..steps import CHANGED, FINISHED, LOCKED, QUEUED, WAITING, specialised
from ..work_sharing import next_site
from .costs import Costs, prepared

if TYPE_CHECKING:
    from collections.abc import Callable

MOST_ELEMENTS = 64


@dataclass(frozen=True)
class Simulation:
    """What a simulated run took and counted."""

    seconds: float
    busy: float  # share of the elements' time that was not waiting
    waits: int
    retries: int
    exceptions: int
    given_up: int
    tests: int
    triangles: int
    visited: tuple[int, ...]  # nodes, by each thread
    inserted: tuple[int, ...]  # sites, by each thread
    corrected: int  # swaps that the correction had to make, where it was to count them


step: Any = None  # a method's own, see `specialised`


@cached_njit(forceinline=True)
def _counted(state, k):
    return state[k, c.VISITED], state[k, c.FLIPS], state[k, c.INSERTED], state[k, c.TESTS]


@cached_njit(nogil=True)
def _simulate(mesh, tools, elements, costs, prices):
    """Seconds of the last element to end, and of all elements that were not spent waiting.

    ``prices`` are the seconds of what a step returns, beside those of what it has counted.
    """
    mesh, tools = unowned(mesh), unowned(tools)
    state = mesh.state
    threads = len(state)
    clock, since = np.zeros(elements), np.zeros(elements)
    running = np.full(elements, -1)
    ready = np.empty(threads + 1, np.int64)  # a ring
    head, tail = 0, 0
    for k in range(threads):
        # the specialised thread of the batch method, which is the last, comes first
        ready[tail] = threads - 1 - k
        tail += 1
    alive, busy, last = threads, 0.0, 0.0
    while alive > 0:
        strive(mesh, 0, STEP)
        e = 0
        for i in range(1, elements):
            if clock[i] < clock[e]:
                e = i
        if running[e] < 0:
            if head != tail:
                running[e] = ready[head]
                head = (head + 1) % (threads + 1)
                since[e] = clock[e]
            else:
                # nothing to do until another element gives a thread away
                clock[e] += costs.wait
                continue
        k = running[e]
        visited, flips, inserted, tests = _counted(state, k)
        helped = state[k, c.HELPED]
        outcome = step(mesh, k, tools)
        visited2, flips2, inserted2, tests2 = _counted(state, k)
        if outcome == FINISHED:
            alive -= 1
            running[e] = -1
            last = max(last, clock[e])
            continue
        spent = (
            costs.visit * (visited2 - visited)
            + costs.node * 2 * (flips2 - flips)
            + costs.test * (tests2 - tests)
        )
        # the subdivision is counted with the end of the insertion
        spent += costs.node * 3 * (inserted2 - inserted) + prices[outcome]
        if state[k, c.HELPED] > helped:
            # it took an element from the queue to finish its location
            spent += costs.get
        busy += spent
        if outcome == WAITING:
            spent += costs.wait
            state[k, c.WAITS] += 1
        clock[e] += spent
        last = max(last, clock[e])
        if head != tail and (outcome == WAITING or clock[e] - since[e] > costs.slice):
            ready[tail] = k
            tail = (tail + 1) % (threads + 1)
            running[e] = -1
    return last, busy


@cache
def _simulation(method: str) -> Callable[..., tuple[float, float]]:
    """The scheduler of a method's steps."""
    kernel: Callable[..., tuple[float, float]] = _simulate
    return specialised(kernel, __name__, method, step=METHODS[method].step)


@cached_njit(nogil=True)
def _simulate_critical(mesh, schedule, elements, costs):
    """The pessimistic method, and with one element the sequential one; one thread on each element.

    As long as an element is in the critical section, others that come to it wait.
    """
    mesh, schedule = unowned(mesh), unowned(schedule)
    state = mesh.state
    clock = np.zeros(elements)
    free, busy = 0.0, 0.0
    left = elements
    ended = np.zeros(elements, np.bool_)
    last = 0.0
    while left > 0:
        e = -1
        for i in range(elements):
            if not ended[i] and (e < 0 or clock[i] < clock[e]):
                e = i
        q = next_site(mesh, schedule, e)
        if q < 0:
            ended[e] = True
            left -= 1
            last = max(last, clock[e])
            continue
        t, visited = locate(mesh, q)
        before = state[e, c.FLIPS]
        insert(mesh, e, t, q, 0)
        change = costs.node * (3 + 2 * (state[e, c.FLIPS] - before))
        state[e, c.INSERTED] += 1
        state[e, c.VISITED] += visited
        state[e, c.NEXT] += 1
        entered = clock[e] + costs.visit * visited
        if entered < free:
            state[e, c.WAITS] += 1
            entered = free + costs.wait
        busy += costs.visit * visited + change
        clock[e] = entered + change
        free = clock[e]
    return last, busy


def _prices(method: str, costs: Costs) -> np.ndarray:
    """Seconds of each outcome of a step."""
    prices = np.zeros(6)
    if method == "batch":
        prices[CHANGED], prices[QUEUED] = costs.get, costs.queue
    elif method == "optimistic":
        prices[LOCKED] = costs.locks
    return prices


def simulate(
    points: np.ndarray, options: Options, elements: int, costs: Costs, *, count_corrected: bool = False
) -> Simulation:
    """A run on ``elements`` processing elements, in virtual time.

    Parameters
    ----------
    points : float64 (n, 2)
        The sites, in the range of the exact predicates.
    options : Options
        location="dag"; with the pessimistic method a thread for each element.
    elements : int
        1 to 64.
    costs : Costs
        Seconds of the operations that a step counts.
    count_corrected : bool
        Make up for swaps that were given up, in no time, to count them. On narrow triangles, as of an arc,
        there may be quadratically many.

    Raises
    ------
    ValueError
        If there are more elements than that, or the location is not "dag".
    """
    if not 1 <= elements <= MOST_ELEMENTS:
        msg = f"elements must be 1 to {MOST_ELEMENTS}, got {elements}"
        raise ValueError(msg)
    if options.location != "dag":
        msg = f"virtual time has location='dag' only, got {options.location!r}"
        raise ValueError(msg)
    if options.method in ("sequential", "pessimistic"):
        elements = elements if options.method == "pessimistic" else 1
        options = replace(options, threads=elements)
        store, schedule = prepared(points, options)
        tools: object = None
        seconds, busy = _simulate_critical(store.mesh(), schedule, elements, costs)
    else:
        store, schedule = prepared(points, options)
        tools = METHODS[options.method].tools(store, schedule, options)
        prices = _prices(options.method, costs)
        seconds, busy = _simulation(options.method)(store.mesh(), tools, elements, costs, prices)
    s = store.state.sum(axis=0)
    corrected = 0
    if count_corrected and isinstance(tools, circumcircle.Tools):
        corrected = correct(store, marked(store, tools.marks))
    leaves = int((store.nodes[:, c.CHILD] < 0).sum())
    return Simulation(
        seconds=float(seconds),
        busy=float(busy / (seconds * elements)),
        waits=int(s[c.WAITS]),
        retries=int(s[c.RETRIES]),
        exceptions=int(s[c.EXCEPTIONS]),
        given_up=int(s[c.GIVEN_UP]),
        tests=int(s[c.TESTS]),
        triangles=leaves,
        visited=tuple(int(x) for x in store.state[:, c.VISITED]),
        inserted=tuple(int(x) for x in store.state[:, c.INSERTED]),
        corrected=corrected,
    )
