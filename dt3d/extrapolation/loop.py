"""The main loop: parallel incremental extrapolation.

Teng et al. 1993, section 3. Every site starts with a first facet; both its sides are open. Each iteration
expands all open faces at once.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np

import scanvec as sv

from .._errors import InconsistencyError
from .buckets import Buckets, bucket
from .dead_faces import (
    DeadFaces,
    Tetrahedron,
    bury,
    bury_boundary,
    distinct,
    face_key,
    neighbors,
    no_dead_faces,
    open_faces,
    opposite,
)
from .expansion import Face, expand
from .gift_wrapping import first_facets
from .points import Point
from .search import NO_SITE

# A set is given up when so large a share of the tetrahedra found, and more than so many, contradict others
# ("too many" in the paper's Table 3).
GIVE_UP_SHARE = 0.02
GIVE_UP_COUNT = 100


@dataclass
class Outcome:
    """What the loop found; vertices are indices of the rows of the sites it was given."""

    simplices: np.ndarray  # int32 (m, 4)
    neighbors: np.ndarray  # int32 (m, 4)
    iteration: np.ndarray  # int32 (m,)
    per_iteration: list[int] = field(default_factory=list)
    face_expansions: int = 0
    sites_searched: int = 0
    inconsistencies: int = 0
    seconds: dict[str, float] = field(default_factory=dict)


class _Clock:
    """Adds up seconds by phase, and names the phases in the machine's ledger."""

    def __init__(self, machine: sv.Machine) -> None:
        self.machine = machine
        self.seconds: dict[str, float] = {}

    @contextmanager
    def phase(self, name: str) -> Any:
        start = time.perf_counter()
        with self.machine.phase(name):
            yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start


def triangulate(
    machine: sv.Machine, sites: np.ndarray, report: Callable[[int, int, int], None] | None = None
) -> Outcome:
    """Triangulate distinct sites, float32 or float64 (n, 3), in the unit cube and perturbed.

    ``report(iteration, open_faces, tetrahedra)`` is called after every iteration.

    Raises
    ------
    InconsistencyError
        If too many tetrahedra contradict each other for the set to be finished.
    """
    clock = _Clock(machine)
    with clock.phase("buckets"):
        buckets = bucket(Point(*(machine.vector(np.ascontiguousarray(c)) for c in sites.T)))
    with clock.phase("first facets"):
        open_list = _both_sides(_distinct_facets(buckets))

    dead = no_dead_faces(machine)
    found: list[Tetrahedron] = []
    out = Outcome(np.empty((0, 4), np.int32), np.empty((0, 4), np.int32), np.empty(0, np.int32))
    total = 0
    while len(open_list.a):
        with clock.phase("face expansion"):
            answer = expand(buckets, open_list)
            out.face_expansions += len(open_list.a)
            out.sites_searched += answer.sites_searched
        with clock.phase("dead faces"):
            expanded = answer.site != NO_SITE
            new = distinct(sv.pack(Tetrahedron(*open_list, answer.site), expanded))
            dead, new, lost = bury(dead, new, total)
            dead, lost_boundary = bury_boundary(dead, sv.pack(open_list, ~expanded))
            open_list = open_faces(dead, new)
        found.append(new)
        out.per_iteration.append(len(new.a))
        total += len(new.a)
        out.inconsistencies += lost + lost_boundary
        _give_up_if_hopeless(out, total, len(sites))
        if report is not None:
            report(len(out.per_iteration), len(open_list.a), total)

    with clock.phase("neighbors"):
        _assemble(buckets, dead, found, out)
    out.seconds = clock.seconds
    return out


def _distinct_facets(buckets: Buckets) -> Face:
    """First facets, each once: vertices in ascending order."""
    machine = buckets.origin.machine
    facets = Face(*first_facets(buckets))
    # a site whose nearest one is so near that all triangles with both look flat waits for others' faces
    facets = sv.pack(facets, facets.c != NO_SITE)
    if not len(facets.a):
        msg = "no three sites form a triangle that this precision can tell from a flat one"
        raise InconsistencyError(msg, 0)
    low, mid, high, _ = machine.map(face_key, facets)
    return Face(*sv.unique((low, mid, high)))


def _both_sides(facets: Face) -> Face:
    return sv.append(facets, facets.a.machine.map(opposite, facets))


def _give_up_if_hopeless(out: Outcome, total: int, n: int) -> None:
    # no triangulation of n sites has n^2 / 2 tetrahedra, so a run that goes round in circles ends too
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
