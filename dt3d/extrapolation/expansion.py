"""Face expansion: the site on a face's positive side that forms a Delaunay tetrahedron with it.

Teng et al. 1993, sections 4 and 4.2 (Algorithm Face Expansion). The search is that of `search`; what is
particular to faces is here. `PERTURBED` is the paper's: sites are in general position, and their signed
distances are compared as they come. `exact/expansion.py` has the form for sites as they are.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import jax.numpy as jnp

import scanvec as sv

from . import signed_distance
from .boxes import Box, Grid
from .buckets import Buckets
from .caps import cap_box
from .gift_wrapping import squared_distance_to_box
from .points import Point, add, bounding_box, dot, epsilon, norm, sub
from .search import search
from .warrants import Answer, Question

# Bounds that a tree search tries before it does without.
TRIALS = 4


class Face(NamedTuple):
    """Sites a, b, c; the positive half-space is on the side of (b-a) x (c-a)."""

    a: Any
    b: Any
    c: Any


class OpenFace(NamedTuple):
    """An open face as a query: its frame and its vertices."""

    frame: Any
    face: Face


def first_box(query: OpenFace, a: Point, b: Point, c: Point, reach: Any) -> tuple[Point, Point]:
    """The corners of the box of a face and its circumcentre, which may be ``reach`` beyond it at most.

    Faces of slivers at the hull have circumcentres far away; opening all cells on the way would be in vain.
    """
    low, high = bounding_box(a, b, c)
    centre = add(query.frame.origin, query.frame.centre)
    low = Point(*(jnp.minimum(u, jnp.maximum(v, u - reach)) for u, v in zip(low, centre, strict=True)))
    high = Point(*(jnp.maximum(u, jnp.minimum(v, u + reach)) for u, v in zip(high, centre, strict=True)))
    return low, high


def search_faces(buckets: Buckets, queries: OpenFace, corners: list[Point], question: Question) -> Answer:
    """The answers of open faces with the given corners, three records of coordinates."""
    first = (corners[0], corners[0])
    if buckets.cells is not None:
        first = buckets.machine.map(first_box, queries, *corners, buckets.cells.grid.side)
    return search(buckets, queries, first, question)


def homes(query: OpenFace) -> tuple[Any, Any, Any]:
    return query.face.a, query.face.b, query.face.c


def trial(centre: Point, k: Any, unit: Any) -> Any:
    """Signed distances of half the radius of the face's circumcircle, then of 2, 8, 32 of them."""
    distance = norm(centre) * jnp.left_shift(1, 2 * k) / 2
    return jnp.where(k < TRIALS, distance / unit, jnp.inf)


def open_perturbed_face(face: Face, a: Point, b: Point, c: Point) -> OpenFace:
    return OpenFace(signed_distance.frame(a, b, c), face)


def _perturbed_score(query: OpenFace, site: Point, index: Any) -> tuple[Any, Any]:
    distance = signed_distance.signed_distance(query.frame, site)
    return distance, distance


def _perturbed_region(query: OpenFace, distance: Any, grid: Grid) -> Box:
    f = query.frame
    zero = jnp.zeros_like(f.blur)
    return cap_box(f.origin, f.normal, Point(zero, zero, zero), f.centre, distance, zero, grid)


def _perturbed_admits(query: OpenFace, distance: Any, low: Point, high: Point) -> Any:
    """Whether a box meets the positive half-space and, once there is a candidate, its circumsphere."""
    face = query.frame
    lo, hi = sub(low, face.origin), sub(high, face.origin)
    height = sum(jnp.maximum(m * u, m * v) for m, u, v in zip(face.normal, lo, hi, strict=True))
    found = jnp.isfinite(distance)
    centre, squared = signed_distance.circumsphere(face, jnp.where(found, distance, 0))
    # the squares lose what the coordinates have beyond an ulp of the radius
    slack = 64 * epsilon(low.x) * (squared + dot(centre, centre))
    meets = squared_distance_to_box(centre, low, high) <= squared + slack
    return (height >= 0) & (meets | ~found)


def _perturbed_trial(query: OpenFace, k: Any) -> Any:
    return trial(query.frame.centre, k, 1)


PERTURBED = Question(_perturbed_score, homes, _perturbed_region, _perturbed_admits, _perturbed_trial)


def expand_perturbed(buckets: Buckets, faces: Face) -> Answer:
    """The fourth vertex of each face, or `NO_SITE` where no site is on its positive side."""
    corners = [sv.get(buckets.sites, v) for v in faces]
    queries = buckets.machine.map(open_perturbed_face, faces, *corners)
    return search_faces(buckets, queries, corners, PERTURBED)
