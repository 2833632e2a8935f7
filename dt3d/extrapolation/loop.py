"""The main loop: parallel incremental extrapolation.

Teng et al. 1993, section 3. Every site starts with a first facet; both its sides are open. Each iteration
expands all open faces at once.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import scanvec as sv

from .._errors import InconsistencyError, InternalError
from .._memory import require
from . import compiled
from .buckets import Buckets, bucket
from .clock import Clock
from .dead_faces import (
    DeadFaces,
    Tetrahedron,
    both_sides,
    bury,
    bury_boundary,
    distinct,
    distinct_facets,
    neighbors,
    no_dead_faces,
    open_faces,
)
from .exact.decisions import Counts, expand_exactly
from .exact.first_facets import seeds
from .exact.sites import ExactSites, check_magnitudes
from .expansion import Face, expand_perturbed
from .gift_wrapping import first_facets
from .outcome import Outcome
from .points import Point
from .warrants import NO_SITE

# A set is given up when so large a share of the tetrahedra found, and more than so many, contradict others
# ("too many" in the paper's Table 3).
GIVE_UP_SHARE = 0.02
GIVE_UP_COUNT = 100

BYTES_PER_SITE = 1500  # at least, as measured


def extrapolate(
    machine: sv.Machine,
    sites: np.ndarray,
    exact: bool,
    report: Callable[[int, int, int], None] | None = None,
) -> Outcome:
    """Triangulate distinct sites (n, 3).

    ``report(iteration, open_faces, tetrahedra)`` is called after every iteration.

    Parameters
    ----------
    sites
        If ``exact``, float64 in lexicographic order, which is that of the symbolic perturbation. Otherwise
        float32 or float64 in the unit cube, and perturbed so that no five are cospherical.

    Raises
    ------
    InconsistencyError
        If too many tetrahedra contradict each other for the set to be finished.
    InternalError
        If ``exact``, and a tetrahedron contradicts another one.
    ValueError
        If ``exact``, and differences of coordinates are too small beside the greatest of these.
    """
    require(f"the extrapolation of {len(sites)} sites", BYTES_PER_SITE * len(sites))
    if exact:
        check_magnitudes(sites)
        if isinstance(machine, sv.Device) and compiled.serves(sites):
            return compiled.triangulate(machine, sites, report).in_canonical_order()
    clock = Clock(machine)
    with clock.phase("buckets"):
        buckets = bucket(Point(*(machine.vector(np.ascontiguousarray(c)) for c in sites.T)))
    with clock.phase("first facets"):
        facets = _wrapped_facets(buckets)
    expander = _Exact(ExactSites(buckets, sites)) if exact else _Perturbed(buckets)

    dead = no_dead_faces(machine)
    found: list[Tetrahedron] = []
    out = Outcome(np.empty((0, 4), np.int32), np.empty((0, 4), np.int32), np.empty(0, np.int32))
    total = 0
    open_list: Face | None = None
    while open_list is None or len(open_list.a):
        with clock.phase("face expansion"):
            if open_list is None:
                open_list, site = expander.begin(facets, out)
            else:
                site = expander.expand(open_list, out)
        with clock.phase("dead faces"):
            expanded = site != NO_SITE
            new = distinct(sv.pack(Tetrahedron(*open_list, site), expanded))
            dead, new, lost = bury(dead, new, total)
            dead, lost_boundary = bury_boundary(dead, sv.pack(open_list, ~expanded))
            open_list = open_faces(dead, new)
        found.append(new)
        out.per_iteration.append(len(new.a))
        total += len(new.a)
        out.inconsistencies += lost + lost_boundary
        _give_up_if_hopeless(out, total, len(sites), exact)
        if report is not None:
            report(len(out.per_iteration), len(open_list.a), total)

    with clock.phase("neighbors"):
        _assemble(buckets, dead, found, out)
        if exact:
            out.in_canonical_order()
    out.seconds = clock.seconds
    return out


class _Perturbed:
    """Expands faces of perturbed sites."""

    def __init__(self, buckets: Buckets) -> None:
        self._buckets = buckets

    def begin(self, facets: Face, out: Outcome) -> tuple[Face, sv.Vector]:
        """The first open faces and their fourth vertices."""
        faces = both_sides(facets)
        return faces, self.expand(faces, out)

    def expand(self, faces: Face, out: Outcome) -> sv.Vector:
        """The fourth vertex of each face, or `NO_SITE`."""
        answer = expand_perturbed(self._buckets, faces)
        out.face_expansions += len(faces.a)
        out.sites_searched += answer.sites_searched
        return answer.best.site


class _Exact:
    """Expands faces of sites as they are."""

    def __init__(self, sites: ExactSites) -> None:
        self._sites = sites

    def begin(self, facets: Face, out: Outcome) -> tuple[Face, sv.Vector]:
        """The first open faces and their fourth vertices."""
        start, counts = seeds(self._sites, facets)
        self._count(counts, out)
        return start.faces, start.site

    def expand(self, faces: Face, out: Outcome) -> sv.Vector:
        """The fourth vertex of each face, or `NO_SITE`."""
        expansion, counts = expand_exactly(self._sites, faces)
        self._count(counts, out)
        return expansion.site

    @staticmethod
    def _count(counts: Counts, out: Outcome) -> None:
        out.face_expansions += counts.face_expansions
        out.sites_searched += counts.sites_searched
        out.exact_decisions += counts.exact_decisions


def _wrapped_facets(buckets: Buckets) -> Face:
    """First facets, each once."""
    facets = Face(*first_facets(buckets))
    # a site whose nearest one is so near that all triangles with both look flat waits for others' faces
    facets = sv.pack(facets, facets.c != NO_SITE)
    if not len(facets.a):
        msg = (
            "no three sites form a triangle that this precision can tell from a flat one; method='insertion' "
            "needs none"
        )
        raise InconsistencyError(msg, 0)
    return distinct_facets(facets)


def _give_up_if_hopeless(out: Outcome, total: int, n: int, exact: bool) -> None:
    if exact and out.inconsistencies:
        msg = f"{out.inconsistencies} of {total} tetrahedra contradict others, which exact decisions exclude"
        raise InternalError(msg)
    # no triangulation of n sites has n^2 / 2 tetrahedra, so a run that goes round in circles ends too
    if exact and 2 * total > n * n:
        msg = f"{total} tetrahedra of {n} sites were found, more than any triangulation has"
        raise InternalError(msg)
    if out.inconsistencies > max(GIVE_UP_COUNT, GIVE_UP_SHARE * total) or 2 * total > n * n:
        msg = (
            f"{out.inconsistencies} inconsistencies among {total} tetrahedra after "
            f"{len(out.per_iteration)} iterations: sites too close to cospherical for this precision and "
            f"perturbation. Use method='insertion', which is exact; or dtype='float64', or another seed"
        )
        raise InconsistencyError(msg, out.inconsistencies)


def _assemble(buckets: Buckets, dead: DeadFaces, found: list[Tetrahedron], out: Outcome) -> None:
    """Collect the tetrahedra of all iterations, their neighbors, and the sites' own numbers."""
    every = found[0]
    for more in found[1:]:
        every = sv.append(every, more)
    number, holes = neighbors(dead, every)
    out.inconsistencies += holes
    vertices = [sv.get(buckets.origin, v).to_numpy() for v in every]
    out.simplices = np.stack(vertices, axis=1)
    out.neighbors = number.to_numpy().reshape(-1, 4)
    counts = np.asarray(out.per_iteration)
    out.iteration = np.repeat(np.arange(1, len(counts) + 1, dtype=np.int32), counts)
