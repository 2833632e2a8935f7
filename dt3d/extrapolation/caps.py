"""Where a better site can lie: the part of a sphere on the positive side of a face, a spherical cap.

Teng et al. 1993, section 4.2, open the containment box of the circumsphere. The box of the cap is smaller.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import Array

from .boxes import Box, Grid, containment_box
from .points import Point, add, dot, epsilon, norm, scale, sub


class Plane(NamedTuple):
    """The plane of a face, the positive side of which is searched."""

    origin: Point[Array]  # a vertex of the face
    normal: Point[Array]  # of any length
    normal_error: Point[Array]  # what that is known to, coordinate by coordinate


def cap_box(
    plane: Plane, centre: Point[Array], distance: Array, margin: Array, grid: Grid[Array]
) -> Box[Array]:
    """The cells of a cap; of the positive half-space within the sites' box where ``distance`` is not finite.

    Parameters
    ----------
    plane : Plane
        Of the face.
    centre : Point
        Of the face's circumcircle, relative to the plane's origin.
    distance : Array
        From there to the centre of the sphere, in units of the normal's length.
    margin : Array
        How far the cap may extend beyond what is computed here.
    grid : Grid
        The cells.
    """
    low, high = half_space_bounds(plane, grid.origin, grid.high)
    found = jnp.isfinite(distance)
    cap_low, cap_high = _cap_bounds(plane, centre, jnp.where(found, distance, 0))
    rounding = cell_margin(grid)
    # fmax and fmin leave out bounds that are not numbers
    lower = (jnp.where(found, jnp.fmax(u, v - margin), u) for u, v in zip(low, cap_low, strict=True))
    upper = (jnp.where(found, jnp.fmin(u, v + margin), u) for u, v in zip(high, cap_high, strict=True))
    low, high = Point(*(x - rounding for x in lower)), Point(*(x + rounding for x in upper))
    return containment_box(low, high, grid)


def cell_margin(grid: Grid[Array]) -> Array:
    """How far a region is widened before its cells are taken, so that roundings leave none out."""
    return grid.side * 1e-3 + grid.margin


def half_space_bounds(
    plane: Plane, low: Point[Array], high: Point[Array]
) -> tuple[Point[Array], Point[Array]]:
    """Bounds of the part of the box from low to high that may lie on the positive side of a face."""
    origin, normal, normal_error = plane
    lo, hi = sub(low, origin), sub(high, origin)
    most = [
        jnp.maximum(n * u, n * v) + p * jnp.maximum(jnp.abs(u), jnp.abs(v))
        for n, p, u, v in zip(normal, normal_error, lo, hi, strict=True)
    ]
    new_low, new_high = [], []
    for axis in range(3):
        # n . x >= 0 with the other two coordinates at their most favourable
        rest = most[(axis + 1) % 3] + most[(axis + 2) % 3]
        n, p = normal[axis], normal_error[axis]
        gentle, steep = jnp.abs(n) - p, jnp.abs(n) + p
        positive = jnp.where(gentle > 0, rest / jnp.where(gentle > 0, gentle, 1), jnp.inf)
        extent = jnp.where(rest >= 0, positive, rest / jnp.where(steep > 0, steep, 1))
        new_low.append(jnp.fmax(low[axis], jnp.where(n > 0, origin[axis] - extent, low[axis])))
        new_high.append(jnp.fmin(high[axis], jnp.where(n < 0, origin[axis] + extent, high[axis])))
    return Point(*new_low), Point(*new_high)


def _cap_bounds(plane: Plane, centre: Point[Array], distance: Array) -> tuple[Point[Array], Point[Array]]:
    """Bounds of a sphere as far as it is on the positive side of the face.

    Along an axis the cap ends at the sphere's own extreme point where that is on the positive side,
    otherwise at the extreme point of the face's circumcircle.
    """
    origin, normal, _ = plane
    length = norm(normal)
    m = scale(1 / length, normal)
    height = distance * length
    widening = 1 + 16 * epsilon(origin.x)
    ball = add(origin, add(centre, scale(distance, normal)))
    radius = jnp.sqrt(dot(centre, centre) + height * height) * widening
    circle = add(origin, centre)
    circle_radius = norm(centre) * widening
    low, high = [], []
    for axis in range(3):
        rim = circle_radius * jnp.sqrt(m[axis - 1] * m[axis - 1] + m[axis - 2] * m[axis - 2])
        high.append(jnp.where(height + radius * m[axis] >= 0, ball[axis] + radius, circle[axis] + rim))
        low.append(jnp.where(height - radius * m[axis] >= 0, ball[axis] - radius, circle[axis] - rim))
    return Point(*low), Point(*high)
