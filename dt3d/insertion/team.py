"""Threads that insert at the same time, the sites that each has, and those that are left for a later pass.

The functions compiled by numba release the interpreter's lock, so these are real threads. They return to
Python after some thousands of sites, where they see whether to go on; the thread that called runs the report
and gets the interrupts.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
import numpy.typing as npt

from .._errors import InternalError
from .._numba.threads import run_short_tasks, run_threads
from .insert import ENDLESS_WALK, FAULTS, NEEDS_SCRATCH, NEEDS_SLOTS, OCCUPIED, insert
from .mesh import FREE, INFINITE, vertices
from .store import Store
from .walk import locate
from .worker import Scale, State, Worker, scratch_for

SITES_PER_CALL = 2048  # sites that a thread inserts before it looks whether to go on; some milliseconds
LEAST_SITES_PER_THREAD = 1500  # sites of a round that are worth a thread
PASSES = 2  # with threads, over what others deferred; one thread does the rest
ROWS_PER_CHUNK = 1 << 15  # rows of an array that are worth handing to a thread
# doublings of the memory for one site, whose star has fewer tetrahedra than twice the number of sites; there
# is memory for as many from the beginning
MOST_GROWTHS = 3
SPARE_FACETS = 8  # facets that have room in the scratch memory, but are not used


def in_chunks(threads: int, work: Callable[[int, int], object], n: int) -> None:
    """Call ``work(begin, end)`` for all of range(n), by threads if it is long."""
    if threads == 1 or n < 2 * ROWS_PER_CHUNK:
        work(0, n)
        return
    begins = iter(range(0, n, ROWS_PER_CHUNK))

    def some() -> None:
        for begin in begins:
            work(begin, min(begin + ROWS_PER_CHUNK, n))

    run_short_tasks([some] * threads)


class Team:
    """Threads, each with a `Worker`, that insert into one `Store`.

    Parameters
    ----------
    threads : int
    store : Store
    box : float64 (2, 3)
        The corners of the box of all sites.
    report : function
        Called in between with the numbers of sites that are inserted and of slots that hold tetrahedra.
    """

    def __init__(
        self, threads: int, store: Store, box: npt.NDArray[np.float64], report: Callable[[int, int], None]
    ) -> None:
        # what underflow can do to a determinant; nothing is known of coordinates that are not scaled
        scaled = np.abs(box).max() <= 1
        self.scale = Scale(2.0**-1000, 1.0) if scaled else Scale(np.inf, np.inf)
        self.store = store
        self.report = report
        self.n = len(store.sites) // 4
        self.workers = [Worker(self.n, box) for _ in range(threads)]
        self.inserted = 4
        self.deferred = 0
        self.stopped = False
        self.equal: list[tuple[int, int]] | None = None  # where equal sites are no fault: those found

    def insert_round(self, pending: npt.NDArray[np.uint32]) -> None:
        """Insert sites, ascending; what a thread or the report raises is raised with no thread left running.

        Raises
        ------
        InternalError
            If the tetrahedra are not what they must be; see `insert.FAULTS`.
        """
        done = self.inserted + len(pending)
        for number in range(PASSES):
            parts = min(len(self.workers), len(pending) // LEAST_SITES_PER_THREAD)
            if parts < 2:
                break
            pending = self._insert_in_parts(pending, parts, number)
            self.inserted = done - len(pending)
            self.deferred += len(pending)
        self._insert_alone(pending, done, partial(self._report, self.workers[:1]))

    def insert_added(self, pending: npt.NDArray[np.uint32]) -> list[tuple[int, int]]:
        """Insert sites that were added to the store, by one thread, in the order in which they come.

        Returns pairs of those that are where another one is already, and that one.

        Raises
        ------
        InternalError
            As `insert_round` does.
        """
        self.n = len(self.store.sites) // 4
        self.workers[0].state[State.SITES] = self.n
        found: list[tuple[int, int]] = []
        self.equal = found
        self._insert_alone(pending, self.inserted + len(pending), None)
        self.inserted -= len(found)
        self.equal = None
        return found

    def _insert_alone(
        self, pending: npt.NDArray[np.uint32], done: int, after_call: Callable[[], None] | None
    ) -> None:
        """Insert sites by one thread; there are ``done`` of them then."""
        worker = self.workers[0]
        state = worker.state
        growths = 0
        while len(pending):
            before = len(pending)
            worker.assign(pending, 0, self.n)
            self._insert(worker, after_call)
            if state[State.DEFERRED]:
                # it owns all sites, and more memory would not help
                msg = f"a thread that is alone defers {state[State.DEFERRED]} sites to others"
                raise InternalError(msg)
            if state[State.NEXT] == before:  # all of them
                self.inserted = done
                return
            pending = worker.left
            self.inserted = done - len(pending)
            growths = growths + 1 if len(pending) == before else 0
            if growths > MOST_GROWTHS:
                msg = f"{self.store.capacity} tetrahedra are no room for one more site of {self.n}"
                raise InternalError(msg)
            if len(pending):
                self.store.grow()

    def _insert_in_parts(
        self, pending: npt.NDArray[np.uint32], parts: int, number: int
    ) -> npt.NDArray[np.uint32]:
        """The sites that are deferred in pass ``number``, in which each thread owns one part of the curve.

        In each pass the parts begin elsewhere.
        """
        pending = np.roll(pending, -(len(pending) * number // (2 * parts)))
        bounds = [len(pending) * i // parts for i in range(parts + 1)]
        firsts = [int(pending[b]) for b in bounds[:-1]]
        if not number:
            firsts[0] = 0
        start = int(self.workers[0].state[State.LAST])
        workers = self.workers[:parts]
        for i, worker in enumerate(workers):
            todo = pending[bounds[i] : bounds[i + 1]].copy()
            worker.assign(todo, firsts[i], (firsts[(i + 1) % parts] - firsts[i]) % self.n)
            start = self._start_within(worker, start)
        tasks = [partial(self._insert, worker) for worker in workers]
        run_threads(tasks, self._stop, watch=lambda: self._report(workers))
        if any(worker.out_of_slots for worker in workers):
            self.store.grow()
        return np.sort(np.concatenate([worker.left for worker in workers]))

    def _start_within(self, worker: Worker, start: int) -> int:
        """Choose where a worker begins, at a tetrahedron that it may read if one of a few sites has such.

        Each walk begins where the one before ended; returns where the last one did.
        """
        first, length = worker.state[State.FIRST], worker.state[State.LENGTH]
        for fraction in (2, 4, 8):
            site = int(worker.todo[len(worker.todo) // fraction])
            start = locate(self.store.mesh, start, site, self.scale.slack, worker.work)
            if start < 0:
                raise InternalError(FAULTS[ENDLESS_WALK])
            corners = vertices(self.store.mesh)[start].astype(np.int64)
            if ((corners != INFINITE) & ((corners - first) % self.n < length)).any():
                break
        worker.state[State.LAST] = start
        return start

    def _insert(self, worker: Worker, after_call: Callable[[], None] | None = None) -> None:
        """Insert what the worker has to do, until it is done, told to stop, or out of memory."""
        state, store, mesh = worker.state, self.store, self.store.mesh
        while state[State.NEXT] < len(worker.todo) and not self.stopped:
            state[State.STOP] = min(int(state[State.NEXT]) + SITES_PER_CALL, len(worker.todo))
            result = insert(mesh, worker.todo, state, worker.scratch, self.scale, worker.work)
            if result == OCCUPIED and self.equal is not None:
                site = int(worker.todo[state[State.NEXT]])
                self.equal.append((site, self._same_place(site, int(state[State.LAST]))))
                state[State.NEXT] += 1
                continue
            if result in FAULTS:
                raise InternalError(FAULTS[result])
            if result == NEEDS_SCRATCH:
                facets = len(worker.scratch.cavity)
                if facets > 4 * store.capacity + SPARE_FACETS:
                    msg = f"a cavity has more facets than the {store.capacity} tetrahedra"
                    raise InternalError(msg)
                worker.scratch = scratch_for(4 * facets)
            elif result == NEEDS_SLOTS and not worker.take_slots(store):
                worker.out_of_slots = True
                break
            if after_call is not None:
                after_call()

    def _same_place(self, site: int, t: int) -> int:
        """The vertex of tetrahedron t that is where a site is."""
        places = self.store.mesh.points
        corners = [int(v) for v in vertices(self.store.mesh)[t] if v != INFINITE]
        return next(v for v in corners if (places[v] == places[site]).all())

    def mark_fresh(self) -> None:
        """Mark slots that threads have taken and not used, for what goes over all slots."""
        for worker in self.workers:
            vertices(self.store.mesh)[worker.state[State.FRESH] : worker.state[State.FRESH_END], 0] = FREE

    def _stop(self) -> None:
        self.stopped = True

    def _report(self, workers: list[Worker]) -> None:
        self.report(self.inserted + sum(worker.inserted for worker in workers), self.slots)

    @property
    def slots(self) -> int:
        """How many hold tetrahedra, ghosts included."""
        return self.store.used - sum(worker.unused for worker in self.workers)

    def counts(self) -> dict[str, int]:
        """What the workers have counted, and how many there are."""
        states = np.array([worker.state for worker in self.workers]).sum(axis=0)
        return {
            "walked": int(states[State.WALKED]),
            "tested": int(states[State.TESTED]),
            "created": int(states[State.CREATED]),
            "threads": len(self.workers),
            "deferred": self.deferred,
        }
