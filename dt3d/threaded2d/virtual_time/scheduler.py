"""Virtual time: the methods' own operations on 1 to 64 simulated processing elements.

A scheduler lets the element whose clock is least take the next step of its thread, which is the very step
that real threads take, on the very structure. It then sets the clock forward by what the step has counted
(nodes visited, edges flipped, tests ...) times costs that were measured in a sequential run. So waits,
deadlocks, lock conflicts and a queue that is full or empty come about as they would, and a run can be
repeated. What is left out: caches, which made the paper's speed-ups more than linear, the memory's bandwidth,
and the correction of swaps that were given up.

Elements take turns with their threads when a thread waits, and after a slice of time when there are more
threads than elements.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..._numba.kernel_cache import cached_njit
from ..._numba.unowned import unowned
from ...predicates import work_array
from .. import batch, circumcircle, optimistic
from ..configuration import Options
from ..dag import locate
from ..flips import insert
from ..illegal_edges import empty_notes
from ..lookahead.interleaved import empty_lanes
from ..lookahead.located import empty_hands
from ..mesh import CHILD, EXCEPTIONS, FLIPS, GIVEN_UP, INSERTED, NEXT, RETRIES, TESTS, VISITED, WAITS
from ..patience import STEP, strive
from ..pool import empty_pool
from ..queue import empty_queue
from ..steps import CHANGED, FINISHED, WAITING
from ..work_sharing import next_site, unowned_sites
from .costs import Costs, prepared

SEQUENTIAL, BATCH, CIRCUMCIRCLE, OPTIMISTIC, PESSIMISTIC = range(5)
_METHODS = {
    "sequential": SEQUENTIAL,
    "batch": BATCH,
    "circumcircle": CIRCUMCIRCLE,
    "optimistic": OPTIMISTIC,
    "pessimistic": PESSIMISTIC,
}
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


@cached_njit
def _counted(state, k):
    return state[k, VISITED], state[k, FLIPS], state[k, INSERTED], state[k, TESTS]


@cached_njit(forceinline=True)
def _step(
    points, nodes, shared, state, sites,
    pool, notes, cells, lanes, hands, held, cavity, rim, method, helping, k, w,
):  # fmt: skip
    """A step of thread k."""
    if method == BATCH:
        if k == len(state) - 1:
            return batch.specialised_step(points, nodes, shared, state, cells, hands[k], k, False, w)
        return batch.search_step(
            points, nodes, shared, state, sites, cells, lanes[k], hands[k], k, False, helping, w
        )
    if method == CIRCUMCIRCLE:
        return circumcircle.step(
            points, nodes, shared, state, sites, pool, notes[k], lanes[k], hands[k], k, False, w
        )
    return optimistic.step(points, nodes, shared, state, sites, held[k], cavity[k], rim[k], k, w)


@cached_njit(nogil=True)
def _simulate(
    points,
    nodes,
    shared,
    state,
    sites,
    pool,
    notes,
    cells,
    lanes,
    hands,
    held,
    cavity,
    rim,
    method,
    helping,
    elements,
    costs,
    w,
):
    """Seconds of the last element to end, and of all elements that were not spent waiting."""
    points, nodes, shared, state = unowned(points), unowned(nodes), unowned(shared), unowned(state)
    sites, pool, cells, w = unowned_sites(sites), unowned(pool), unowned(cells), unowned(w)
    notes, lanes, hands = unowned(notes), unowned(lanes), unowned(hands)
    held, cavity, rim = unowned(held), unowned(cavity), unowned(rim)
    visit, node, test, queue, locks, wait, time_slice = costs
    threads = len(state)
    clock, since = np.zeros(elements), np.zeros(elements)
    running = np.full(elements, -1)
    ready = np.empty(threads + 1, np.int64)  # a ring
    head, tail = 0, 0
    for k in range(threads):
        # the specialised thread of the batch method, which is the last, comes first
        ready[tail] = threads - 1 - k
        tail += 1
    alive, busy, last, effort = threads, 0.0, 0.0, 0
    while alive > 0:
        effort = strive(shared, state, 0, effort, STEP)
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
                clock[e] += wait
                continue
        k = running[e]
        v, f, i, c = _counted(state, k)
        in_hand = state[k, INSERTED]
        did = _step(
            points, nodes, shared, state, sites,
            pool, notes, cells, lanes, hands, held, cavity, rim, method, helping, k, w,
        )  # fmt: skip
        v2, f2, i2, c2 = _counted(state, k)
        if did == FINISHED:
            alive -= 1
            running[e] = -1
            last = max(last, clock[e])
            continue
        spent = visit * (v2 - v) + node * 2 * (f2 - f) + test * (c2 - c)
        if method == CIRCUMCIRCLE:
            # the subdivision is counted with the end of the insertion
            spent += node * 3 * (i2 - in_hand)
        elif method == BATCH:
            spent += node * 3 * (i2 - in_hand) + (queue if did == CHANGED else 0.0)
        else:
            spent += node * 3 * (i2 - in_hand) + (locks if did == CHANGED and i2 == in_hand else 0.0)
        busy += spent
        if did == WAITING:
            spent += wait
            state[k, WAITS] += 1
        clock[e] += spent
        last = max(last, clock[e])
        if head != tail and (did == WAITING or clock[e] - since[e] > time_slice):
            ready[tail] = k
            tail = (tail + 1) % (threads + 1)
            running[e] = -1
    return last, busy


@cached_njit(nogil=True)
def _simulate_critical(points, nodes, shared, state, sites, elements, costs, w):
    """The pessimistic method, and with one element the sequential one: as long as an element is in the
    critical section, others that come to it wait; one thread on each element."""
    points, nodes, shared, state = unowned(points), unowned(nodes), unowned(shared), unowned(state)
    sites, w = unowned_sites(sites), unowned(w)
    visit, node, test, queue, locks, wait, time_slice = costs
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
        q = next_site(state, sites, e)
        if q < 0:
            ended[e] = True
            left -= 1
            last = max(last, clock[e])
            continue
        t, visited = locate(points, nodes, q, w)
        before = state[e, FLIPS]
        insert(points, nodes, shared, state, e, t, q, 0, w)
        change = node * (3 + 2 * (state[e, FLIPS] - before))
        state[e, INSERTED] += 1
        state[e, NEXT] += 1
        entered = clock[e] + visit * visited
        if entered < free:
            state[e, WAITS] += 1
            entered = free + wait
        busy += visit * visited + change
        clock[e] = entered + change
        free = clock[e]
    return last, busy


def simulate(points: np.ndarray, options: Options, elements: int, costs: Costs) -> Simulation:
    """A run on ``elements`` processing elements, in virtual time.

    Parameters
    ----------
    points : float64 (n, 2)
    options : Options
        location="dag"; with the pessimistic method a thread for each element.
    elements : int
        1 to 64.
    costs : Costs

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
    method = _METHODS[options.method]
    if method in (SEQUENTIAL, PESSIMISTIC):
        options = replace(options, threads=elements if method == PESSIMISTIC else 1)
    store, sites = prepared(points, options)
    n = len(store.points)
    w = work_array(store.points)
    price = (costs.visit, costs.node, costs.test, costs.queue, costs.locks, costs.wait, costs.slice)
    common = (store.points, store.nodes, store.shared, store.state, sites)
    if method in (SEQUENTIAL, PESSIMISTIC):
        seconds, busy = _simulate_critical(*common, options.threads, price, w)
        elements = options.threads
    else:
        locking = method == OPTIMISTIC
        shape = (options.threads if locking else 1, 4 * n + 64 if locking else 1)
        scratch = (
            np.empty(shape, np.int32),
            np.empty(shape, np.int32),
            np.empty((shape[0], 3 * shape[1]), np.int32),
        )
        tools = (
            empty_pool(options.threads),
            empty_notes(options.threads),
            empty_queue(max(2, options.queue_length)),
            empty_lanes(options.threads),
            empty_hands(options.threads),
        )
        seconds, busy = _simulate(*common, *tools, *scratch, method, options.helping, elements, price, w)
    s = store.state.sum(axis=0)
    leaves = int((store.nodes[:, CHILD] < 0).sum())
    return Simulation(
        seconds=float(seconds),
        busy=float(busy / (seconds * elements)),
        waits=int(s[WAITS]),
        retries=int(s[RETRIES]),
        exceptions=int(s[EXCEPTIONS]),
        given_up=int(s[GIVEN_UP]),
        tests=int(s[TESTS]),
        triangles=leaves,
    )
