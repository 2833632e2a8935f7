"""What the main loop returns and counts, on any machine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import zip_longest
from typing import NamedTuple, TypeAlias

import numpy as np

import scanvec as sv

from .._stats import Statistics
from .warrants import SearchResult

# Called with the iteration, the open faces and the tetrahedra so far, after every iteration.
Report: TypeAlias = Callable[[int, int, int], None]


class Counts(NamedTuple):
    """What an expansion did."""

    face_expansions: int = 0
    sites_searched: int = 0
    exact_decisions: int = 0
    cells_opened: int = 0
    search_rounds: tuple[int, ...] = ()  # how many faces took 1, 2, ... rounds


NOTHING_DONE = Counts()


def counted(faces: int, result: SearchResult, exact_decisions: int = 0) -> Counts:
    """What a search for so many faces did."""
    return Counts(faces, result.sites_searched, exact_decisions, result.cells_opened, result.rounds)


@dataclass
class Outcome:
    """What the loop found; vertices are rows of the sites it was given."""

    simplices: np.ndarray = field(default_factory=lambda: np.empty((0, 4), np.int32))  # int32 (m, 4)
    neighbors: np.ndarray = field(default_factory=lambda: np.empty((0, 4), np.int32))  # int32 (m, 4)
    iteration: np.ndarray = field(default_factory=lambda: np.empty(0, np.int32))  # int32 (m,)
    duplicates: np.ndarray = field(default_factory=lambda: np.empty((0, 2), np.int32))  # int32 (k, 2)
    per_iteration: list[int] = field(default_factory=list)
    waves: list[int] = field(default_factory=list)  # tetrahedra of each, where compiled steps find them
    counts: Counts = NOTHING_DONE
    inconsistencies: int = 0
    seconds: dict[str, float] = field(default_factory=dict)

    @property
    def tetrahedra(self) -> int:
        """How many have been found."""
        return sum(self.per_iteration or self.waves)

    def add(self, counts: Counts) -> None:
        """Count an expansion."""
        self.counts = added(self.counts, counts)

    def statistics(self, ledger: sv.Ledger | None, total: float) -> Statistics:
        """The counts as the public class has them, with the seconds of the whole run."""
        return Statistics(
            iterations=len(self.per_iteration),
            **self.counts._asdict(),
            tetrahedra_per_iteration=tuple(self.per_iteration),
            inconsistencies=self.inconsistencies,
            seconds=self.seconds | {"total": total},
            ledger=ledger,
            waves=tuple(self.waves),
        )


def added(a: Counts, b: Counts) -> Counts:
    """The counts of two expansions together."""
    rounds = tuple(x + y for x, y in zip_longest(a.search_rounds, b.search_rounds, fillvalue=0))
    return Counts(
        a.face_expansions + b.face_expansions,
        a.sites_searched + b.sites_searched,
        a.exact_decisions + b.exact_decisions,
        a.cells_opened + b.cells_opened,
        rounds,
    )
