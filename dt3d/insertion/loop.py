"""Exact insertion from beginning to end: order, first tetrahedron, insertion in stretches, compaction."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..predicates import work_array
from .first import about_one, first_tetrahedron
from .kernel import CREATED, DONE, FREE, INFINITE, LAST, NEXT, SLOTS, TESTED, WALKED, compact, insert
from .order import insertion_order, morton_codes

SLOTS_PER_SITE = 8  # finite tetrahedra, ghosts and freed slots of a uniform set; grown where it is not enough
MOST_FACETS = 2**31 - 1  # facets are named by int32
STRETCH = 100_000  # sites between two reports


@dataclass
class Outcome:
    """Vertices are indices of the rows of the sites that `triangulate` was given."""

    simplices: np.ndarray  # int32 (m, 4)
    neighbors: np.ndarray  # int32 (m, 4)
    walked: int
    tested: int
    created: int
    seconds: dict[str, float]


def triangulate(
    sites: np.ndarray, seed: int = 0, report: Callable[[int, int], None] | None = None
) -> Outcome:
    """Triangulate distinct sites, float64 (n, 3), in lexicographic order; exactly.

    The order of the rows is that of the symbolic perturbation. ``report(inserted, slots)`` is called after
    every stretch of sites. Fast if they are scaled so that the greatest coordinate is about 1.

    Raises
    ------
    DegenerateInputError
        If the sites span no volume.
    """
    seconds = {}
    begun = time.perf_counter()
    # the curve needs differences that do not overflow; what they lose by rounding costs time at most
    along_curve = np.argsort(morton_codes(about_one(sites)), kind="stable")
    points = np.ascontiguousarray(sites[along_curve])
    rank = along_curve.astype(np.int64)
    n = len(points)
    order = insertion_order(n, seed)
    first = first_tetrahedron(points, int(order[0]))
    order = np.ascontiguousarray(order[~np.isin(order, first)])
    seconds["order"] = time.perf_counter() - begun

    begun = time.perf_counter()
    store = _Store(first, SLOTS_PER_SITE * n + 64)
    w = work_array(points)
    while store.state[NEXT] < len(order):
        stop = min(int(store.state[NEXT]) // STRETCH * STRETCH + STRETCH, len(order))
        if insert(points, rank, order, store.arrays, store.state, stop, w) != DONE:
            store.grow()
        elif report is not None:
            report(int(store.state[NEXT]) + len(first), int(store.state[SLOTS] - store.state[FREE]))
    seconds["insertion"] = time.perf_counter() - begun

    begun = time.perf_counter()
    simplices, neighbors = compact(store.arrays[0], store.arrays[1], store.state[SLOTS])
    simplices = along_curve.astype(np.int32)[simplices]
    seconds["compaction"] = time.perf_counter() - begun
    state = store.state
    return Outcome(simplices, neighbors, int(state[WALKED]), int(state[TESTED]), int(state[CREATED]), seconds)


class _Store:
    """The arrays of a growing triangulation, begun with one tetrahedron and the four ghosts around it."""

    def __init__(self, first: np.ndarray, slots: int) -> None:
        vertices = np.empty((slots, 4), np.int32)
        neighbors = np.empty((slots, 4), np.int32)
        vertices[0] = first
        for k in range(4):
            vertices[1 + k] = first
            vertices[1 + k, k] = INFINITE
            # beyond the facet orientation is reversed, so two of its vertices change places
            i, j = (k + 1) % 4, (k + 2) % 4
            vertices[1 + k, [i, j]] = vertices[1 + k, [j, i]]
        facets: dict[frozenset[int], list[tuple[int, int]]] = {}
        for t in range(5):
            for k in range(4):
                facets.setdefault(frozenset(np.delete(vertices[t], k).tolist()), []).append((t, k))
        for (t, k), (u, j) in facets.values():
            neighbors[t, k], neighbors[u, j] = 4 * u + j, 4 * t + k
        self.state = np.zeros(8, np.int64)
        self.state[SLOTS] = 5
        self.state[LAST] = 0
        self.arrays: tuple[np.ndarray, ...] = (
            vertices,
            neighbors,
            np.empty(slots, np.int32),  # free
            np.zeros(slots, np.int32),  # marks
            np.empty(4 * slots, np.int32),  # made
            np.empty(1 << 16, np.int32),  # cavity
            np.empty(1 << 17, np.int32),  # rim
        )

    def grow(self) -> None:
        """Twice the memory, with what is there."""
        if 8 * len(self.arrays[0]) > MOST_FACETS:
            msg = "the triangulation has more tetrahedra than 32-bit numbers can name"
            raise ValueError(msg)
        longer = []
        for array in self.arrays:
            new = np.zeros((2 * len(array), *array.shape[1:]), array.dtype)
            new[: len(array)] = array
            longer.append(new)
        self.arrays = tuple(longer)
