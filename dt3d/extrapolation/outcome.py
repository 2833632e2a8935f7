"""What the main loop returns, on any machine."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .exact.canonical import canonical


@dataclass
class Outcome:
    """What the loop found; vertices are indices of the rows of the sites it was given."""

    simplices: np.ndarray  # int32 (m, 4)
    neighbors: np.ndarray  # int32 (m, 4)
    iteration: np.ndarray  # int32 (m,)
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
