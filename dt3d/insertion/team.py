"""Threads that insert at the same time, and what happens when one of them stops.

The functions compiled by numba release the interpreter's lock, so these are real threads. They return to
Python after every stretch of sites, where they see whether to go on; the thread that called runs the
callback and gets the interrupts.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait

import numpy as np

from .._errors import InternalError
from .insert import ENDLESS_WALK, FAULTS, NEEDS_SCRATCH, NEEDS_SLOTS, insert
from .layout import INFINITE, vertices
from .mesh import Store
from .walk import locate
from .worker import Scale, State, Worker, scratch_for

SITES_PER_CALL = 2048  # sites that a thread inserts before it looks whether to go on; some milliseconds
LEAST_SITES_PER_THREAD = 1500  # sites of a round that are worth a thread
PASSES = 2  # with threads, over what others deferred; one thread does the rest
ROWS_PER_TASK = 1 << 15  # rows of an array that are worth a task
# doublings of the memory for one site, whose star has fewer tetrahedra than twice the number of sites; there
# is memory for as many from the beginning
MOST_GROWTHS = 3
SPARE_FACETS = 8  # facets that have room in the scratch memory, but are not used
SECONDS_BETWEEN_LOOKS = 0.05  # seconds between two looks at the progress


def available_cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class Team:
    """Threads, each with a `Worker`, that insert into one `Store`.

    ``rows``: the sites, float64 (4 n,), see `layout`. ``report(inserted, slots)`` is called in between.
    """

    def __init__(self, threads: int, report: Callable[[int, int], None]) -> None:
        self.threads = threads
        self.report = report
        self.pool = ThreadPoolExecutor(threads, "dt3d") if threads > 1 else None
        self.stopped = False
        self.deferred = 0
        self.inserted = 0

    def __enter__(self) -> Team:
        return self

    def __exit__(self, *error: object) -> None:
        self.stopped = True
        if self.pool is not None:
            self.pool.shutdown()

    def in_pieces(self, work: Callable[[int, int], object], n: int) -> None:
        """Call ``work(begin, end)`` for all of range(n), by all threads if it is long."""
        if self.pool is None or n < 2 * ROWS_PER_TASK:
            work(0, n)
            return
        for task in [
            self.pool.submit(work, i, min(i + ROWS_PER_TASK, n)) for i in range(0, n, ROWS_PER_TASK)
        ]:
            task.result()

    def begin(self, box: np.ndarray, store: Store, inserted: int) -> None:
        """Get to work on a store that has some sites already; ``box``: the corners of the box of all,
        (2, 3)."""
        # what underflow can do to a determinant; nothing is known of coordinates that are not scaled
        scaled = np.abs(box).max() <= 1
        self.scale = Scale(2.0**-1000, 1.0) if scaled else Scale(np.inf, np.inf)
        self.store = store
        self.n = len(store.sites) // 4
        self.workers = [Worker(self.n, box) for _ in range(self.threads)]
        self.inserted = inserted

    def insert_round(self, pending: np.ndarray) -> None:
        """Insert sites, uint32, ascending.

        Raises what a thread or the report raises, with no thread left running.

        Raises
        ------
        InternalError
            If the tetrahedra are not what they must be; see `kernel.FAULTS`.
        """
        done = self.inserted + len(pending)
        for turn in range(PASSES):
            pieces = min(self.threads, len(pending) // LEAST_SITES_PER_THREAD)
            if pieces < 2:
                break
            pending = self._insert_together(pending, pieces, turn)
            self.inserted = done - len(pending)
            self.deferred += len(pending)
        worker = self.workers[0]
        growths = 0
        while len(pending):
            before = len(pending)
            worker.assign(pending, 0, self.n)
            self._insert(worker, lambda: self.report(self._count([worker]), self.slots()))
            if worker.state[State.DEFERRED]:
                # it owns all sites, and more memory would not help
                msg = f"a thread that is alone defers {worker.state[State.DEFERRED]} sites to others"
                raise InternalError(msg)
            pending = worker.left
            self.inserted = done - len(pending)
            growths = growths + 1 if len(pending) == before else 0
            if growths > MOST_GROWTHS:
                msg = f"{self.store.capacity} tetrahedra are no room for one more site of {self.n}"
                raise InternalError(msg)
            if len(pending):
                self.store.grow()

    def _insert_together(self, pending: np.ndarray, pieces: int, turn: int) -> np.ndarray:
        """What threads deferred, each of which had one piece of the curve; where it begins changes each
        turn."""
        first = len(pending) * turn // (2 * pieces)
        pending = np.roll(pending, -first)
        bounds = [len(pending) * i // pieces for i in range(pieces + 1)]
        lows = [int(pending[b]) for b in bounds[:-1]]
        if not turn:
            lows[0] = 0
        start = int(self.workers[0].state[State.LAST])
        workers = self.workers[:pieces]
        for i, worker in enumerate(workers):
            todo = pending[bounds[i] : bounds[i + 1]].copy()
            worker.assign(todo, lows[i], (lows[(i + 1) % pieces] - lows[i]) % self.n)
            start = self._start_within(worker, start)
        assert self.pool is not None
        tasks = [self.pool.submit(self._insert, worker) for worker in workers]
        self._watch(tasks, workers)
        left = [worker.left for worker in workers]
        if any(worker.out_of_slots for worker in workers):
            self.store.grow()
        return np.sort(np.concatenate(left))

    def _start_within(self, worker: Worker, start: int) -> int:
        """Let a worker begin at a tetrahedron that it may read, if a few sites have one; where the walk
        ended."""
        low, length = int(worker.state[State.FIRST]), int(worker.state[State.LENGTH])
        for part in (2, 4, 8):
            site = int(worker.todo[len(worker.todo) // part])
            start = locate(self.store.mesh, start, site, self.scale.slack, worker.work)
            if start < 0:
                raise InternalError(FAULTS[ENDLESS_WALK])
            corners = vertices(self.store.mesh)[start].astype(np.int64)
            if ((corners != INFINITE) & ((corners - low) % self.n < length)).any():
                break
        worker.state[State.LAST] = start
        return start

    def _watch(self, tasks: list[Future[None]], workers: list[Worker]) -> None:
        """Wait for the threads; what one of them or the report raises stops the others."""
        try:
            running = set(tasks)
            while running:
                ended, running = wait(running, SECONDS_BETWEEN_LOOKS)
                for task in ended:
                    task.result()
                if running:
                    self.report(self._count(workers), self.slots())
        except BaseException:
            self.stopped = True
            wait(tasks)
            raise

    def _insert(self, worker: Worker, after_stretch: Callable[[], None] | None = None) -> None:
        """Insert what the worker has to do, until it is done, told to stop, or out of memory."""
        state, store = worker.state, self.store
        mesh = store.mesh
        while state[State.NEXT] < len(worker.todo) and not self.stopped:
            state[State.STOP] = min(int(state[State.NEXT]) + SITES_PER_CALL, len(worker.todo))
            short = insert(mesh, worker.todo, state, worker.scratch, self.scale, worker.work)
            if short in FAULTS:
                raise InternalError(FAULTS[short])
            if short == NEEDS_SCRATCH:
                facets = len(worker.scratch.cavity)
                if facets > 4 * store.capacity + SPARE_FACETS:
                    msg = f"a cavity has more facets than the {store.capacity} tetrahedra"
                    raise InternalError(msg)
                worker.scratch = scratch_for(4 * facets)
            elif short == NEEDS_SLOTS and not worker.take_slots(store):
                worker.out_of_slots = True
                break
            if after_stretch is not None:
                after_stretch()

    def _count(self, workers: list[Worker]) -> int:
        return self.inserted + sum(w.inserted for w in workers)

    def slots(self) -> int:
        """How many hold tetrahedra, ghosts included."""
        return self.store.used - sum(w.unused for w in self.workers)

    def counts(self) -> tuple[int, int, int]:
        """Tetrahedra walked through, tested and created, by all threads."""
        total = np.sum([w.state for w in self.workers], axis=0)
        return int(total[State.WALKED]), int(total[State.TESTED]), int(total[State.CREATED])
