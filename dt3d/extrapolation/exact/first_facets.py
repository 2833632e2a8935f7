"""The first facets of gift wrapping, checked, for the exact mode.

Gift wrapping in floating point gives facets that are right unless sites are nearly cospherical. Both sides of
each are expanded exactly, and it is Delaunay if and only if no coplanar site is inside its perturbed
circumcircle, and the fourth vertex of one side is not inside the sphere of the other's tetrahedron. One right
facet would be enough to find all tetrahedra from; the others are left out. If none is right, each is
repaired: the site that violates the facet (a, b, c) takes the place of c. It is inside the least ball of the
facet, so its circumcircle with a and b is smaller, and since ab is a Delaunay edge this ends at a facet whose
least ball is empty.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import Array

import scanvec as sv

from ..._errors import InconsistencyError
from ..dead_faces import distinct_facets
from ..faces import Face, both_sides
from ..gift_wrapping import squared_circumradius
from ..outcome import NOTHING_DONE, Counts, added
from ..points import Point
from ..warrants import NO_SITE
from .decisions import Expansion, expand_exactly
from .sites import ExactSites

# Sites whose nearest neighbours floating point cannot tell could send it round in circles.
MOST_REPAIRS = 1000


class CheckedFacets(NamedTuple):
    """Facets, both sides of each, and the fourth vertices of these."""

    faces: Face[sv.Vector]
    site: sv.Vector


def checked_facets(exact: ExactSites, facets: Face[sv.Vector]) -> tuple[CheckedFacets, Counts]:
    """Delaunay facets among or near those given, at least one.

    Raises
    ------
    InconsistencyError
        If none is found.
    """
    machine = exact.buckets.machine
    total = NOTHING_DONE
    for _ in range(MOST_REPAIRS):
        m = len(facets.a)
        faces = both_sides(facets)
        expansion, counts = expand_exactly(exact, faces)
        total = added(total, counts)
        front = sv.get(expansion, machine.iota(m))
        back = sv.get(expansion, machine.iota(m) + m)
        undecided, violator = machine.map(_compare_sides, front, back)
        index = sv.pack_index(undecided)
        facet, apex, site = sv.get((facets, front.site, back.site), index)
        violates = exact.inside(facet, apex, site)
        points = [sv.get(exact.buckets.sites, v) for v in (facet.a, facet.b, apex, site)]
        nearer = machine.map(_of_smaller_circle, *points, apex, site)
        violating = sv.where(violates, nearer, NO_SITE)
        violator = sv.scatter(violating, index, into=violator)
        good = machine.map(_is_delaunay, front, back, violator)
        if int(sv.reduce(good, sv.ADD)):
            both = sv.pack(CheckedFacets(faces, expansion.site), sv.append(good, good))
            return both, total
        facets = distinct_facets(facets._replace(c=machine.map(_repaired, facets.c, violator)))
    msg = "no Delaunay facet was found to begin with; use method='insertion'"
    raise InconsistencyError(msg, 0)


def _compare_sides(front: Expansion[Array], back: Expansion[Array]) -> tuple[Array, Array]:
    """Whether only an exact test tells if the two tetrahedra go together; and a coplanar violating site."""
    # the centres of empty spheres through the facet lie between -low(back) and low(front)
    certain = front.low + back.low > 0
    both = (front.site != NO_SITE) & (back.site != NO_SITE)
    violator = jnp.maximum(front.violator, back.violator)
    return both & ~certain & (violator == NO_SITE), violator


def _of_smaller_circle(
    a: Point[Array], b: Point[Array], d: Point[Array], e: Point[Array], site_d: Array, site_e: Array
) -> Array:
    """Which of d and e has the smaller circumcircle with a and b: one that is in the facet's least ball."""
    return jnp.where(squared_circumradius(a, b, e) < squared_circumradius(a, b, d), site_e, site_d)


def _is_delaunay(front: Expansion[Array], back: Expansion[Array], violator: Array) -> Array:
    some = (front.site != NO_SITE) | (back.site != NO_SITE)
    return some & (violator == NO_SITE)


def _repaired(c: Array, violator: Array) -> Array:
    return jnp.where(violator == NO_SITE, c, violator)
