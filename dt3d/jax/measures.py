"""Volumes, circumcentres and circumradii of the simplices, as functions of the sites that JAX derives."""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax.typing import ArrayLike

from .geometry import away_from_zero, determinant, per_simplex, power_of_two
from .mesh import Mesh


def volumes(points: ArrayLike, mesh: Mesh) -> jax.Array:
    """The volume of each tetrahedron, or the area of each triangle: (..., capacity), 0 in the padding.

    Parameters
    ----------
    points : (..., n, d)
        Those of which the mesh is, or where they have moved to: a simplex that has turned over is negative.
    mesh : Mesh
        Of one set or of as many as the points.

    Examples
    --------
    >>> import jax, jax.numpy as jnp, dt3d.jax
    >>> square = jnp.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    >>> mesh = dt3d.jax.delaunay(square, capacity=3)
    >>> dt3d.jax.volumes(square, mesh).tolist()
    [0.5, 0.5, 0.0]
    >>> jax.grad(lambda points: dt3d.jax.volumes(points, mesh).sum())(square).tolist()
    [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]]
    """

    def volume(corners: jax.Array) -> jax.Array:
        edges = corners[:, 1:] - corners[:, :1]
        return determinant(edges) / (6 if edges.shape[-1] == 3 else 2)

    return per_simplex(volume, points, mesh)


def circumcenters(points: ArrayLike, mesh: Mesh) -> jax.Array:
    """The centre of the sphere through the corners of each simplex: (..., capacity, d), 0 in the padding.

    A simplex may be so flat that its determinant, as computed, is nothing but rounding errors: less than 8
    units in the last place of the product of the lengths of its edges from the first vertex. It is then
    computed as if the determinant had that magnitude. So the centre is finite, at a distance of up to some
    10^6 times the simplex in float32 and 10^15 in float64, and so is its derivative, to which this
    determinant is a constant.

    Parameters
    ----------
    points : (..., n, d)
        Those of which the mesh is, or where they have moved to.
    mesh : Mesh
        Of one set or of as many as the points.

    Examples
    --------
    >>> import jax.numpy as jnp, dt3d.jax
    >>> triangle = jnp.array([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]])
    >>> dt3d.jax.circumcenters(triangle, dt3d.jax.delaunay(triangle, capacity=2)).tolist()
    [[1.0, 1.0], [0.0, 0.0]]
    """

    def center(corners: jax.Array) -> jax.Array:
        offset, scale = _to_center(corners)
        return corners[:, 0] + scale * offset

    return per_simplex(center, points, mesh)


def circumradii(points: ArrayLike, mesh: Mesh) -> jax.Array:
    """The radius of the sphere through the corners of each simplex: (..., capacity), 0 in the padding.

    For simplices that are nearly flat see `circumcenters`.

    Parameters
    ----------
    points : (..., n, d)
        Those of which the mesh is, or where they have moved to.
    mesh : Mesh
        Of one set or of as many as the points.

    Examples
    --------
    >>> import jax.numpy as jnp, dt3d.jax
    >>> triangle = jnp.array([[0.0, 0.0], [6.0, 0.0], [0.0, 8.0]])
    >>> dt3d.jax.circumradii(triangle, dt3d.jax.delaunay(triangle, capacity=2)).tolist()
    [5.0, 0.0]
    """

    def radius(corners: jax.Array) -> jax.Array:
        offset, scale = _to_center(corners)
        squared = (offset**2).sum(axis=-1)
        # the root of 0 has no derivative
        some = squared > 0
        return jnp.where(some, scale[:, 0] * jnp.sqrt(jnp.where(some, squared, 1)), 0)

    return per_simplex(radius, points, mesh)


def _to_center(corners: jax.Array) -> tuple[jax.Array, jax.Array]:
    """From the first corner (m, d + 1, d) to the centre, as a vector (m, d) times a power of two (m, 1)."""
    edges = corners[:, 1:] - corners[:, :1]
    scale = power_of_two(edges)
    edges = edges / scale
    squared = (edges**2).sum(axis=-1, keepdims=True)
    if edges.shape[-1] == 2:
        # a quarter turn of each edge times the square of the other
        turned = jnp.stack([edges[..., 1], -edges[..., 0]], axis=-1)
        sums = squared[:, 0] * turned[:, 1] - squared[:, 1] * turned[:, 0]
    else:
        sums = (squared * jnp.cross(jnp.roll(edges, -1, axis=1), jnp.roll(edges, -2, axis=1))).sum(axis=1)
    return sums / (2 * away_from_zero(determinant(edges), edges))[:, None], scale[:, 0]
