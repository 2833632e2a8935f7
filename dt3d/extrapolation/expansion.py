"""Face expansion: the site on a face's positive side that forms a Delaunay tetrahedron with it.

Teng et al. 1993, section 4. The search is that of `search`; what is particular to faces is the region in
which a better site can lie: the part of the best circumsphere in the positive half-space, a spherical cap.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import jax.numpy as jnp

import scanvec as sv

from .boxes import Box, Grid, containment_box
from .buckets import Buckets
from .gift_wrapping import squared_distance_to_box
from .points import Point, add, dot, epsilon, sub
from .search import Answer, Question, search
from .signed_distance import Frame, circumsphere, frame, signed_distance


class Face(NamedTuple):
    """Sites a, b, c; the positive half-space is on the side of (b-a) x (c-a)."""

    a: Any
    b: Any
    c: Any


class OpenFace(NamedTuple):
    """An open face as a query: its frame and the box of its vertices."""

    frame: Frame
    low: Point
    high: Point


def open_face(a: Point, b: Point, c: Point) -> OpenFace:
    low = Point(*(jnp.minimum(jnp.minimum(u, v), w) for u, v, w in zip(a, b, c, strict=True)))
    high = Point(*(jnp.maximum(jnp.maximum(u, v), w) for u, v, w in zip(a, b, c, strict=True)))
    return OpenFace(frame(a, b, c), low, high)


def _score(query: OpenFace, site: Point, index: Any) -> Any:
    return signed_distance(query.frame, site)


def _first_box(query: OpenFace, grid: Grid) -> Box:
    """The containment box of a, b, c and their circumcentre, which may be a cell beyond them at most.

    Faces of slivers at the hull have circumcentres far away; opening all cells on the way would be in vain.
    """
    o = add(query.frame.origin, query.frame.centre)
    reach = grid.side
    low = Point(*(jnp.minimum(u, jnp.maximum(v, u - reach)) for u, v in zip(query.low, o, strict=True)))
    high = Point(*(jnp.maximum(u, jnp.minimum(v, u + reach)) for u, v in zip(query.high, o, strict=True)))
    return containment_box(low, high, grid)


def _region(query: OpenFace, score: Any, grid: Grid) -> Box:
    """The box of the cap; of the positive half-space within the grid while there is no candidate."""
    far_corner = Point(
        grid.origin.x + grid.nx * grid.side,
        grid.origin.y + grid.ny * grid.side,
        grid.origin.z + grid.nz * grid.side,
    )
    low, high = _half_space_bounds(query.frame, grid.origin, far_corner)
    found = jnp.isfinite(score)
    cap_low, cap_high = _cap_bounds(query.frame, jnp.where(found, score, 0))
    slack = grid.side * 1e-3
    low = Point(*(jnp.where(found, jnp.maximum(u, v), u) - slack for u, v in zip(low, cap_low, strict=True)))
    high = Point(
        *(jnp.where(found, jnp.minimum(u, v), u) + slack for u, v in zip(high, cap_high, strict=True))
    )
    return containment_box(low, high, grid)


def _half_space_bounds(face: Frame, low: Point, high: Point) -> tuple[Point, Point]:
    """Bounds of the part of the box from low to high that lies on the positive side of a face."""
    n = face.normal
    lo, hi = sub(low, face.origin), sub(high, face.origin)
    most = [jnp.maximum(m * u, m * v) for m, u, v in zip(n, lo, hi, strict=True)]
    total = most[0] + most[1] + most[2]
    new_low, new_high = [], []
    for axis in range(3):
        # n . x >= 0 with the other two coordinates at their most favourable
        m, rest = n[axis], total - most[axis]
        level = -rest / jnp.where(m == 0, 1, m) + face.origin[axis]
        new_low.append(jnp.where(m > 0, jnp.maximum(low[axis], level), low[axis]))
        new_high.append(jnp.where(m < 0, jnp.minimum(high[axis], level), high[axis]))
    return Point(*new_low), Point(*new_high)


def _cap_bounds(face: Frame, distance: Any) -> tuple[Point, Point]:
    """Bounds of the sphere of the given signed distance, as far as it is on the positive side of the face.

    Along an axis u the cap ends at the sphere's own extreme point where that is on the positive side,
    otherwise at the extreme point of the face's circumcircle.
    """
    centre, squared = circumsphere(face, distance)
    radius = jnp.sqrt(squared) * (1 + 16 * epsilon(face.origin))
    circle = add(face.origin, face.centre)
    circle_radius = jnp.sqrt(dot(face.centre, face.centre)) * (1 + 16 * epsilon(face.origin))
    low, high = [], []
    for axis in range(3):
        m = face.normal[axis]
        rim = circle_radius * jnp.sqrt(jnp.maximum(1 - m * m, 0))
        high.append(jnp.where(distance + radius * m >= 0, centre[axis] + radius, circle[axis] + rim))
        low.append(jnp.where(distance - radius * m >= 0, centre[axis] - radius, circle[axis] - rim))
    return Point(*low), Point(*high)


def _admits(query: OpenFace, score: Any, low: Point, high: Point) -> Any:
    """Whether a cell meets the positive half-space and, once there is a candidate, its circumsphere."""
    face = query.frame
    lo, hi = sub(low, face.origin), sub(high, face.origin)
    height = sum(jnp.maximum(m * u, m * v) for m, u, v in zip(face.normal, lo, hi, strict=True))
    found = jnp.isfinite(score)
    centre, squared = circumsphere(face, jnp.where(found, score, 0))
    # the squares lose what the coordinates have beyond an ulp of the radius
    slack = 64 * epsilon(face.origin) * (squared + dot(centre, centre))
    meets = squared_distance_to_box(centre, low, high) <= squared + slack
    return (height >= 0) & (meets | ~found)


EXPANSION = Question(score=_score, first_box=_first_box, region=_region, admits=_admits)


def expand(buckets: Buckets, faces: Face) -> Answer:
    """The fourth vertex of each face, or `NO_SITE` where no site is on its positive side."""
    machine = buckets.origin.machine
    a, b, c = (sv.get(buckets.sites, v) for v in faces)
    return search(buckets, machine.map(open_face, a, b, c), EXPANSION)
