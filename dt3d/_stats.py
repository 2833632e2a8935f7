"""What a triangulation reports of how it was found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Statistics:
    """Counts of an extrapolation, with the names of Teng et al. 1993, Table 1.

    Attributes
    ----------
    iterations : int
        Rounds of face expansion, the last of which may find the hull only (the table's "depth"). Exactly, on
        ``scanvec.Device()``, and of 2,000 sites or more that fill space evenly: the first tetrahedra, then
        waves, each of some of the open faces.
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
    """

    iterations: int
    face_expansions: int
    sites_searched: int
    exact_decisions: int
    tetrahedra_per_iteration: tuple[int, ...]
    inconsistencies: int
    seconds: dict[str, float]
    ledger: Any


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
        That inserted at the same time, at most.
    deferred : int
        Times that a site was left for a later pass, since its cavity had sites of several threads. This,
        and with it the counts above, depends on how many threads there are.
    inconsistencies : int
        Always 0: every decision is exact.
    seconds : dict of str to float
        Wall time by phase, compilation included.
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
    """What the callback gets: after every iteration of an extrapolation, every stretch of an insertion.

    Attributes
    ----------
    iteration : int
        1, 2, ...; the number of the stretch.
    open_faces : int
        Faces that the next iteration will expand, 0 after the last; sites not yet inserted.
    tetrahedra : int
        Found so far.
    seconds : float
        Since the call.
    """

    iteration: int
    open_faces: int
    tetrahedra: int
    seconds: float
