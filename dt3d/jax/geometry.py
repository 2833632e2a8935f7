"""What is computed from the corners of simplices; without overflow, and with gradients in the padding."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import jax
import jax.numpy as jnp
from jax.typing import ArrayLike

from .mesh import Mesh

# of the product of the lengths of its columns, in units of the last place: below this a determinant is made
# of rounding errors
FLATTEST = 8


def for_each_set(f: Callable[..., jax.Array], sets: int) -> Callable[..., jax.Array]:
    """The function of one set as one of arrays with that many leading dimensions more."""
    for _ in range(sets):
        f = jax.vmap(f)
    return f


def checked(points: ArrayLike, mesh: Mesh) -> tuple[jax.Array, int]:
    """The points as an array, and how many leading dimensions they and the mesh have.

    Raises
    ------
    ValueError
        If they do not fit each other.
    """
    sites, simplices = jnp.asarray(points), mesh.simplices
    fitting = sites.ndim >= 2 and (*sites.shape[:-2], sites.shape[-1] + 1) == (
        *simplices.shape[:-2],
        simplices.shape[-1],
    )
    if not fitting or not jnp.issubdtype(sites.dtype, jnp.floating):
        msg = (
            f"points must be those of the mesh, floats of shape {_expected(simplices.shape)}, got "
            f"{sites.dtype} of shape {sites.shape}; for other leading dimensions use jax.vmap"
        )
        raise ValueError(msg)
    return sites, sites.ndim - 2


def check_leading(name: str, array: jax.Array, points: jax.Array, d: int | None = None) -> None:
    """Raise a ValueError unless the array begins with the points' leading dimensions, and ends with d."""
    batch = points.shape[:-2]
    ends = d is None or (array.ndim > len(batch) and array.shape[-1] == d)
    if array.shape[: len(batch)] != batch or not ends:
        wanted = ", ".join([*map(str, batch), "...", *([] if d is None else [str(d)])])
        msg = f"{name} must have shape ({wanted}), got {array.shape}"
        if batch:
            msg += "; for other leading dimensions use jax.vmap"
        raise ValueError(msg)


def _expected(shape: tuple[int, ...]) -> str:
    return f"({', '.join([*map(str, shape[:-2]), 'n', str(shape[-1] - 1)])})"


def corners(points: jax.Array, simplices: jax.Array) -> jax.Array:
    """The corners of simplices (m, d + 1): (m, d + 1, d), those of a unit simplex for rows of -1.

    So nothing is divided by zero in the padding, where a derivative would make NaN of what is left out.
    """
    d = points.shape[-1]
    unit = jnp.concatenate([jnp.zeros((1, d)), jnp.eye(d)]).astype(points.dtype)
    return jnp.where(simplices[:, :, None] >= 0, points[jnp.maximum(simplices, 0)], unit)


def determinant(rows: jax.Array) -> jax.Array:
    """The determinants of matrices (..., d, d) of two or three rows."""
    if rows.shape[-1] == 2:
        u, v = rows[..., 0, :], rows[..., 1, :]
        return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return (rows[..., 0, :] * jnp.cross(rows[..., 1, :], rows[..., 2, :])).sum(axis=-1)


def power_of_two(vectors: jax.Array) -> jax.Array:
    """The power of two below the greatest coordinate of each set of vectors (..., k, d): (..., 1, 1).

    A constant to derivatives. Divided by it coordinates are below 2, without rounding, so that their products
    neither overflow nor underflow.
    """
    greatest = jnp.abs(jax.lax.stop_gradient(vectors)).max(axis=(-2, -1), keepdims=True)
    info = jnp.finfo(greatest.dtype)
    # the exponent alone
    words = jax.lax.bitcast_convert_type(greatest, f"int{info.bits}")
    words = words >> info.nmant << info.nmant
    return jnp.maximum(jax.lax.bitcast_convert_type(words, greatest.dtype), info.tiny)


def away_from_zero(determinants: jax.Array, rows: jax.Array) -> jax.Array:
    """The determinants of rows (..., d, d), those that are nothing but rounding errors made a bit greater.

    Their magnitude becomes at least `FLATTEST` units in the last place of the product of the rows' lengths.
    """
    squared = jax.lax.stop_gradient((rows**2).sum(axis=-1))
    info = jnp.finfo(rows.dtype)
    least = FLATTEST * info.eps * jnp.sqrt(squared).prod(axis=-1) + info.tiny
    clamped = jnp.where(determinants < 0, -least, least)
    return jnp.where(jnp.abs(determinants) < least, clamped, determinants)


def per_simplex(f: Callable[[jax.Array], jax.Array], points: ArrayLike, mesh: Mesh) -> jax.Array:
    """A function of corners (m, d + 1, d) for the simplices of each set."""
    sites, sets = checked(points, mesh)
    return for_each_set(partial(_per_simplex, f), sets)(sites, mesh.simplices)


def _per_simplex(f: Callable[[jax.Array], jax.Array], points: jax.Array, simplices: jax.Array) -> jax.Array:
    values = f(corners(points, simplices))
    valid = (simplices[:, 0] >= 0).reshape(-1, *[1] * (values.ndim - 1))
    return jnp.where(valid, values, 0)
