"""What a triangulation with ``incremental=True`` has beside its arrays: sites, and a store that goes on."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING

import numpy as np

from ._input import MOST_SITES
from ._stats import InsertionStatistics
from .predicates.workspace import scaled_by, scaling

if TYPE_CHECKING:
    from .insertion.growing import Growing

# with more new sites than this part of those that are there, all threads do it again from scratch
LARGEST_PART = 0.5


class Living:
    """The sites of a triangulation that takes more.

    Whoever adds sites or makes results holds the lock. The store is made when arrays are asked for, and made
    again where it cannot go on: where coordinates are larger than it was made for, where there are many new
    sites, and in the plane always.

    Parameters
    ----------
    points : float64 (n, d)
        The first sites, checked.
    seed : int
        A word, for the order of insertion.
    threads : int, optional
    """

    def __init__(self, points: np.ndarray, seed: int, threads: int | None) -> None:
        self.seed, self.threads = seed, threads
        # its first rows are the sites; rows that were written stay as they are
        self._room = np.empty((2 * len(points), points.shape[1]))
        self._room[: len(points)] = points
        self._count = len(points)
        self.dimension: int = points.shape[1]
        self._store: Growing | None = None
        self._exponent = 0
        self.lock = threading.RLock()

    @property
    def points(self) -> np.ndarray:
        """All sites so far, float64 (n, d)."""
        return self._room[: self._count]

    def add(self, points: np.ndarray, restart: bool) -> None:
        """Add sites, float64 (k, d), checked, to the store if it can go on.

        Raises
        ------
        ValueError
            If there are too many then.
        """
        count = self._count + len(points)
        if count > MOST_SITES:
            msg = (
                f"at most 2^25 = {MOST_SITES} sites can be numbered, and these are {self._count} and "
                f"{len(points)} more"
            )
            raise ValueError(msg)
        if count > len(self._room):
            room = np.empty((max(2 * self._count, count), points.shape[1]))
            room[: self._count] = self.points
            self._room = room
        store, self._store = self._store, None  # which is of no use if this is interrupted
        goes_on = False
        if store is not None and not restart and len(points) <= LARGEST_PART * self._count:
            sites = scaled_by(points, self._exponent)
            if sites is not None and store.takes(sites):
                store.add(sites)
                goes_on = True
        self._room[self._count : count] = points
        self._count = count
        if goes_on:
            self._store = store

    def in_space(self) -> dict[str, object]:
        """The results of all sites so far, in space.

        Raises
        ------
        DegenerateInputError
            If they span no volume.
        MemoryError
            If the system does not have the memory.
        """
        from .insertion.growing import Growing

        if self._store is None:
            sites, self._exponent = scaling(self.points)
            self._store = Growing(sites, self.seed, self.threads)
        simplices, neighbors = self._store.result()
        return {
            "points": self.points,
            "simplices": simplices,
            "neighbors": neighbors,
            "duplicates": self._store.duplicates,
            "iteration": np.ones(len(simplices), np.int32),
            "stats": InsertionStatistics(
                **self._store.counts(), inconsistencies=0, seconds=self._store.seconds()
            ),
        }
