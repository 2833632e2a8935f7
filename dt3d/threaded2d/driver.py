"""Algorithm 1 of Kohout et al. 2004 (section 3.2): the master thread shares the sites and starts the threads.

From what is to be run to tasks for threads, and from their counts to statistics.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .._errors import InternalError
from .._memory import require
from .._numba.cores import available_cores
from .._numba.threads import run_threads
from ..ordering.along_curve import along_curve_in_plane
from . import batch, circumcircle, optimistic, pessimistic, sequential, steps
from . import columns as c
from .compaction import Room, compact
from .configuration import Options
from .correction import correct
from .first import first_triangle
from .illegal_edges import marked
from .in_place import star
from .in_place.first_call import steps_beside
from .input_subdivision import insertion_order
from .lookahead import alone
from .mesh import ROOTS, Store
from .statistics import Statistics
from .work_sharing import Schedule, share

# Bytes per site, as measured: what is written, and with what is only reserved.
WRITTEN_IN_PLACE, RESERVED_IN_PLACE = 190, 210
WRITTEN_WITH_HISTORY, RESERVED_WITH_HISTORY = 600, 800

METHODS = {
    "sequential": sequential.METHOD,
    "batch": batch.METHOD,
    "circumcircle": circumcircle.METHOD,
    "pessimistic": pessimistic.METHOD,
    "optimistic": optimistic.METHOD,
}


def method_of(options: Options) -> steps.Method:
    """The method that the options name."""
    if options.in_place:
        return star.METHOD
    if options.method == "sequential" and options.searches > 1:
        return alone.METHOD
    return METHODS[options.method]


@dataclass
class Outcome:
    """What a run found; vertices are rows of the points it was given."""

    triangles: np.ndarray  # int32 (m, 3)
    neighbors: np.ndarray  # int32 (m, 3)
    thread: np.ndarray  # int16 (m,): the thread that made each
    inserted_by: np.ndarray  # int16 (n,); -1 for duplicates
    duplicates: np.ndarray  # int32 (k, 2)
    stats: Statistics


def triangulate(
    points: np.ndarray,
    options: Options,
    room: Room | None = None,
) -> Outcome:
    """Triangulate points, float64 (n, 2), in the range of the exact predicates.

    ``room`` gives the arrays for triangles and neighbours, see `compaction.compact`.

    Raises
    ------
    DegenerateInputError
        If they span no area.
    MemoryError
        If the system does not have the memory.
    """
    require(
        f"the triangulation of {len(points)} sites in the plane",
        len(points) * (WRITTEN_IN_PLACE if options.in_place else WRITTEN_WITH_HISTORY),
        len(points) * (RESERVED_IN_PLACE if options.in_place else RESERVED_WITH_HISTORY),
    )
    wait_for_steps = steps_beside() if options.in_place else None
    seconds = {}
    begun = time.perf_counter()
    # what never waits gains nothing from more threads than processors
    busy = min(options.threads, available_cores())
    site, duplicates = along_curve_in_plane(points, busy)
    if options.order == "random":
        site = np.sort(site)
    rows = np.take(points, site, axis=0)
    first, order, bounds = first_triangle(rows, *insertion_order(rows, options))
    seconds["order"] = time.perf_counter() - begun

    begun = time.perf_counter()
    capacity = ROOTS + 2 * len(rows) if options.in_place else None
    store = Store(rows, first, options.threads, capacity)
    store.shared[c.YIELD_EVERY, 0] = options.yield_every
    order, bounds = circumcircle.with_head_start(order, bounds, options)
    schedule = share(order, bounds, fixed=options.fixed_parts)
    run = Run(options, store, schedule)
    if wait_for_steps is not None:
        wait_for_steps()
    ticks, clock = steps.now(), time.perf_counter()
    run.to_the_end()
    elapsed = time.perf_counter() - clock
    per_cycle = elapsed / max(1, steps.now() - ticks)
    seconds["insertion"] = time.perf_counter() - begun - run.correcting
    seconds["correction"] = run.correcting

    begun = time.perf_counter()
    inserted = int(store.state[:, c.INSERTED].sum())
    if inserted != len(order):
        msg = f"method {options.method!r} has inserted {inserted} of {len(order)} sites in the plane"
        raise InternalError(msg)
    used = capacity if capacity is not None else store.used
    triangles, neighbors, thread = compact(store.nodes[:used], site, busy, room)
    inserted_by = np.full(len(points), -1, np.int16)
    inserted_by[site[first]] = 0
    inserted_by[site[order]] = schedule.taker
    seconds["extraction"] = time.perf_counter() - begun
    stats = _statistics(run, seconds, per_cycle)
    return Outcome(triangles, neighbors, thread, inserted_by, duplicates, stats)


class Run:
    """The tasks of a run, called again after the structure has grown or swaps were corrected."""

    def __init__(self, options: Options, store: Store, schedule: Schedule) -> None:
        self.options, self.store = options, store
        self.cpu_seconds = [0.0] * options.threads
        self.corrected, self.correcting = 0, 0.0  # swaps, seconds
        self.method = method_of(options)
        self.tools = self.method.tools(store, schedule, options)

    def to_the_end(self) -> None:
        """Run all threads until all sites are inserted.

        Each turn has inserted a site at least, or leaves room for half as many nodes again.
        """
        while True:
            results = run_threads([self.task(k) for k in range(self.options.threads)], self.store.stop)
            if steps.FULL in results:
                self.store.grow()
            elif steps.OPEN_SWAPS in results:
                self.correct()
            else:
                return

    def task(self, me: int) -> Callable[[], int]:
        """What thread ``me`` runs; its processor time is added up."""
        mesh = self.store.mesh(me)

        def task() -> int:
            begun = time.thread_time()
            try:
                return self.method.run(mesh, me, self.tools)
            finally:
                self.cpu_seconds[me] += time.thread_time() - begun

        return task

    def correct(self) -> None:
        """Make up for swaps that were given up; no thread may be running."""
        assert isinstance(self.tools, circumcircle.Tools)
        begun = time.perf_counter()
        self.corrected += correct(self.store, marked(self.store, self.tools.marks))
        self.store.state[:, c.MARKED] = 0
        self.correcting += time.perf_counter() - begun


def _statistics(run: Run, seconds: dict[str, float], per_cycle: float) -> Statistics:
    options, store = run.options, run.store
    state = store.state

    def counts(column: int) -> tuple[int, ...]:
        return tuple(int(x) for x in state[:, column])

    def times(column: int) -> tuple[float, ...]:
        return tuple(float(x) * per_cycle for x in state[:, column])

    return Statistics(
        method=options.method,
        order=options.order,
        location=options.location,
        subdivision=options.subdivision,
        threads=options.threads,
        queue_length=options.queue_length if options.method == "batch" else 0,
        inserted=counts(c.INSERTED),
        visited=int(state[:, c.VISITED].sum()),
        flips=int(state[:, c.FLIPS].sum()),
        accesses=int(state[:, c.ACCESSES].sum()),
        tests=int(state[:, c.TESTS].sum()),
        waits=counts(c.WAITS),
        retries=counts(c.RETRIES),
        exceptions=int(state[:, c.EXCEPTIONS].sum()),
        given_up=int(state[:, c.GIVEN_UP].sum()),
        corrected=run.corrected,
        growths=store.growths,
        queue_fill=float(state[-1, c.QUEUE_FILL]) / max(1, int(state[-1, c.INSERTED])),
        seconds=seconds,
        cpu_seconds=tuple(run.cpu_seconds),
        location_seconds=times(c.LOCATION_CYCLES),
        change_seconds=times(c.CHANGE_CYCLES),
        wait_seconds=times(c.WAIT_CYCLES),
        visited_by=counts(c.VISITED),
        interleave=options.searches,
        parts="fixed" if options.fixed_parts else "shared",
        queued="parent" if options.queue_parents else "leaf",
        tested="all" if options.test_all else "outer",
        helping=options.helping,
    )
