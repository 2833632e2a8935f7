"""What the main loop returns, on any machine."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

import scanvec as sv

from .._stats import Statistics
from .exact.canonical import canonical


@dataclass
class Outcome:
    """What the loop found; vertices are indices of the rows of the sites it was given."""

    simplices: np.ndarray  # int32 (m, 4)
    neighbors: np.ndarray  # int32 (m, 4)
    iteration: np.ndarray  # int32 (m,)
    duplicates: np.ndarray = field(default_factory=lambda: np.empty((0, 2), np.int32))
    per_iteration: list[int] = field(default_factory=list)
    face_expansions: int = 0
    sites_searched: int = 0
    exact_decisions: int = 0
    inconsistencies: int = 0
    seconds: dict[str, float] = field(default_factory=dict)

    def in_canonical_order(self) -> Outcome:
        """The same with tetrahedra and their vertices in an order that does not depend on the machine."""
        rows = canonical(self.simplices, self.neighbors, self.iteration)
        self.simplices, self.neighbors, self.iteration = rows
        return self

    def statistics(self, ledger: sv.Ledger | None, total: float) -> Statistics:
        """The counts as the public class has them, with the seconds of the whole run."""
        return Statistics(
            iterations=len(self.per_iteration),
            face_expansions=self.face_expansions,
            sites_searched=self.sites_searched,
            exact_decisions=self.exact_decisions,
            tetrahedra_per_iteration=tuple(self.per_iteration),
            inconsistencies=self.inconsistencies,
            seconds=self.seconds | {"total": total},
            ledger=ledger,
        )
