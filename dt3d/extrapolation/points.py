"""Points and vectors of space as records of three coordinates, for elementwise code."""

from __future__ import annotations

from typing import Any, NamedTuple

import jax.numpy as jnp


class Point(NamedTuple):
    """x, y, z: scalars inside `scanvec.map`, scanvec vectors outside it."""

    x: Any
    y: Any
    z: Any


def sub(p: Point, q: Point) -> Point:
    return Point(p.x - q.x, p.y - q.y, p.z - q.z)


def add(p: Point, q: Point) -> Point:
    return Point(p.x + q.x, p.y + q.y, p.z + q.z)


def scale(s: Any, p: Point) -> Point:
    return Point(s * p.x, s * p.y, s * p.z)


def dot(p: Point, q: Point) -> Any:
    return p.x * q.x + p.y * q.y + p.z * q.z


def cross(p: Point, q: Point) -> Point:
    return Point(p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x)


def norm(p: Point) -> Any:
    return jnp.sqrt(dot(p, p))


def epsilon(x: Any) -> Any:
    """The unit roundoff (half an ulp of 1) of a number's dtype."""
    return jnp.finfo(jnp.asarray(x).dtype).eps / 2


def bounding_box(*points: Point) -> tuple[Point, Point]:
    """Lowest and highest corner of the box of some points."""
    low = Point(*(jnp.min(jnp.stack(x)) for x in zip(*points, strict=True)))
    high = Point(*(jnp.max(jnp.stack(x)) for x in zip(*points, strict=True)))
    return low, high
