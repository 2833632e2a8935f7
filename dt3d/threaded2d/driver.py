"""From the options of the public class to tasks for threads, and from their counts to statistics."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._errors import InternalError
from .._memory import require
from .._numba.cores import available_cores
from .._numba.threads import run_threads
from ..predicates import work_array
from . import batch, circumcircle, optimistic, pessimistic, sequential, steps
from .compaction import compact
from .configuration import Options
from .correction import correct
from .first import first_triangle
from .illegal_edges import empty_notes, noted
from .in_place import star
from .input_subdivision import insertion_order
from .lookahead.interleaved import empty_lanes
from .lookahead.located import empty_hands
from .mesh import (
    ACCESSES,
    CHANGE_CYCLES,
    END,
    EXCEPTIONS,
    FLIPS,
    GIVEN_UP,
    INSERTED,
    LOCATION_CYCLES,
    NOTED,
    OPEN,
    QUEUE_FILL,
    RETRIES,
    ROOTS,
    STOP,
    STUMBLE,
    TESTS,
    USED,
    VISITED,
    WAIT_CYCLES,
    WAITS,
    Store,
)
from .order import along_curve
from .pool import empty_pool
from .queue import empty_queue
from .statistics import Statistics
from .work_sharing import TAKEN, Sites, ahead_of_all, share

# Bytes a site, as measured: what is written, and with what is only reserved.
WRITTEN_IN_PLACE, RESERVED_IN_PLACE = 190, 210
WRITTEN_WITH_HISTORY, RESERVED_WITH_HISTORY = 600, 800


@dataclass
class Outcome:
    """What a run found; vertices are rows of the points it was given."""

    triangles: np.ndarray  # int32 (m, 3)
    neighbors: np.ndarray  # int32 (m, 3)
    maker: np.ndarray  # int16 (m,)
    inserted_by: np.ndarray  # int16 (n,); -1 for duplicates
    duplicates: np.ndarray  # int32 (k, 2)
    stats: Statistics


def triangulate(points: np.ndarray, options: Options) -> Outcome:
    """Triangulate points, float64 (n, 2), in the range of the exact predicates.

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
    seconds = {}
    begun = time.perf_counter()
    # what never waits gains nothing from more threads than processors
    busy = min(options.threads, available_cores())
    site, duplicates = along_curve(points, busy)
    if options.order == "random":
        site = np.sort(site)
    rows = np.take(points, site, axis=0)
    order, bounds = insertion_order(
        rows,
        options.order,
        options.subdivision,
        options.parts,
        options.seed,
        apart=options.method != "batch",
    )
    first, order, bounds = first_triangle(rows, order, bounds)
    seconds["order"] = time.perf_counter() - begun

    begun = time.perf_counter()
    capacity = ROOTS + 2 * len(rows) if options.in_place else None
    store = Store(rows, first, options.threads, capacity)
    store.shared[STUMBLE, 0] = options.yield_every
    if options.method == "circumcircle" and options.threads > 1:
        order, bounds = ahead_of_all(order, bounds, circumcircle.ahead(len(order), options.threads))
    sites = share(order, bounds)
    run = Run(options, store, sites)
    ticks, clock = steps.now(), time.perf_counter()
    run.to_the_end()
    elapsed = time.perf_counter() - clock
    per_cycle = elapsed / max(1, steps.now() - ticks)
    seconds["insertion"] = time.perf_counter() - begun - run.correcting
    seconds["correction"] = run.correcting

    begun = time.perf_counter()
    inserted = int(store.state[:, INSERTED].sum())
    if inserted != len(order):
        msg = f"method {options.method!r} has inserted {inserted} of {len(order)} sites in the plane"
        raise InternalError(msg)
    used = capacity if capacity is not None else int(store.shared[USED, 0])
    triangles, neighbors, maker = compact(store.nodes, used, site, busy)
    inserted_by = np.full(len(points), -1, np.int16)
    inserted_by[site[first]] = 0
    inserted_by[site[order]] = sites.taker
    seconds["extraction"] = time.perf_counter() - begun
    stats = _statistics(run, seconds, per_cycle)
    return Outcome(triangles, neighbors, maker, inserted_by, duplicates, stats)


class Run:
    """The tasks of a run, called again after the structure has grown or swaps were corrected."""

    def __init__(self, options: Options, store: Store, sites: Sites) -> None:
        self.options, self.store, self.sites = options, store, sites
        self.cpu_seconds = [0.0] * options.threads
        self.corrected, self.correcting = 0, 0.0  # swaps, seconds
        self.cells = empty_queue(options.queue_length)
        self.lanes = empty_lanes(options.threads)
        self.hands = empty_hands(options.threads)
        self.pool = empty_pool(options.threads)
        self.notes = empty_notes(options.threads)
        # what lies in front of all parts is for the first thread
        self.alone = int(sites.parts[0, TAKEN])
        store.state[0, END] = self.alone
        sites.taker[: self.alone] = 0
        self.work = [work_array(store.points) for _ in range(options.threads)]
        longest = 4 * len(store.points) + 64  # only what is used gets memory
        locking = options.method == "optimistic" or options.in_place
        self.scratch = [
            tuple(np.empty(length if locking else 1, np.int32) for length in (longest, longest, 3 * longest))
            for _ in range(options.threads)
        ]

    def stop(self) -> None:
        self.store.shared[STOP, 0] = 1

    def to_the_end(self) -> None:
        """Run all threads until all sites are inserted.

        Each turn has inserted a site at least, or leaves room for half as many nodes again.
        """
        while True:
            results = run_threads([self._timed(k) for k in range(self.options.threads)], self.stop)
            if steps.FULL in results:
                self.store.grow()
            elif steps.OPEN_SWAPS in results:
                self.correct()
            else:
                return

    def _timed(self, k: int) -> Callable[[], Any]:
        """The task of thread k, its processor time added up."""
        task = self._task(k)

        def run() -> Any:
            begun = time.thread_time()
            try:
                return task()
            finally:
                self.cpu_seconds[k] += time.thread_time() - begun

        return run

    def _task(self, k: int) -> Callable[[], Any]:
        o, s = self.options, self.store
        common = (s.points, s.nodes, s.shared, s.state, self.sites, k)
        walking = o.location == "walk"
        if o.in_place:
            lock = k + 1 if o.threads > 1 else 0
            return lambda: star.run(*common, lock, self.scratch[k], self.work[k])
        if o.method == "sequential":
            return lambda: sequential.run(*common, walking, self.work[k])
        if o.method == "pessimistic":
            return lambda: pessimistic.run(*common, walking, self.work[k])
        if o.method == "optimistic":
            return lambda: optimistic.run(*common, self.scratch[k], self.work[k])
        if o.method == "circumcircle":
            tools = (self.pool, self.notes[k], self.lanes[k], self.hands[k])
            return lambda: circumcircle.run(*common, *tools, self.alone, walking, self.work[k])
        if k < o.threads - 1:
            mine = (self.cells, self.lanes[k], self.hands[k])
            return lambda: batch.run_searching(*common, *mine, walking, o.helping, self.work[k])
        return lambda: batch.run_specialised(*common[:4], k, self.cells, self.hands[k], walking, self.work[k])

    def correct(self) -> None:
        """Make up for swaps that were given up; no thread may be running."""
        begun = time.perf_counter()
        origins = noted(self.store, self.notes)
        self.corrected += correct(self.store, origins, self.work[0], self.stop)
        self.store.state[:, NOTED] = 0
        self.store.shared[OPEN, 0] = 0
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
        inserted=counts(INSERTED),
        visited=int(state[:, VISITED].sum()),
        flips=int(state[:, FLIPS].sum()),
        accesses=int(state[:, ACCESSES].sum()),
        tests=int(state[:, TESTS].sum()),
        waits=counts(WAITS),
        retries=counts(RETRIES),
        exceptions=int(state[:, EXCEPTIONS].sum()),
        given_up=int(state[:, GIVEN_UP].sum()),
        corrected=run.corrected,
        growths=store.growths,
        queue_fill=float(state[-1, QUEUE_FILL]) / max(1, int(state[-1, INSERTED])),
        seconds=seconds,
        cpu_seconds=tuple(run.cpu_seconds),
        location_seconds=times(LOCATION_CYCLES),
        change_seconds=times(CHANGE_CYCLES),
        wait_seconds=times(WAIT_CYCLES),
    )
