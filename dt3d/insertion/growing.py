"""A triangulation in space that takes more sites: the store goes on.

New sites get the rows after the old ones, in rounds along the curve through them, so that each walk is short.
One thread inserts them: their rows say nothing of where they lie among the old ones, and threads own sites by
their rows. The triangulation is unique, so it is the one of all sites from scratch.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from .._errors import InternalError
from .._memory import require
from ..ordering.along_curve import along_curve
from ..ordering.brio import insertion_rounds
from .driver import BYTES_PER_SITE, Result, compact, inserted
from .hints import Hints
from .store import BYTES_PER_SLOT
from .worker import State

BYTES_PER_ADDED_SITE = 8 * BYTES_PER_SLOT  # for its tetrahedra and ghosts, and for freed slots
NOBODY = np.empty(0, np.int32)  # is left out of the rounds of new sites
FIRST_OF_ONE = np.zeros(1, np.int64)


class Growing:
    """Sites of one triangulation, to which others are added.

    Parameters
    ----------
    sites : float64 (n, 3)
        As `driver.triangulate` takes them.
    seed : int
        For the order of insertion.
    threads : int, optional
        For the first sites.
    report : function, optional
        As `driver.triangulate` has it, for the first sites.

    Raises
    ------
    DegenerateInputError
        If they span no volume.
    MemoryError
        If the system does not have the memory.
    """

    def __init__(
        self,
        sites: npt.NDArray[np.float64],
        seed: int = 0,
        threads: int | None = None,
        report: Callable[[int, int], None] | None = None,
    ) -> None:
        self._run = inserted(sites, seed, threads, report)
        self._seed = seed
        self._given = len(sites)
        self._original = [self._run.original]
        self._duplicates = [self._run.duplicates]
        self._run.store.reserve(2 * len(sites))  # so that the first to be added wait for no copy
        self._hints = Hints(self._run.store)
        self._lock = threading.Lock()

    @property
    def reach(self) -> float:
        """The greatest coordinate that a new site may have, in magnitude; 0 where there may be none.

        Bounds of errors are known for coordinates up to 1.
        """
        return 1.0 if self._run.team.scale.reach == 1.0 else 0.0

    def statistics(self) -> dict[str, Any]:
        """Counts of all insertions so far, and the seconds of the first sites' by phase."""
        team = self._run.team
        return {
            "walked": team.count(State.WALKED),
            "tested": team.count(State.TESTED),
            "created": team.count(State.CREATED),
            "threads": len(team.workers),
            "deferred": team.deferred,
            "inconsistencies": 0,
            "seconds": self._run.seconds | {"total": sum(self._run.seconds.values())},
        }

    def add(self, sites: npt.NDArray[np.float64]) -> None:
        """Add sites, float64 (k, 3), which get the numbers after those that are there.

        After an exception the triangulation is of no more use.

        Raises
        ------
        MemoryError
            If the system does not have the memory.
        """
        with self._lock:
            self._add(sites)

    def _add(self, sites: npt.NDArray[np.float64]) -> None:
        if not np.abs(sites).max(initial=0.0) <= self.reach:
            msg = f"new sites have coordinates of up to {np.abs(sites).max()}, and {self.reach} is the most"
            raise InternalError(msg)
        k, store, team = len(sites), self._run.store, self._run.team
        if k == 0:
            return
        if k == 1:
            order, start = FIRST_OF_ONE, self._hints.near(*sites[0].tolist())
        else:
            require(f"{k} more sites", BYTES_PER_SITE * k, (BYTES_PER_SITE + BYTES_PER_ADDED_SITE) * k)
            order, start = along_curve(sites), -1
        rows = np.zeros((k, 4))
        rows[:, :3] = sites[order]
        begin = store.add_sites(rows.reshape(-1))
        rounds = insertion_rounds(k, self._seed, NOBODY)[0] if k > 1 else FIRST_OF_ONE
        equal = team.insert_added((begin + rounds).astype(np.uint32), start)
        self._original.append((self._given + order).astype(np.int32))
        self._given += k
        if equal:
            self._duplicates.append(self._pairs(equal))
        elif k == 1:
            self._hints.note(begin, *sites[0].tolist())

    def _pairs(self, equal: list[tuple[int, int]]) -> npt.NDArray[np.int32]:
        """Pairs of numbers, ascending, for pairs of rows: of equal sites the one of least number is used.

        Another one may have been inserted before it; they are in the same place, so they change their rows.
        """
        number = self._rows()
        for row, used in equal:
            if number[row] < number[used]:
                number[row], number[used] = number[used], number[row]
        pairs = np.array([(number[row], number[used]) for row, used in equal], np.int32)
        return pairs[np.argsort(pairs[:, 0])]

    def _rows(self) -> npt.NDArray[np.int32]:
        """The number of the site in each row."""
        if len(self._original) > 1:
            self._original = [np.concatenate(self._original)]
        return self._original[0]

    def result(self) -> Result:
        """Simplices and neighbors as they are now: int32 (m, 4) each, new arrays."""
        with self._lock:
            team = self._run.team
            team.mark_fresh()
            return compact(self._run.store, self._rows(), len(team.workers), _new)

    @property
    def duplicates(self) -> npt.NDArray[np.int32]:
        """Sites that were not used, and the equal ones that were, int32 (k, 2)."""
        return np.concatenate(self._duplicates)


def _new(m: int) -> Result:
    return np.empty((m, 4), np.int32), np.empty((m, 4), np.int32)
