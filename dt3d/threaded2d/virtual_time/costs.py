"""What the operations of virtual time cost: measured on the points in question, or of the usual size."""

from __future__ import annotations

import time
from typing import NamedTuple

import numpy as np

from ..._numba.kernel_cache import cached_njit
from ..._numba.unowned import unowned
from ...ordering.along_curve import along_curve_in_plane
from .. import columns as c
from .. import sequential
from ..circumcircle import with_head_start
from ..columns import triangle
from ..configuration import Options
from ..first import first_triangle
from ..input_subdivision import insertion_order
from ..lookahead import alone
from ..mesh import Store
from ..pool import touches
from ..steps import now
from ..work_sharing import Schedule, share

# Not measured, but of the usual size on today's processors: seconds.
QUEUE = 50e-9  # elements put or taken together: a cache line from another core, a compare-and-swap
LOCKS = 150e-9  # some ten locks taken and given back
YIELD = 500e-9  # a look whether the wait is over, and giving way
SLICE = 1e-3  # how long a thread keeps its element when others want it

SAMPLE = 64  # triangles whose circum-circle tests are timed: as few as are at hand in an insertion
ROUNDS = 200


class Costs(NamedTuple):
    """Seconds of the operations.

    Attributes
    ----------
    visit : float
        A node on the way of a location.
    node : float
        A node made by subdivision (three) or a flip (two), with the tests that led to it.
    test : float
        A circum-circle test of the pool.
    queue, get, locks, wait : float
        Elements put into the queue together; those taken from it; the locks of an insertion; a look whether a
        wait is over.
    slice : float
        How long a thread keeps its element when others want it.
    """

    visit: float
    node: float
    test: float
    queue: float = QUEUE
    get: float = QUEUE
    locks: float = LOCKS
    wait: float = YIELD
    slice: float = SLICE


def prepared(points: np.ndarray, options: Options) -> tuple[Store, Schedule]:
    """The store of a run, with room for all it may need, and its sites."""
    site, _ = along_curve_in_plane(points)
    if options.order == "random":
        site = np.sort(site)
    rows = np.take(points, site, axis=0)
    first, order, bounds = first_triangle(rows, *insertion_order(rows, options))
    order, bounds = with_head_start(order, bounds, options)
    store = Store(rows, first, options.threads, 24 * len(rows) + 4096 * options.threads)
    return store, share(order, bounds, fixed=options.fixed_parts)


@cached_njit(nogil=True)
def _tests(mesh, leaves, sites, rounds):
    """Test leaves and their neighbours against sites far away, as the pool's are; how many tests touched."""
    mesh = unowned(mesh)
    touched = 0
    for i in range(rounds):
        q = sites[i % len(sites)]
        for x in range(len(leaves)):
            t = leaves[x]
            touched += touches(mesh, t, q)
            for k in range(3):
                touched += touches(mesh, triangle(mesh.nodes[t, c.NEIGHBOR + k]), q)
    return touched


def measure(points: np.ndarray, order: str = "random", repeats: int = 3, interleave: int = 1) -> Costs:
    """The costs of these points, float64 (n, 2), by the median of sequential runs.

    With so many searches interleaved a node on the way of a location costs less, as searches wait for memory
    together.
    """
    options = Options(method="sequential", order=order, interleave=interleave)
    way = alone if interleave > 1 else sequential
    rng = np.random.default_rng(0)
    found = []
    for _ in range(repeats):
        store, schedule = prepared(points, options)
        mesh, tools = store.mesh(), way.tools(store, schedule, options)
        ticks, clock = now(), time.perf_counter()
        way.METHOD.run(mesh, 0, tools)
        per_cycle = (time.perf_counter() - clock) / (now() - ticks)
        counts = store.state[0]
        visit = counts[c.LOCATION_CYCLES] * per_cycle / max(1, counts[c.VISITED])
        node = counts[c.CHANGE_CYCLES] * per_cycle / (3 * max(1, counts[c.INSERTED]) + 2 * counts[c.FLIPS])

        leaves = rng.choice(np.flatnonzero(store.nodes[: store.used, c.CHILD] < 0), SAMPLE)
        others = rng.integers(0, len(store.points), SAMPLE)
        _tests(mesh, leaves, others, 1)
        clock = time.perf_counter()
        _tests(mesh, leaves, others, ROUNDS)
        test = (time.perf_counter() - clock) / (4 * SAMPLE * ROUNDS)
        found.append((visit, node, test))
    return Costs(*(float(x) for x in np.median(np.array(found), axis=0)))
