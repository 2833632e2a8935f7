"""The first facets, checked: the seeds of the exact mode.

Gift wrapping in floating point gives facets that are right unless sites are nearly cospherical. Both sides of
each are expanded exactly, and it is Delaunay if and only if no coplanar site is inside its perturbed
circumcircle, and the fourth vertex of one side is not inside the sphere of the other's tetrahedron. One right
facet would be enough to find all tetrahedra from; the others are left out. If none is right, each is mended:
the site that refutes the facet (a, b, c) takes the place of c. It is inside the least ball of the facet, so
its circumcircle with a and b is smaller, and since ab is a Delaunay edge this ends at a facet whose least
ball is empty.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import jax.numpy as jnp

import scanvec as sv

from ..._errors import InconsistencyError
from ..dead_faces import both_sides, distinct_facets
from ..expansion import Face
from ..gift_wrapping import squared_circumradius
from ..points import Point
from ..warrants import NO_SITE
from .decisions import Counts, Expansion, expand_exactly
from .sites import ExactSites

# Sites whose nearest neighbours floating point cannot tell could send it round in circles.
MOST_REPAIRS = 1000


class Seeds(NamedTuple):
    """Facets, both sides of each, and the fourth vertices of these."""

    faces: Face
    site: sv.Vector


def seeds(exact: ExactSites, facets: Face) -> tuple[Seeds, Counts]:
    """Delaunay facets among or near those given, at least one."""
    machine = exact.buckets.machine
    total = Counts(0, 0, 0)
    for _ in range(MOST_REPAIRS):
        m = len(facets.a)
        faces = both_sides(facets)
        expansion, counts = expand_exactly(exact, faces)
        total = Counts(*(x + y for x, y in zip(total, counts, strict=True)))
        front = sv.get(expansion, machine.iota(m))
        back = sv.get(expansion, machine.iota(m) + m)
        open_question, refuter = machine.map(_first_look, front, back)
        index = sv.pack_index(open_question)
        facet, apex, site = sv.get((facets, front.site, back.site), index)
        apart = exact.inside(facet, apex, site)
        points = [sv.get(exact.buckets.sites, v) for v in (facet.a, facet.b, apex, site)]
        nearer = machine.map(_of_smaller_circle, *points, apex, site)
        refuting = sv.where(apart, nearer, NO_SITE)
        refuter = sv.scatter(refuting, index, into=refuter)
        good = machine.map(_stands, front, back, refuter)
        if int(sv.reduce(good, sv.ADD)):
            both = sv.pack(Seeds(faces, expansion.site), sv.append(good, good))
            return both, total
        facets = distinct_facets(facets._replace(c=machine.map(_mend, facets.c, refuter)))
    msg = "no Delaunay facet was found to begin with; use method='insertion'"
    raise InconsistencyError(msg, 0)


def _first_look(front: Expansion, back: Expansion) -> tuple[Any, Any]:
    """Whether only an exact test can tell if the two tetrahedra go together; and a coplanar refuter."""
    # the centres of empty spheres through the facet lie between -low(back) and low(front)
    certain = front.low + back.low > 0
    both = (front.site != NO_SITE) & (back.site != NO_SITE)
    refuter = jnp.maximum(front.refuter, back.refuter)
    return both & ~certain & (refuter == NO_SITE), refuter


def _of_smaller_circle(a: Point, b: Point, d: Point, e: Point, site_d: Any, site_e: Any) -> Any:
    """Which of d and e has the smaller circumcircle with a and b: one that is in the facet's least ball."""
    return jnp.where(squared_circumradius(a, b, e) < squared_circumradius(a, b, d), site_e, site_d)


def _stands(front: Expansion, back: Expansion, refuter: Any) -> Any:
    some = (front.site != NO_SITE) | (back.site != NO_SITE)
    return some & (refuter == NO_SITE)


def _mend(c: Any, refuter: Any) -> Any:
    return jnp.where(refuter == NO_SITE, c, refuter)
