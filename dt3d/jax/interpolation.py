"""Barycentric weights and the linear interpolant, as functions of sites, values and queries."""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax.typing import ArrayLike

from .geometry import away_from_zero, check_leading, checked, corners, determinant, for_each_set, power_of_two
from .location import Method, find_simplex
from .mesh import Mesh


def barycentric(points: ArrayLike, mesh: Mesh, found: ArrayLike, xi: ArrayLike) -> jax.Array:
    """The weights of the corners of simplices that make a point of them: (..., d + 1), with sum 1.

    Parameters
    ----------
    points : (..., n, d)
        Those of which the mesh is.
    mesh : Mesh
        Of those points.
    found : integers (...)
        The simplex of each query, as `find_simplex` gives it. Beginning with the leading dimensions of the
        points, as xi.
    xi : (..., d)
        The queries.

    Returns
    -------
    array (..., d + 1)
        Of the points' dtype; 0 where found is -1. In a simplex so flat that its determinant is nothing but
        rounding errors they are finite, see `circumcenters`.

    Examples
    --------
    >>> import jax.numpy as jnp, dt3d.jax
    >>> triangle = jnp.array([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]])
    >>> mesh = dt3d.jax.delaunay(triangle)
    >>> xi = jnp.array([[0.5, 1.0], [9.0, 9.0]])
    >>> found = dt3d.jax.find_simplex(triangle, mesh, xi)
    >>> weights = dt3d.jax.barycentric(triangle, mesh, found, xi)
    >>> weights.sum(axis=-1).tolist(), (weights[0] @ triangle[mesh.simplices[0]]).tolist()
    ([1.0, 0.0], [0.5, 1.0])
    """
    sites, sets = checked(points, mesh)
    rows, queries = jnp.asarray(found), jnp.asarray(xi, sites.dtype)
    check_leading("xi", queries, sites, sites.shape[-1])
    if rows.shape != queries.shape[:-1] or not jnp.issubdtype(rows.dtype, jnp.integer):
        msg = (
            f"found must be integers of shape {queries.shape[:-1]}, one per point of xi, got {rows.dtype} of "
            f"shape {rows.shape}"
        )
        raise ValueError(msg)
    return for_each_set(_barycentric, sets)(sites, mesh.simplices, rows, queries)


def _barycentric(points: jax.Array, simplices: jax.Array, found: jax.Array, xi: jax.Array) -> jax.Array:
    d = points.shape[-1]
    rows = found.reshape(-1)
    inside = rows >= 0
    own = jnp.where(inside[:, None], simplices[jnp.maximum(rows, 0)], -1)
    at = corners(points, own)
    edges = at[:, 1:] - at[:, :1]
    offset = jnp.where(inside[:, None], xi.reshape(-1, d) - at[:, 0], 0)
    scale = power_of_two(edges)
    edges, offset = edges / scale, offset / scale[:, 0]
    # Cramer's rule
    whole = away_from_zero(determinant(edges), edges)
    parts = [determinant(edges.at[:, k].set(offset)) / whole for k in range(d)]
    weights = jnp.stack([1 - sum(parts), *parts], axis=-1)
    return jnp.where(inside[:, None], weights, 0).reshape(*found.shape, d + 1)


def interpolate(
    points: ArrayLike,
    mesh: Mesh,
    values: ArrayLike,
    xi: ArrayLike,
    fill_value: float = jnp.nan,
    method: Method = "exact",
) -> jax.Array:
    """The linear interpolant of values at the sites, as `scipy.interpolate.LinearNDInterpolator`.

    It can be derived with respect to points, values and xi. The simplex that a query is in is a constant to
    derivatives; the interpolant is continuous over its border, and its gradient jumps there.

    Parameters
    ----------
    points : (..., n, d)
        Those of which the mesh is.
    mesh : Mesh
        Of those points.
    values : (..., n) or (..., n, ...)
        One or more for each site, after the leading dimensions of the points. Those of equal sites after the
        first are not used.
    xi : (..., d)
        Where, beginning with the leading dimensions of the points.
    fill_value : float
        Outside the hull, and where the status of the mesh is not 0. Its derivatives are 0.
    method : "exact" or "walk"
        Of `find_simplex`.

    Returns
    -------
    array
        For each query what a site has.

    Raises
    ------
    ValueError
        If shapes or dtypes do not fit; when the program is traced.

    Examples
    --------
    >>> import jax, jax.numpy as jnp, dt3d.jax
    >>> points = jax.random.uniform(jax.random.key(1), (50, 2))
    >>> mesh = dt3d.jax.delaunay(points)
    >>> heights = 3 * points[:, 0] - points[:, 1]
    >>> at = jnp.array([0.5, 0.5])
    >>> slope = jax.grad(lambda xi: dt3d.jax.interpolate(points, mesh, heights, xi))(at)
    >>> [round(component, 3) for component in slope.tolist()]
    [3.0, -1.0]
    """
    sites, sets = checked(points, mesh)
    given = jnp.asarray(values)
    if given.shape[: sets + 1] != sites.shape[:-1]:
        wanted = f"({', '.join(map(str, sites.shape[:-1]))}, ...)"
        msg = f"values must have shape {wanted}, one or more per site, got {given.shape}"
        raise ValueError(msg)
    dtype = jnp.result_type(given.dtype, sites.dtype)
    given, queries = given.astype(dtype), jnp.asarray(xi, sites.dtype)
    found = find_simplex(sites, mesh, queries, method=method)
    weights = barycentric(sites, mesh, found, queries)

    def combine(simplices: jax.Array, given: jax.Array, found: jax.Array, weights: jax.Array) -> jax.Array:
        at = given[jnp.maximum(simplices[jnp.maximum(found, 0)], 0)]
        trailing = [1] * (given.ndim - 1)
        sums = (weights.reshape(*weights.shape, *trailing) * at).sum(axis=found.ndim)
        return jnp.where((found >= 0).reshape(*found.shape, *trailing), sums, fill_value)

    return for_each_set(combine, sets)(mesh.simplices, given, found, weights)
