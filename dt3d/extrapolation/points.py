"""Points and vectors of space as records of three coordinates, for elementwise code.

Teng et al. 1993, section 2.4.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Generic, NamedTuple, TypeVar, cast

import jax.numpy as jnp
from jax import Array

# A number of one element inside `scanvec.map`, jax.Array; a scanvec.Vector of them outside it.
T = TypeVar("T")


class Point(NamedTuple, Generic[T]):
    """x, y, z: scalars inside `scanvec.map`, scanvec vectors outside it."""

    x: T
    y: T
    z: T


def sub(p: Point[Array], q: Point[Array]) -> Point[Array]:
    """The vector from q to p."""
    return Point(p.x - q.x, p.y - q.y, p.z - q.z)


def add(p: Point[Array], q: Point[Array]) -> Point[Array]:
    """The sum of two vectors."""
    return Point(p.x + q.x, p.y + q.y, p.z + q.z)


def scale(s: Array | float, p: Point[Array]) -> Point[Array]:
    """A vector times a number."""
    return Point(s * p.x, s * p.y, s * p.z)


def dot(p: Point[Array], q: Point[Array]) -> Array:
    """The scalar product."""
    return p.x * q.x + p.y * q.y + p.z * q.z


def cross(p: Point[Array], q: Point[Array]) -> Point[Array]:
    """The vector product."""
    return Point(p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x)


def norm(p: Point[Array]) -> Array:
    """The length of a vector."""
    return jnp.sqrt(dot(p, p))


def total(terms: Iterable[Array]) -> Array:
    """The sum of some numbers."""
    return cast(Array, sum(terms))


def epsilon(x: Array) -> float:
    """The unit roundoff (half an ulp of 1) of a number's dtype."""
    eps: float = jnp.finfo(jnp.asarray(x).dtype).eps / 2  # type: ignore[assignment]
    return eps


def bounding_box(*points: Point[Array]) -> tuple[Point[Array], Point[Array]]:
    """Lowest and highest corner of the box of some points."""
    low = Point(*(jnp.min(jnp.stack(x)) for x in zip(*points, strict=True)))
    high = Point(*(jnp.max(jnp.stack(x)) for x in zip(*points, strict=True)))
    return low, high
