"""The memory of a growing triangulation, and what each thread has of it."""

from __future__ import annotations

import threading

import numpy as np

from .._memory import require
from ..predicates import work_array
from .kernel import DEFERRED, FREE, FREE_COUNT, FRESH, FRESH_END, LENGTH, LOW, NEXT, SITES, STATE
from .layout import DEAD, INFINITE, MOST_SLOTS, aligned
from .star import NARROW

LARGEST_BLOCK = 1 << 14  # slots that a thread takes at a time
SLOT = 64  # bytes
CHECKED = 1 << 20  # slots that are taken between two looks at the memory there is
SCRATCH = 1 << 10  # facets of a cavity; grown where it is not enough


class Store:
    """The tetrahedra, begun with one and the four ghosts around it; `layout` says what is where.

    Memory that has never been written is not resident, so slots may be plenty.
    """

    def __init__(self, first: np.ndarray, slots: int, block: int, assured: int = 0) -> None:
        """Room for a number of slots, of which so many have been ``assured`` by a look at the memory there
        is."""
        if slots > MOST_SLOTS:
            raise ValueError(_too_many(slots))
        self.assured = assured
        self.mesh = aligned(8 * slots, np.uint32)
        self.spheres = aligned(4 * slots, np.float64)
        self.capacity = slots
        self.used = 5
        self.block = block
        self.lock = threading.Lock()
        mesh, radii = self.mesh.reshape(-1, 8), self.radii.reshape(-1, 8)
        mesh[:5, :4] = first
        for k in range(4):
            mesh[1 + k, k] = INFINITE
            # beyond the facet orientation is reversed, so two of its vertices change places
            i, j = (k + 1) % 4, (k + 2) % 4
            mesh[1 + k, [i, j]] = mesh[1 + k, [j, i]]
        facets: dict[frozenset[int], list[tuple[int, int]]] = {}
        for t in range(5):
            for k in range(4):
                facets.setdefault(frozenset(np.delete(mesh[t, :4], k).tolist()), []).append((t, k))
        for (t, k), (u, j) in facets.values():
            mesh[t, 4 + k], mesh[u, 4 + j] = 4 * u + j, 4 * t + k
        radii[:5, 6], radii[:5, 7] = -1, np.inf

    @property
    def radii(self) -> np.ndarray:
        return self.spheres.view(np.float32)

    def take(self) -> tuple[int, int]:
        """A block of slots for one thread: begin and end, equal where memory ran out."""
        with self.lock:
            begin = self.used
            if begin >= self.assured:
                # resident only when it is written, which is now; address space it has
                end = min(begin + CHECKED, self.capacity)
                require(f"a triangulation of more than {begin} tetrahedra", SLOT * (end - begin), reserved=0)
                self.assured = end
            self.used = min(begin + self.block, self.capacity)
            return begin, self.used

    def grow(self) -> None:
        """Twice the memory, or as much as can be named, with what is there; for when no thread inserts.

        Raises
        ------
        ValueError
            If no more slots can be named by 32 bits.
        MemoryError
            If the system does not have it.
        """
        if self.capacity >= MOST_SLOTS:
            raise ValueError(_too_many(self.capacity + 1))
        capacity = min(2 * self.capacity, MOST_SLOTS)
        # one half is copied while the old one is there, then the other
        require(
            f"a triangulation of more than {self.capacity} tetrahedra",
            SLOT // 2 * self.used + SLOT * self.block,
            SLOT // 2 * (2 * capacity - self.capacity),
        )
        self.capacity = capacity
        for name, width, dtype in (("mesh", 8, np.uint32), ("spheres", 4, np.float64)):
            old, new = getattr(self, name), aligned(width * self.capacity, dtype)
            new[: width * self.used] = old[: width * self.used]
            setattr(self, name, new)


def _too_many(slots: int) -> str:
    return (
        f"{slots} tetrahedra or more are needed, and 32-bit numbers name at most {MOST_SLOTS} = 2^30; "
        f"triangulate fewer sites at a time"
    )


class Worker:
    """What one thread has for itself: its counts, its free slots, room for a cavity and for exact
    arithmetic."""

    def __init__(self, sites: int, box: np.ndarray) -> None:
        self.state = np.zeros(STATE, np.int64)
        self.state[SITES] = self.state[LENGTH] = sites
        self.work = work_array(box)  # which knows the greatest coordinate
        self.todo = np.empty(0, np.uint32)
        self.short = False  # of memory
        self.allocate(SCRATCH)

    def allocate(self, facets: int) -> None:
        """Room for a cavity with that many facets; as many tetrahedra; and half as many vertices."""
        self.facets = facets
        near = np.empty(facets, np.uint32)
        near[0] = INFINITE
        relative = np.empty((4, facets))
        relative[:, 0] = np.nan  # the vertex at infinity
        self.scratch = (
            np.empty(facets, np.uint32),  # cavity
            np.empty((4, facets), np.uint32),  # rim
            np.empty(facets, np.uint32),  # outer
            near,
            np.empty(facets, np.uint32),  # a facet of each
            relative,
            np.empty(1 << 2 * NARROW, np.uint32),  # edges
            np.empty(16 * facets, np.int64),  # keys
            np.empty(16 * facets, np.uint32),  # values
        )

    def claim(self, todo: np.ndarray, low: int, length: int) -> None:
        """Get sites to insert, and a piece of the curve to own."""
        self.todo, self.short = todo, False
        self.state[LOW], self.state[LENGTH] = low, length
        self.state[NEXT] = self.state[DEFERRED] = 0

    def left(self) -> np.ndarray:
        """What was deferred or not reached."""
        return np.concatenate([self.todo[: self.state[DEFERRED]], self.todo[self.state[NEXT] :]])

    @property
    def fresh(self) -> int:
        return int(self.state[FRESH_END] - self.state[FRESH])

    def take_slots(self, store: Store) -> bool:
        """A new block; what was left of the last one is given up where it does not adjoin. Whether there
        was one."""
        begin, end = store.take()
        if begin == self.state[FRESH_END]:
            self.state[FRESH_END] = end
        else:
            self.abandon(store)
            self.state[FRESH], self.state[FRESH_END] = begin, end
        return end > begin

    def abandon(self, store: Store) -> None:
        """Put the fresh slots on the list of free ones."""
        for slot in range(int(self.state[FRESH]), int(self.state[FRESH_END])):
            store.mesh[8 * slot] = DEAD
            store.mesh[8 * slot + 4] = self.state[FREE]
            self.state[FREE] = slot
        self.state[FREE_COUNT] += self.state[FRESH_END] - self.state[FRESH]
        self.state[FRESH] = self.state[FRESH_END]
