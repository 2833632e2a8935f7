"""Exact insertion from beginning to end: order, first tetrahedron, rounds, compaction."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
import numpy.typing as npt

from .._errors import DegenerateInputError
from .._first_tetrahedron import first_tetrahedron
from .._memory import require
from .._numba.cores import available_cores
from ..ordering.along_curve import along_curve_in_space, bounds, gather
from ..ordering.brio import insertion_rounds
from ..ordering.duplicates import copied, separate_copies
from .compaction import count_finite, number_finite, write_finite
from .first_call import insert_beside
from .mesh import MOST_SLOTS, aligned
from .store import BYTES_PER_SLOT, LARGEST_BLOCK, Store
from .team import LEAST_SITES_PER_THREAD, Team, in_chunks

# finite tetrahedra, ghosts and freed slots of a uniform set; grown where it is not enough
SLOTS_PER_SITE = 8
LEAST_SLOTS_PER_SITE = 5  # sites on a sphere have three tetrahedra and two ghosts each
BYTES_PER_SITE = 64  # bytes: a site along the curve, and its places there and in the input
SITES_PER_REPORT = 100_000  # sites between two reports
FIRST_SAMPLE = 1000  # sites among which the first tetrahedron is sought

Result = tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]  # simplices and neighbors, (m, 4)
Room = Callable[[int], Result]


@dataclass
class Outcome:
    """Vertices are indices of the rows of the sites that `triangulate` was given."""

    simplices: npt.NDArray[np.int32]  # (m, 4)
    neighbors: npt.NDArray[np.int32]  # (m, 4)
    duplicates: npt.NDArray[np.int32]  # (k, 2)
    walked: int
    tested: int
    created: int
    threads: int
    deferred: int
    seconds: dict[str, float]


@dataclass
class Inserted:
    """A triangulation in its store."""

    store: Store
    team: Team
    original: npt.NDArray[np.int32]  # (n,): the site of the input in each row of the store
    duplicates: npt.NDArray[np.int32]  # (k, 2)
    seconds: dict[str, float]


def triangulate(
    sites: npt.NDArray[np.float64],
    seed: int = 0,
    threads: int | None = None,
    report: Callable[[int, int], None] | None = None,
    room: Room | None = None,
) -> Outcome:
    """Triangulate sites, float64 (n, 3), exactly.

    ``report(left, slots)`` is called after every stretch of sites. Fast if they are scaled so that the
    greatest coordinate is about 1. There are at most as many threads as cores, since threads that never wait
    for each other gain nothing from taking turns; with ``threads`` of None also fewer where more do not pay.
    ``room(m)`` gives the two arrays, int32 (m, 4) in C order, that the result is written into, and may raise
    where there is none. By default they are in memory that has served the run.

    Raises
    ------
    DegenerateInputError
        If the sites span no volume.
    MemoryError
        If the system has no room for the threads or the tetrahedra.
    """
    run = inserted(sites, seed, threads, report)
    begun = time.perf_counter()
    team = run.team
    team.mark_fresh()
    simplices, neighbors = compact(run.store, run.original, len(team.workers), room)
    run.seconds["compaction"] = time.perf_counter() - begun
    return Outcome(simplices, neighbors, run.duplicates, **team.counts(), seconds=run.seconds)


def inserted(
    sites: npt.NDArray[np.float64],
    seed: int = 0,
    threads: int | None = None,
    report: Callable[[int, int], None] | None = None,
) -> Inserted:
    """The same up to the last site; the tetrahedra are in their store."""
    most = max(1, len(sites) // (8 * LEAST_SITES_PER_THREAD)) if threads is None else threads
    threads = min(most, available_cores())
    least, reserved = (
        BYTES_PER_SITE + BYTES_PER_SLOT * slots for slots in (LEAST_SLOTS_PER_SITE, SLOTS_PER_SITE)
    )
    require(f"the triangulation of {len(sites)} sites", least * len(sites), reserved * len(sites))
    wait_for_insert = insert_beside()
    seconds = {}
    begun = time.perf_counter()
    original, rows, duplicates = _in_order(sites, threads)
    n = len(original)
    first = _first(rows.reshape(n, 4)[:, :3])
    todo, ends = insertion_rounds(n, seed, first)
    seconds["order"] = time.perf_counter() - begun

    begun = time.perf_counter()
    block = min(LARGEST_BLOCK, 64 + n // threads)
    slots = min(SLOTS_PER_SITE * n + 64 + threads * block, MOST_SLOTS)
    store = Store(rows, first, slots, block, LEAST_SLOTS_PER_SITE * n)
    tell = _told(report, n)
    team = Team(threads, store, bounds(sites), tell)
    wait_for_insert()
    for begin, end in zip([0, *ends], ends, strict=False):
        team.insert_round(todo[begin:end])
    tell(n, team.slots)
    seconds["insertion"] = time.perf_counter() - begun
    return Inserted(store, team, original, duplicates, seconds)


def _told(report: Callable[[int, int], None] | None, n: int) -> Callable[[int, int], None]:
    """A function of the sites inserted and the slots that reports every `SITES_PER_REPORT` sites."""
    reported = 0

    def tell(inserted: int, slots: int) -> None:
        nonlocal reported
        due = inserted // SITES_PER_REPORT > reported // SITES_PER_REPORT or inserted == n > reported
        if report is not None and due:
            reported = inserted
            report(n - inserted, slots)

    return tell


def _in_order(
    sites: npt.NDArray[np.float64], threads: int
) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.float64], npt.NDArray[np.int32]]:
    """Distinct sites along the curve: their indices (n,) and rows (4 n,); and the copies (k, 2)."""
    by_all = partial(in_chunks, threads)
    order = along_curve_in_space(sites, by_all)
    original = order.astype(np.int32)
    rows = aligned(4 * len(order), np.float64)
    by_all(lambda i, j: gather(sites, original, rows, i, j), len(order))
    found: list[bool] = []
    by_all(lambda i, j: found.append(copied(rows, i, j)), len(order))
    if not any(found):
        return original, rows, np.empty((0, 2), np.int32)
    n, duplicates = separate_copies(sites, order)
    original, rows = order[:n].astype(np.int32), rows[: 4 * n]
    by_all(lambda i, j: gather(sites, original, rows, i, j), n)
    return original, rows, duplicates


def _first(points: npt.NDArray[np.float64]) -> npt.NDArray[np.int32]:
    """The first tetrahedron, of a sample of the sites if that spans a volume."""
    step = len(points) // FIRST_SAMPLE
    if step > 1:
        try:
            return first_tetrahedron(np.ascontiguousarray(points[::step]), 0) * step
        except DegenerateInputError:
            pass
    return first_tetrahedron(np.ascontiguousarray(points), 0)


def compact(
    store: Store,
    original: npt.NDArray[np.int32],
    threads: int,
    room: Room | None = None,
) -> Result:
    """Finite tetrahedra without gaps: simplices and neighbors, int32 (m, 4)."""
    mesh, slots = store.mesh, store.used
    require(f"the result of {slots} tetrahedra", 8 * slots)  # their numbers now, and their iterations later
    number = np.empty(slots, np.int32)
    counts: dict[int, int] = {}

    def count(begin: int, end: int) -> None:
        counts[begin] = count_finite(mesh, begin, end)

    in_chunks(threads, count, slots)
    begins = sorted(counts)
    total = np.cumsum([0] + [counts[b] for b in begins])
    firsts = dict(zip(begins, total[:-1].tolist(), strict=True))
    m = int(total[-1])
    in_chunks(threads, lambda i, j: number_finite(mesh, i, j, firsts[i], number), slots)
    if room is None:
        # the spheres have served; the result takes their memory, which is there and no less
        simplices, neighbors = store.spheres.view(np.int32)[: 8 * m].reshape(2, m, 4)
    else:
        simplices, neighbors = room(m)
    in_chunks(threads, lambda i, j: write_finite(mesh, i, j, number, original, simplices, neighbors), slots)
    return simplices, neighbors
