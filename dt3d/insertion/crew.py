"""Threads that insert at the same time, and what happens when one of them stops.

The functions compiled by numba release the interpreter's lock, so these are real threads. They return to
Python after every stretch of sites, where they see whether to go on; the thread that called runs the
callback and gets the interrupts.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait

import numpy as np

from .._errors import InternalError
from .kernel import (
    CREATED,
    DEFERRED,
    ENDLESS_WALK,
    FAULTS,
    FREE_COUNT,
    LAST,
    LENGTH,
    LOW,
    NEEDS_SCRATCH,
    NEEDS_SLOTS,
    NEXT,
    STOP,
    TESTED,
    WALKED,
    insert,
)  # fmt: skip
from .layout import INFINITE
from .store import Store, Worker
from .walk import locate

STRETCH = 2048  # sites that a thread inserts before it looks whether to go on; some milliseconds
LEAST_PIECE = 1500  # sites of a round that are worth a thread
PASSES = 2  # with threads, over what others deferred; one thread does the rest
PIECE = 1 << 15  # rows of an array that are worth a task
# doublings of the memory for one site, whose star has fewer tetrahedra than twice the number of sites; there
# is memory for as many from the beginning
MOST_GROWTHS = 3
MARGIN = 8  # facets that have room in the scratch memory, but are not used
PATIENCE = 0.05  # seconds between two looks at the progress


class Crew:
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

    def __enter__(self) -> Crew:
        return self

    def __exit__(self, *error: object) -> None:
        self.stopped = True
        if self.pool is not None:
            self.pool.shutdown()

    def in_pieces(self, work: Callable[[int, int], object], n: int) -> None:
        """Call ``work(begin, end)`` for all of range(n), by all threads if it is long."""
        if self.pool is None or n < 2 * PIECE:
            work(0, n)
            return
        for task in [self.pool.submit(work, i, min(i + PIECE, n)) for i in range(0, n, PIECE)]:
            task.result()

    def begin(self, rows: np.ndarray, box: np.ndarray, store: Store, inserted: int) -> None:
        """Get to work on a store that has some sites already; ``box``: the corners of the box of all,
        (2, 3)."""
        self.rows = rows
        self.points = rows.reshape(-1, 4)[:, :3]  # without the labels, which are no coordinates
        self.labels = rows.view(np.uint32)
        # what underflow can do to a determinant; nothing is known of coordinates that are not scaled
        scaled = np.abs(box).max() <= 1
        self.slack, self.reach = (2.0**-1000, 1.0) if scaled else (np.inf, np.inf)
        self.store = store
        self.n = len(self.points)
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
            pieces = min(self.threads, len(pending) // LEAST_PIECE)
            if pieces < 2:
                break
            pending = self._insert_together(pending, pieces, turn)
            self.inserted = done - len(pending)
            self.deferred += len(pending)
        worker = self.workers[0]
        growths = 0
        while len(pending):
            before = len(pending)
            worker.claim(pending, 0, self.n)
            self._insert(worker, lambda: self.report(self._count([worker]), self.slots()))
            if worker.state[DEFERRED]:
                # it owns all sites, and more memory would not help
                msg = f"a thread that is alone defers {worker.state[DEFERRED]} sites to others"
                raise InternalError(msg)
            pending = worker.left()
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
        start = int(self.workers[0].state[LAST])
        workers = self.workers[:pieces]
        for i, worker in enumerate(workers):
            todo = pending[bounds[i] : bounds[i + 1]].copy()
            worker.claim(todo, lows[i], (lows[(i + 1) % pieces] - lows[i]) % self.n)
            start = self._start_within(worker, start)
        assert self.pool is not None
        tasks = [self.pool.submit(self._insert, worker) for worker in workers]
        self._watch(tasks, workers)
        left = [worker.left() for worker in workers]
        if any(worker.short for worker in workers):
            self.store.grow()
        return np.sort(np.concatenate(left))

    def _start_within(self, worker: Worker, start: int) -> int:
        """Let a worker begin at a tetrahedron that it may read, if a few sites have one; where the walk
        ended."""
        low, length = int(worker.state[LOW]), int(worker.state[LENGTH])
        for part in (2, 4, 8):
            site = int(worker.todo[len(worker.todo) // part])
            start = locate(self.points, self.rows, self.store.mesh, start, site, self.slack, worker.work)
            if start < 0:
                raise InternalError(FAULTS[ENDLESS_WALK])
            corners = self.store.mesh[8 * start : 8 * start + 4].astype(np.int64)
            if ((corners != INFINITE) & ((corners - low) % self.n < length)).any():
                break
        worker.state[LAST] = start
        return start

    def _watch(self, tasks: list[Future[None]], workers: list[Worker]) -> None:
        """Wait for the threads; what one of them or the report raises stops the others."""
        try:
            running = set(tasks)
            while running:
                ended, running = wait(running, PATIENCE)
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
        mesh, spheres, radii = store.mesh, store.spheres, store.radii
        while state[NEXT] < len(worker.todo) and not self.stopped:
            state[STOP] = min(int(state[NEXT]) + STRETCH, len(worker.todo))
            short = insert(
                self.points,
                self.rows,
                self.labels,
                mesh,
                spheres,
                radii,
                worker.todo,
                state,
                worker.scratch,
                self.slack,
                self.reach,
                worker.work,
            )
            if short in FAULTS:
                raise InternalError(FAULTS[short])
            if short == NEEDS_SCRATCH:
                if worker.facets > 4 * store.capacity + MARGIN:
                    msg = f"a cavity has more facets than the {store.capacity} tetrahedra"
                    raise InternalError(msg)
                worker.allocate(4 * worker.facets)
            elif short == NEEDS_SLOTS and not worker.take_slots(store):
                worker.short = True
                break
            if after_stretch is not None:
                after_stretch()

    def _count(self, workers: list[Worker]) -> int:
        return self.inserted + sum(int(w.state[NEXT] - w.state[DEFERRED]) for w in workers)

    def slots(self) -> int:
        """How many hold tetrahedra, ghosts included."""
        return self.store.used - sum(int(w.state[FREE_COUNT]) + w.fresh for w in self.workers)

    def counts(self) -> tuple[int, int, int]:
        """Tetrahedra walked through, tested and created, by all threads."""
        total = np.sum([w.state for w in self.workers], axis=0)
        return int(total[WALKED]), int(total[TESTED]), int(total[CREATED])
