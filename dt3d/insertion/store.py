"""The memory of a growing triangulation, and how it grows; `mesh` says what is where."""

from __future__ import annotations

import threading

import numpy as np
import numpy.typing as npt

from .._memory import require
from .mesh import INFINITE, MOST_SLOTS, Mesh, aligned, bundle, neighbors, squared_radii, vertices

LARGEST_BLOCK = 1 << 14  # slots that a thread takes at a time
BYTES_PER_SLOT = 64
SLOTS_PER_CHECK = 1 << 20  # slots that are taken between two looks at the memory there is


class Store:
    """The sites and the tetrahedra of some of them, at first one tetrahedron and the four ghosts around it.

    Memory that has never been written is not resident, so slots may be plenty.

    Parameters
    ----------
    sites : float64 (4 n,)
        In memory as `mesh` has it.
    first : int (4,)
        The sites of the first tetrahedron, which is positive.
    slots : int
        Room for so many tetrahedra.
    block : int
        Slots that a thread takes at a time.
    assured : int
        Slots for which a look at the memory there is has been taken.
    """

    def __init__(
        self,
        sites: npt.NDArray[np.float64],
        first: npt.NDArray[np.int32],
        slots: int,
        block: int,
        assured: int = 0,
    ) -> None:
        if slots > MOST_SLOTS:
            raise ValueError(_too_many(slots))
        self.assured = assured
        self.sites = sites
        self._room = sites  # its first words are ``sites``
        self._mesh: Mesh | None = None
        self.tetrahedra = aligned(8 * slots, np.uint32)
        self.spheres = aligned(4 * slots, np.float64)
        self.capacity = slots
        self.used = 5
        self.block = block
        self.lock = threading.Lock()
        _begin(self.mesh, first)

    @property
    def mesh(self) -> Mesh:
        """The arrays as they are now; rows of sites to come are among them."""
        if self._mesh is None:
            self._mesh = bundle(self._room, self.tetrahedra, self.spheres)
        return self._mesh

    def take_block(self) -> tuple[int, int]:
        """A block of slots for one thread: begin and end, equal where memory ran out."""
        with self.lock:
            begin = self.used
            if begin >= self.assured:
                # resident only when it is written, which is now; address space it has
                end = min(begin + SLOTS_PER_CHECK, self.capacity)
                what = f"a triangulation of more than {begin} tetrahedra"
                require(what, BYTES_PER_SLOT * (end - begin), reserved=0)
                self.assured = end
            self.used = min(begin + self.block, self.capacity)
            return begin, self.used

    def add_sites(self, rows: npt.NDArray[np.float64]) -> int:
        """Put rows of sites, float64 (4 k,), after those that are there; returns the number of the first.

        Twice the memory where it is not enough, so that a site is copied twice on average.
        """
        begin, end = len(self.sites), len(self.sites) + len(rows)
        if end > len(self._room):
            self.reserve(max(2 * begin, end) // 4)
        self._room[begin:end] = rows
        self.sites = self._room[:end]
        return begin // 4

    def reserve(self, sites: int) -> None:
        """Room for so many sites; memory that is not written yet is not resident."""
        n = len(self.sites)
        self._room = longer(self._room, n, 4 * sites)
        self.sites = self._room[:n]
        self._mesh = None

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
            BYTES_PER_SLOT // 2 * self.used + BYTES_PER_SLOT * self.block,
            BYTES_PER_SLOT // 2 * (2 * capacity - self.capacity),
        )
        self.capacity = capacity
        self._mesh = None
        self.tetrahedra = longer(self.tetrahedra, 8 * self.used, 8 * capacity)
        self.spheres = longer(self.spheres, 4 * self.used, 4 * capacity)


def longer(array: np.ndarray, used: int, size: int) -> np.ndarray:
    """An array of so many words that begins with the words of one that are used."""
    made = aligned(size, array.dtype)
    made[:used] = array[:used]
    return made


def _begin(mesh: Mesh, first: npt.NDArray[np.int32]) -> None:
    """Write a positive tetrahedron into slot 0, and the ghost beyond its k-th facet into slot 1 + k."""
    vertices(mesh)[:5] = np.append(first, INFINITE)[_FIRST_CORNERS]
    neighbors(mesh)[:5] = _FIRST_NEIGHBORS
    squared_radii(mesh)[:5] = -1, np.inf


def _first_five() -> tuple[npt.NDArray[np.int64], npt.NDArray[np.uint32]]:
    """What the first slots have: which of the four sites, 4 for the infinite one; and which neighbours."""
    corners = np.tile(np.arange(4), (5, 1))
    across = np.empty((5, 4), np.uint32)
    for k in range(4):
        corners[1 + k, k] = 4
        # beyond the facet orientation is reversed, so two of its vertices change places
        i, j = (k + 1) % 4, (k + 2) % 4
        corners[1 + k, [i, j]] = corners[1 + k, [j, i]]
    facets: dict[frozenset[int], list[tuple[int, int]]] = {}
    for t in range(5):
        for k in range(4):
            facets.setdefault(frozenset(np.delete(corners[t], k).tolist()), []).append((t, k))
    for (t, k), (u, j) in facets.values():
        across[t, k], across[u, j] = 4 * u + j, 4 * t + k
    return corners, across


_FIRST_CORNERS, _FIRST_NEIGHBORS = _first_five()


def _too_many(slots: int) -> str:
    return (
        f"{slots} tetrahedra or more are needed, and 32-bit numbers name at most {MOST_SLOTS} = 2^30; "
        f"triangulate fewer sites at a time"
    )
