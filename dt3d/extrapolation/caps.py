"""Where a better site can lie: the part of a sphere on the positive side of a face, a spherical cap."""

from __future__ import annotations

from typing import Any

import jax.numpy as jnp

from .boxes import Box, Grid, containment_box
from .points import Point, add, dot, epsilon, norm, scale, sub


def cap_box(
    origin: Point, normal: Point, doubt: Point, centre: Point, distance: Any, slack: Any, grid: Grid
) -> Box:
    """The cells of a cap; of the positive half-space within the sites' box where ``distance`` is not finite.

    Parameters
    ----------
    origin, normal, doubt
        A vertex of the face, its normal of any length, and what that is known to.
    centre : Point
        Of the face's circumcircle, relative to the origin.
    distance
        From there to the centre of the sphere, in units of the normal's length.
    slack
        How far the cap may extend beyond what is computed here.
    """
    low, high = half_space_bounds(origin, normal, doubt, grid.origin, grid.high)
    found = jnp.isfinite(distance)
    cap_low, cap_high = _cap_bounds(origin, normal, centre, jnp.where(found, distance, 0))
    room = grid.side * 1e-3 + grid.slack
    # fmax and fmin leave out bounds that are not numbers
    lower = (jnp.where(found, jnp.fmax(u, v - slack), u) for u, v in zip(low, cap_low, strict=True))
    upper = (jnp.where(found, jnp.fmin(u, v + slack), u) for u, v in zip(high, cap_high, strict=True))
    low, high = Point(*(x - room for x in lower)), Point(*(x + room for x in upper))
    return containment_box(low, high, grid)


def half_space_bounds(
    origin: Point, normal: Point, doubt: Point, low: Point, high: Point
) -> tuple[Point, Point]:
    """Bounds of the part of the box from low to high that may lie on the positive side of a face."""
    lo, hi = sub(low, origin), sub(high, origin)
    most = [
        jnp.maximum(n * u, n * v) + p * jnp.maximum(jnp.abs(u), jnp.abs(v))
        for n, p, u, v in zip(normal, doubt, lo, hi, strict=True)
    ]
    new_low, new_high = [], []
    for axis in range(3):
        # n . x >= 0 with the other two coordinates at their most favourable
        rest = most[(axis + 1) % 3] + most[(axis + 2) % 3]
        n, p = normal[axis], doubt[axis]
        gentle, steep = jnp.abs(n) - p, jnp.abs(n) + p
        positive = jnp.where(gentle > 0, rest / jnp.where(gentle > 0, gentle, 1), jnp.inf)
        reach = jnp.where(rest >= 0, positive, rest / jnp.where(steep > 0, steep, 1))
        new_low.append(jnp.fmax(low[axis], jnp.where(n > 0, origin[axis] - reach, low[axis])))
        new_high.append(jnp.fmin(high[axis], jnp.where(n < 0, origin[axis] + reach, high[axis])))
    return Point(*new_low), Point(*new_high)


def _cap_bounds(origin: Point, normal: Point, centre: Point, distance: Any) -> tuple[Point, Point]:
    """Bounds of a sphere as far as it is on the positive side of the face.

    Along an axis the cap ends at the sphere's own extreme point where that is on the positive side,
    otherwise at the extreme point of the face's circumcircle.
    """
    length = norm(normal)
    m = scale(1 / length, normal)
    height = distance * length
    wide = 1 + 16 * epsilon(origin.x)
    ball = add(origin, add(centre, scale(distance, normal)))
    radius = jnp.sqrt(dot(centre, centre) + height * height) * wide
    circle = add(origin, centre)
    circle_radius = norm(centre) * wide
    low, high = [], []
    for axis in range(3):
        rim = circle_radius * jnp.sqrt(m[axis - 1] * m[axis - 1] + m[axis - 2] * m[axis - 2])
        high.append(jnp.where(height + radius * m[axis] >= 0, ball[axis] + radius, circle[axis] + rim))
        low.append(jnp.where(height - radius * m[axis] >= 0, ball[axis] - radius, circle[axis] - rim))
    return Point(*low), Point(*high)
