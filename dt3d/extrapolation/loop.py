"""The main loop: Algorithm Parallel Extrapolation.

Teng et al. 1993, section 3. Every site starts with a first facet; both its sides are open. Each iteration
expands all open faces at once. The number of the iteration that finds a tetrahedron is its depth: the
distance, in the graph of tetrahedra that share a facet, from the first facets. Lines of the algorithm are
quoted where they are executed.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import scanvec as sv

from .._errors import InconsistencyError
from .buckets import Buckets, bucket
from .clock import Clock
from .consistency import check_progress
from .dead_faces import (
    DeadFaces,
    distinct,
    distinct_facets,
    insert_boundary_faces,
    insert_dead_faces,
    neighbors,
    no_dead_faces,
    open_faces,
)
from .expansion import Expander
from .faces import Face, Tetrahedron
from .gift_wrapping import first_facets
from .outcome import Outcome, Report
from .points import Point
from .search_options import DEFAULT_SEARCH, SearchOptions
from .warrants import NO_SITE


def extrapolate(
    machine: sv.Machine,
    sites: np.ndarray,
    mode: Callable[[Buckets], Expander],
    report: Report | None = None,
    options: SearchOptions = DEFAULT_SEARCH,
    first: Callable[[Buckets], Face[sv.Vector]] | None = None,
) -> Outcome:
    """Triangulate distinct sites (n, 3).

    Parameters
    ----------
    machine : scanvec.Machine
        Where the vectors live.
    sites : ndarray (n, 3)
        For `expansion.Perturbed` float32 or float64 in the unit cube, perturbed so that no five are
        cospherical. For `exact.expander.Exact` float64 in lexicographic order, which is that of the symbolic
        perturbation.
    mode : callable
        Makes what expands the faces of buckets.
    report : callable, optional
        Called after every iteration.
    options : SearchOptions
        Of cells and their search.
    first : callable, optional
        Distinct Delaunay facets to begin with, in the order of the buckets; those of every site by default.

    Raises
    ------
    InconsistencyError
        If too many tetrahedra contradict each other for the set to be finished.
    InternalError
        If the mode is exact, and a tetrahedron contradicts another one.
    """
    clock = Clock(machine)
    with clock.phase("buckets"):
        buckets = bucket(Point(*(machine.vector(np.ascontiguousarray(c)) for c in sites.T)), options)
    with clock.phase("first facets"):
        # "for each vertex find the first Delaunay facet by gift wrapping"
        facets = (first or initial_facets)(buckets)
    expander = mode(buckets)

    dead = no_dead_faces(machine)
    found: list[Tetrahedron[sv.Vector]] = []
    out = Outcome()
    open_list: Face[sv.Vector] | None = None
    # "initialize OFL to the initial faces; while OFL is not empty"
    while open_list is None or len(open_list.a):
        with clock.phase("face expansion"):
            # "expand all open faces into tetrahedra"
            if open_list is None:
                open_list, site, counts = expander.begin(facets)
            else:
                site, counts = expander.expand(open_list)
            out.add(counts)
        with clock.phase("dead faces"):
            expanded = site != NO_SITE
            new = distinct(sv.pack(Tetrahedron(*open_list, site), expanded))
            dead, new, contradicting = insert_dead_faces(dead, new, out.tetrahedra)
            dead, not_boundary = insert_boundary_faces(dead, sv.pack(open_list, ~expanded))
            # "append the new outward faces to OFL; purge OFL: delete opposite-duplicates"
            open_list = open_faces(dead, new)
        # "append the new tetrahedra to TL"
        found.append(new)
        out.per_iteration.append(len(new.a))
        out.inconsistencies += contradicting + not_boundary
        check_progress(out, len(sites), expander.exact)
        if report is not None:
            report(len(out.per_iteration), len(open_list.a), out.tetrahedra)

    with clock.phase("neighbors"):
        _assemble(buckets, dead, found, out)
    out.seconds = clock.seconds
    return out


def initial_facets(buckets: Buckets) -> Face[sv.Vector]:
    """First facets, each once.

    Raises
    ------
    InconsistencyError
        If all triangles look flat.
    """
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


def _assemble(buckets: Buckets, dead: DeadFaces, found: list[Tetrahedron[sv.Vector]], out: Outcome) -> None:
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
