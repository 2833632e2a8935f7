"""Exact insertion from beginning to end: order, first tetrahedron, rounds, compaction."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .._errors import DegenerateInputError
from .._memory import require, room_for_threads
from .._numba.cores import available_cores
from .compaction import count_finite, number_finite, write_finite
from .crew import LEAST_PIECE, Crew
from .first import first_tetrahedron
from .kernel import FRESH, FRESH_END
from .layout import DEAD, MOST_SLOTS, aligned
from .order import along_curve, bounds, copied, gather, insertion_rounds, separate_copies
from .store import LARGEST_BLOCK, SLOT, Store

# finite tetrahedra, ghosts and freed slots of a uniform set; grown where it is not enough
SLOTS_PER_SITE = 8
LEAST_SLOTS_PER_SITE = 5  # sites on a sphere have three tetrahedra and two ghosts each
ROWS = 64  # bytes: a site along the curve, and its places there and in the input
STRETCH = 100_000  # sites between two reports
SAMPLE = 1000  # sites among which the first tetrahedron is sought


@dataclass
class Outcome:
    """Vertices are indices of the rows of the sites that `triangulate` was given."""

    simplices: np.ndarray  # int32 (m, 4)
    neighbors: np.ndarray  # int32 (m, 4)
    duplicates: np.ndarray  # int32 (k, 2)
    walked: int
    tested: int
    created: int
    threads: int
    deferred: int
    seconds: dict[str, float]


def triangulate(
    sites: np.ndarray,
    seed: int = 0,
    threads: int | None = None,
    report: Callable[[int, int], None] | None = None,
) -> Outcome:
    """Triangulate sites, float64 (n, 3), exactly.

    ``report(left, slots)`` is called after every stretch of sites. Fast if they are scaled so that the
    greatest coordinate is about 1. There are at most as many threads as cores, since threads that never wait
    for each other gain nothing from taking turns; with ``threads`` of None also fewer where more do not pay.

    Raises
    ------
    DegenerateInputError
        If the sites span no volume.
    MemoryError
        If the system has no room for the threads or the tetrahedra.
    """
    most = max(1, len(sites) // (8 * LEAST_PIECE)) if threads is None else threads
    threads = min(most, available_cores())
    least, reserved = (ROWS + SLOT * slots for slots in (LEAST_SLOTS_PER_SITE, SLOTS_PER_SITE))
    require(f"the triangulation of {len(sites)} sites", least * len(sites), reserved * len(sites))
    n = 0
    reported = 0

    def each_stretch(inserted: int, slots: int) -> None:
        nonlocal reported
        if report is not None and (inserted // STRETCH > reported // STRETCH or inserted == n > reported):
            reported = inserted
            report(n - inserted, slots)

    seconds = {}
    with room_for_threads(), Crew(threads, each_stretch) as crew:
        begun = time.perf_counter()
        original, rows, duplicates = _in_order(sites, crew)
        n = len(original)
        first = _first(rows.reshape(n, 4)[:, :3])
        todo, ends = insertion_rounds(n, seed, first)
        seconds["order"] = time.perf_counter() - begun

        begun = time.perf_counter()
        block = min(LARGEST_BLOCK, 64 + n // threads)
        slots = min(SLOTS_PER_SITE * n + 64 + threads * block, MOST_SLOTS)
        store = Store(first, slots, block, LEAST_SLOTS_PER_SITE * n)
        crew.begin(rows, bounds(sites), store, len(first))
        begin = 0
        for end in ends:
            crew.insert_round(todo[begin:end])
            begin = end
        each_stretch(n, crew.slots())
        seconds["insertion"] = time.perf_counter() - begun

        begun = time.perf_counter()
        mesh = store.mesh.reshape(-1, 8)
        for worker in crew.workers:
            mesh[worker.state[FRESH] : worker.state[FRESH_END], 0] = DEAD
        simplices, neighbors = _compact(crew, store, original)
        seconds["compaction"] = time.perf_counter() - begun
        walked, tested, created = crew.counts()
    return Outcome(simplices, neighbors, duplicates, walked, tested, created, threads, crew.deferred, seconds)


def _in_order(sites: np.ndarray, crew: Crew) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Distinct sites along the curve: their indices int32 (n,), their rows float64 (4 n,); and the copies,
    int32 (k, 2)."""
    order = along_curve(sites, crew.in_pieces)
    original = order.astype(np.int32)
    rows = aligned(4 * len(order), np.float64)
    crew.in_pieces(lambda i, j: gather(sites, original, rows, i, j), len(order))
    found = []
    crew.in_pieces(lambda i, j: found.append(copied(rows, i, j)), len(order))
    if not any(found):
        return original, rows, np.empty((0, 2), np.int32)
    n, duplicates = separate_copies(sites, order)
    original, rows = order[:n].astype(np.int32), rows[: 4 * n]
    crew.in_pieces(lambda i, j: gather(sites, original, rows, i, j), n)
    return original, rows, duplicates


def _first(points: np.ndarray) -> np.ndarray:
    """The first tetrahedron, of a sample of the sites if that spans a volume."""
    step = len(points) // SAMPLE
    if step > 1:
        try:
            return first_tetrahedron(np.ascontiguousarray(points[::step]), 0) * step
        except DegenerateInputError:
            pass
    return first_tetrahedron(np.ascontiguousarray(points), 0)


def _compact(crew: Crew, store: Store, original: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Finite tetrahedra without gaps: simplices and neighbors, int32 (m, 4)."""
    mesh, slots = store.mesh, store.used
    require(f"the result of {slots} tetrahedra", 8 * slots)  # their numbers now, and their iterations later
    number = np.empty(slots, np.int32)
    pieces: dict[int, int] = {}

    def count(begin: int, end: int) -> None:
        pieces[begin] = count_finite(mesh, begin, end)

    crew.in_pieces(count, slots)
    begins = sorted(pieces)
    total = np.cumsum([0] + [pieces[b] for b in begins])
    firsts = dict(zip(begins, total[:-1].tolist(), strict=True))
    m = int(total[-1])
    crew.in_pieces(lambda i, j: number_finite(mesh, i, j, firsts[i], number), slots)
    # the spheres have served; the result takes their memory, which is there and no less
    result = store.spheres.view(np.int32)[: 8 * m].reshape(2, m, 4)
    simplices, neighbors = result[0], result[1]
    crew.in_pieces(lambda i, j: write_finite(mesh, i, j, number, original, simplices, neighbors), slots)
    return simplices, neighbors
