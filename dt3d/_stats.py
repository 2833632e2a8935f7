"""What a triangulation reports of how it was found."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import scanvec as sv


@dataclass(frozen=True)
class Statistics:
    """Counts of an extrapolation, with the names of Teng et al. 1993, Table 1.

    Attributes
    ----------
    iterations : int
        Rounds of face expansion (the table's "depth"). The last one may find facets of the hull only. Where
        whole steps compiled for a device find tetrahedra in another order, see `waves`, these are the rounds
        in which the paper's loop finds them.
    face_expansions : int
        Faces expanded ("FE").
    sites_searched : int
        Sites examined in all face expansions ("search/FE" is this over `face_expansions`).
    exact_decisions : int
        Face expansions that the bounds of floating point left open; 0 with ``robustness="perturb"``.
    tetrahedra_per_iteration : tuple of int
        Tetrahedra found in iteration 1, 2, ... (Figure 3).
    inconsistencies : int
        Tetrahedra left out since they contradict others, and holes that were left (section 5.2); 0 if the
        result is sound.
    seconds : dict of str to float
        Wall time by phase, compilation included.
    ledger : scanvec.Ledger or None
        That of a simulated machine.
    cells_opened : int
        Cells of all face expansions' boxes, pruned ones included; 0 where the search goes through a tree, and
        in compiled steps.
    search_rounds : tuple of int
        Face expansions whose search through cells took 1, 2, ... rounds.
    waves : tuple of int
        Tetrahedra found in each wave of whole steps compiled for a device, which exact decisions on
        ``scanvec.Device()`` take for 2,000 sites or more that fill space evenly: the first tetrahedra, and
        then those from a part of the open faces at a time. Empty where the loop goes in the paper's rounds.
    """

    iterations: int
    face_expansions: int
    sites_searched: int
    exact_decisions: int
    tetrahedra_per_iteration: tuple[int, ...]
    inconsistencies: int
    seconds: dict[str, float]
    ledger: sv.Ledger | None
    cells_opened: int = 0
    search_rounds: tuple[int, ...] = ()
    waves: tuple[int, ...] = ()


@dataclass(frozen=True)
class InsertionStatistics:
    """Counts of an exact insertion.

    Attributes
    ----------
    walked : int
        Steps from tetrahedron to tetrahedron on the way to the sites.
    tested : int
        Tetrahedra tested for conflict with a site.
    created : int
        Tetrahedra made, ghosts included; most are destroyed by later sites.
    threads : int
        The most threads that inserted at the same time.
    deferred : int
        How often a site was left for a later pass, because its cavity reached into the part of another
        thread. This count, and with it those above, depends on the number of threads.
    inconsistencies : int
        Always 0: every decision is exact.
    seconds : dict of str to float
        Wall time by phase, compilation included.

    Examples
    --------
    >>> import numpy as np, dt3d
    >>> stats = dt3d.Delaunay(np.random.default_rng(0).random((100, 3)), threads=1).stats
    >>> stats.threads, stats.inconsistencies, sorted(stats.seconds)[-1]
    (1, 0, 'total')
    """

    walked: int
    tested: int
    created: int
    threads: int
    deferred: int
    inconsistencies: int
    seconds: dict[str, float]


@dataclass(frozen=True)
class Progress:
    """What the callback gets after each iteration: how far the triangulation has come.

    Attributes
    ----------
    iteration : int
        1, 2, ... By extrapolation the number of the iteration, by insertion that of the stretch of up to
        100,000 sites.
    remaining : int
        What is left to do, 0 after the last iteration. By extrapolation the faces that the next iteration
        expands, by insertion the sites that are not inserted yet.
    tetrahedra : int
        Found so far.
    seconds : float
        Wall time since the call.

    Examples
    --------
    >>> import numpy as np, dt3d
    >>> seen = []
    >>> _ = dt3d.Delaunay(np.random.default_rng(0).random((100, 3)), callback=seen.append)
    >>> seen[-1].remaining, seen[-1].tetrahedra > 400
    (0, True)
    """

    iteration: int
    remaining: int
    tetrahedra: int
    seconds: float

    @property
    def open_faces(self) -> int:
        """The old name of `remaining`; goes with the next release."""
        warnings.warn("Progress.open_faces is now Progress.remaining", DeprecationWarning, stacklevel=2)
        return self.remaining
