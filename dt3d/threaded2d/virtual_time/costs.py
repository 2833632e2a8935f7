"""What the operations of virtual time cost: measured on the points in question, or of the usual size."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from ..._numba.kernel_cache import cached_njit
from ..._numba.unowned import unowned
from ...predicates import work_array
from .. import sequential
from ..configuration import Options
from ..first import first_triangle
from ..input_subdivision import insertion_order
from ..mesh import (
    CHANGE_CYCLES,
    CHILD,
    FLIPS,
    INSERTED,
    LOCATION_CYCLES,
    NEIGHBOR,
    USED,
    VISITED,
    Store,
)
from ..order import along_curve
from ..pool import touches
from ..steps import now
from ..work_sharing import Sites, share

# Not measured, but of the usual size on today's processors: seconds.
QUEUE = 50e-9  # elements put or taken together: a cache line from another core, a compare-and-swap
LOCKS = 150e-9  # some ten locks taken and given back
YIELD = 500e-9  # a look whether the wait is over, and giving way
SLICE = 1e-3  # how long a thread keeps its element when others want it

SAMPLE = 64  # triangles whose circum-circle tests are timed: as few as are at hand in an insertion
ROUNDS = 200


@dataclass(frozen=True)
class Costs:
    """Seconds of the operations.

    Attributes
    ----------
    visit : float
        A node on the way of a location.
    node : float
        A node made by subdivision (three) or a flip (two), with the tests that led to it.
    test : float
        A circum-circle test of the pool.
    queue, locks, wait : float
        Elements put or taken together; the locks of an insertion; a look whether a wait is over.
    slice : float
        How long a thread keeps its element when others want it.
    """

    visit: float
    node: float
    test: float
    queue: float = QUEUE
    locks: float = LOCKS
    wait: float = YIELD
    slice: float = SLICE


def prepared(points: np.ndarray, options: Options) -> tuple[Store, Sites]:
    """The store of a run, with room for all it may need, and its sites."""
    site, _ = along_curve(points)
    if options.order == "random":
        site = np.sort(site)
    rows = np.take(points, site, axis=0)
    order, bounds = insertion_order(rows, options.order, options.subdivision, options.parts, options.seed)
    first, order, bounds = first_triangle(rows, order, bounds)
    store = Store(rows, first, options.threads, 24 * len(rows) + 4096 * options.threads)
    return store, share(order, bounds)


@cached_njit(nogil=True)
def _tests(points, nodes, leaves, sites, rounds, w):
    """Test leaves and their neighbours against sites far away, as the pool's are; how many tests touched."""
    points, nodes, w = unowned(points), unowned(nodes), unowned(w)
    touched = 0
    for i in range(rounds):
        q = sites[i % len(sites)]
        for x in range(len(leaves)):
            t = leaves[x]
            touched += touches(points, nodes, t, q, w)
            for k in range(3):
                touched += touches(points, nodes, nodes[t, NEIGHBOR + k] >> 2, q, w)
    return touched


def measure(points: np.ndarray, order: str = "random", repeats: int = 3) -> Costs:
    """The costs of these points, float64 (n, 2), by the median of sequential runs."""
    options = Options(method="sequential", order=order)
    rng = np.random.default_rng(0)
    found = []
    for _ in range(repeats):
        store, sites = prepared(points, options)
        w = work_array(store.points)
        ticks, clock = now(), time.perf_counter()
        sequential.run(store.points, store.nodes, store.shared, store.state, sites, 0, False, w)
        per_cycle = (time.perf_counter() - clock) / (now() - ticks)
        counts = store.state[0]
        visit = counts[LOCATION_CYCLES] * per_cycle / max(1, counts[VISITED])
        node = counts[CHANGE_CYCLES] * per_cycle / (3 * max(1, counts[INSERTED]) + 2 * counts[FLIPS])

        used = int(store.shared[USED, 0])
        leaves = rng.choice(np.flatnonzero(store.nodes[:used, CHILD] < 0), SAMPLE)
        others = rng.integers(0, len(store.points), SAMPLE)
        _tests(store.points, store.nodes, leaves, others, 1, w)
        clock = time.perf_counter()
        _tests(store.points, store.nodes, leaves, others, ROUNDS, w)
        test = (time.perf_counter() - clock) / (4 * SAMPLE * ROUNDS)
        found.append((visit, node, test))
    return Costs(*(float(x) for x in np.median(np.array(found), axis=0)))
