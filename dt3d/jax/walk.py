"""Visibility walks of many points at a time, in floating point, as one loop that JAX compiles.

A step crosses a facet only if the error bound of the determinant says that the point is beyond it. Such steps
never come back in a Delaunay triangulation (H. Edelsbrunner: An acyclicity theorem for cell complexes in d
dimensions, Combinatorica 10, 1990), so the walks end.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp

from .geometry import determinant, power_of_two

STARTS = 64  # simplices of which the nearest one begins a walk
# Shewchuk's bound for a 3 x 3 determinant of differences is 7 + O(eps) halves of the unit in the last place;
# this is more than twice as much, of a permanent that is rounded, too
ERROR = 8


class _Walks(NamedTuple):
    at: jax.Array  # (q,): where each walk is; -1 outside
    walking: jax.Array  # (q,)
    step: jax.Array


def walk(points: jax.Array, simplices: jax.Array, neighbors: jax.Array, xi: jax.Array) -> jax.Array:
    """The simplex of each query (q, d), or -1: int32 (q,); points (n, d), simplices (m, d + 1)."""
    dtype = jnp.result_type(points, xi)
    points, xi = points.astype(dtype), xi.astype(dtype)
    count = (simplices[:, 0] >= 0).sum()
    # padding would be walked into, so that a mesh without simplices is one of sites that are nowhere
    low, high = points.min(axis=0), points.max(axis=0)
    within = ((xi >= low) & (xi <= high)).all(axis=-1) & (count > 0)
    at = _nearest(points, simplices, count, xi)

    def going(walks: _Walks) -> jax.Array:
        return walks.walking.any() & (walks.step < len(simplices))

    def step(walks: _Walks) -> _Walks:
        ahead = _beyond(points, simplices[jnp.maximum(walks.at, 0)], xi, walks.step)
        moving = walks.walking & (ahead >= 0)
        following = neighbors[jnp.maximum(walks.at, 0), jnp.maximum(ahead, 0)]
        at = jnp.where(moving, following, walks.at)
        return _Walks(at, moving & (at >= 0), walks.step + 1)

    first = _Walks(jnp.where(within, at, -1), within, jnp.zeros((), jnp.int32))
    return jax.lax.while_loop(going, step, first).at


def _nearest(points: jax.Array, simplices: jax.Array, count: jax.Array, xi: jax.Array) -> jax.Array:
    """Of some simplices the one whose first vertex is nearest to each query: int32 (q,)."""
    starts = (jnp.arange(STARTS) * (count / STARTS)).astype(jnp.int32)
    sites = points[jnp.maximum(simplices[starts, 0], 0)]

    def nearer(k: int, best: tuple[jax.Array, jax.Array]) -> tuple[jax.Array, jax.Array]:
        distance = jnp.abs(xi - sites[k]).sum(axis=-1)
        closer = distance < best[0]
        return jnp.where(closer, distance, best[0]), jnp.where(closer, starts[k], best[1])

    first = jnp.full(len(xi), jnp.inf, xi.dtype), jnp.zeros(len(xi), jnp.int32)
    nearest: jax.Array = jax.lax.fori_loop(0, STARTS, nearer, first)[1]
    return nearest


def _beyond(points: jax.Array, corners: jax.Array, xi: jax.Array, turn: jax.Array) -> jax.Array:
    """A facet that each point is surely beyond, or -1. Each turn another one is looked at first."""
    d = xi.shape[-1]
    at = points[jnp.maximum(corners, 0)]
    beyond = []
    for k in range(d + 1):
        # the k-th vertex replaced by the point, seen from another vertex of the facet
        pivot = 0 if k else 1
        rows = at.at[:, k].set(xi) - at[:, pivot : pivot + 1]
        rows = jnp.delete(rows, pivot, axis=1, assume_unique_indices=True)
        rows = rows / power_of_two(rows)
        sign = -1 if pivot else 1
        beyond.append(sign * determinant(rows) < -ERROR * jnp.finfo(xi.dtype).eps * _permanent(rows))
    each = jnp.stack(beyond, axis=-1)
    order = (jnp.arange(d + 1) + turn) % (d + 1)
    turned = each[:, order]
    return jnp.where(turned.any(axis=-1), order[turned.argmax(axis=-1)], -1)


def _permanent(rows: jax.Array) -> jax.Array:
    """The sum of the magnitudes of a determinant's products."""
    a = jnp.abs(rows)
    if rows.shape[-1] == 2:
        return a[..., 0, 0] * a[..., 1, 1] + a[..., 0, 1] * a[..., 1, 0]
    minors = a[..., 1, jnp.array([1, 2, 0])] * a[..., 2, jnp.array([2, 0, 1])]
    minors += a[..., 1, jnp.array([2, 0, 1])] * a[..., 2, jnp.array([1, 2, 0])]
    return (a[..., 0, :] * minors).sum(axis=-1)
