"""A triangulation in space that takes more sites: the store goes on.

New sites get the rows after the old ones. They are inserted in rounds along the curve through them, each from
where a hint in its row says. One thread does: rows say nothing of where new sites lie among the old ones, and
threads own sites by their rows. The triangulation is unique, so it is the one of all sites from scratch.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .._memory import require
from ..ordering.along_curve import along_curve
from ..ordering.brio import insertion_rounds
from .driver import BYTES_PER_SITE, Result, compact, inserted
from .hints import Hints
from .mesh import HINT, with_hints
from .store import BYTES_PER_SLOT, longer

BYTES_PER_ADDED_SITE = 8 * BYTES_PER_SLOT  # for its tetrahedra and ghosts, and for freed slots
NOBODY = np.empty(0, np.int32)  # is left out of the rounds of new sites


class Growing:
    """Sites of one triangulation, to which others are added; by one thread at a time.

    Parameters
    ----------
    sites : float64 (n, 3)
        As `driver.triangulate` takes them.
    seed : int
        For the order of insertion.
    threads : int, optional
        For the first sites.

    Raises
    ------
    DegenerateInputError
        If they span no volume.
    MemoryError
        If the system does not have the memory.
    """

    def __init__(self, sites: npt.NDArray[np.float64], seed: int = 0, threads: int | None = None) -> None:
        self._run = inserted(sites, seed, threads)
        self._seed = seed
        self._given = len(sites)
        self._scaled = self._run.team.scale.reach == 1.0
        self._numbers = self._run.original  # of the site in each row; more rows may follow
        self._duplicates = [self._run.duplicates]
        self._run.store.reserve(2 * len(sites))  # so that the first to be added wait for no copy
        self._hints = Hints(self._run.store)

    def takes(self, sites: npt.NDArray[np.float64]) -> bool:
        """Whether sites can be added: bounds of errors are known for coordinates up to 1, in magnitude."""
        return self._scaled and (not sites.size or (sites.max() <= 1.0 and sites.min() >= -1.0))

    def counts(self) -> dict[str, int]:
        """What was counted in all insertions so far."""
        return self._run.team.counts()

    def seconds(self) -> dict[str, float]:
        """The wall time of the first sites, by phase and in all."""
        return self._run.seconds | {"total": sum(self._run.seconds.values())}

    def add(self, sites: npt.NDArray[np.float64]) -> None:
        """Add sites, float64 (k, 3), that it `takes`; they get the numbers after those that are there.

        After an exception the triangulation is of no more use.

        Raises
        ------
        MemoryError
            If the system does not have the memory.
        """
        if len(sites) == 1:
            self._add_one(*sites[0].tolist())
        elif len(sites):
            self._add_many(sites)

    def _add_one(self, x: float, y: float, z: float) -> None:
        store = self._run.store
        cell = self._hints.cell(x, y, z)
        one = np.array([x, y, z, 0.0])
        near = self._hints.near_one(cell)
        if near >= 0:
            one.view(np.uint32)[7] = HINT + near
        row = store.add_sites(one)
        self._number(row, self._given)
        self._given += 1
        equal = self._run.team.insert_added(np.array([row], np.uint32))
        if equal:
            self._duplicates.append(self._pairs(equal))
        else:
            self._hints.note(cell, row)

    def _add_many(self, sites: npt.NDArray[np.float64]) -> None:
        k, store = len(sites), self._run.store
        require(f"{k} more sites", BYTES_PER_SITE * k, (BYTES_PER_SITE + BYTES_PER_ADDED_SITE) * k)
        order = along_curve(sites)
        sites = sites[order]
        cells = self._hints.cells(sites)
        begin = store.add_sites(with_hints(sites, self._hints.near(cells)))
        self._number(begin, self._given + order)
        self._given += k
        rounds, _ = insertion_rounds(k, self._seed, NOBODY)
        equal = self._run.team.insert_added((begin + rounds).astype(np.uint32))
        if equal:
            self._duplicates.append(self._pairs(equal))
        is_vertex = np.ones(k, bool)
        is_vertex[[row - begin for row, _ in equal]] = False
        self._hints.note(cells[is_vertex], begin + np.flatnonzero(is_vertex))

    def _number(self, begin: int, numbers: npt.NDArray[np.int64] | int) -> None:
        """Let the rows from ``begin`` on have these numbers."""
        end = begin + (1 if isinstance(numbers, int) else len(numbers))
        if end > len(self._numbers):
            self._numbers = longer(self._numbers, begin, 2 * end)
        self._numbers[begin:end] = numbers

    def _pairs(self, equal: list[tuple[int, int]]) -> npt.NDArray[np.int32]:
        """Pairs of numbers, ascending, for pairs of rows: of equal sites the one of least number is used.

        Another one may have been inserted before it; they are in the same place, so they change their rows.
        """
        number = self._numbers
        for row, used in equal:
            if number[row] < number[used]:
                number[row], number[used] = number[used], number[row]
        pairs = np.array([(number[row], number[used]) for row, used in equal], np.int32)
        return pairs[np.argsort(pairs[:, 0])]

    def result(self) -> Result:
        """Simplices and neighbors as they are now: int32 (m, 4) each, new arrays."""
        team = self._run.team
        team.mark_fresh()
        return compact(self._run.store, self._numbers, len(team.workers), _new)

    @property
    def duplicates(self) -> npt.NDArray[np.int32]:
        """Sites that were not used, and the equal ones that were, int32 (k, 2)."""
        return np.concatenate(self._duplicates)


def _new(m: int) -> Result:
    return np.empty((m, 4), np.int32), np.empty((m, 4), np.int32)
