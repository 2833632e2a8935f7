"""Faces look for their fourth vertices, a chunk at a time, each in one window of sites.

A first pass over the window finds a candidate, in plain floating point. A second one compares the bounds of
all other sites' signed distances with the candidate's, and looks whether the cap that could hold a better
site lies within the window. So a face is settled, or left to a wider search, or to exact decisions.
"""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
from jax import Array

from ..boxes import contains
from ..exact.expansion import cap_cells
from ..exact.filtered_distance import Frame, distance_bounds, frame
from ..points import Point, dot, sub
from .chunks import UNROLLED, Faces, at, expand_chunks, points_at, unrolled
from .stages import Batch, Expansion, settle
from .tables import Tables
from .windows import window_ahead

# Of a window that is searched: the number of a member fits what `_with_number` has.
MOST_MEMBERS = 2**12 - UNROLLED
BEYOND_ALL = 1e300  # a signed distance beyond all others


@partial(jax.jit, static_argnames="chunk")
def expand_in_windows(tables: Tables, batch: Batch, chunk: int) -> tuple[Expansion, Array]:
    """The outcome for the faces of a batch; and the number of sites examined."""
    return expand_chunks(partial(_expand_chunk, tables), batch, chunk)


def _expand_chunk(tables: Tables, faces: Faces) -> tuple[Expansion, Array]:
    points, windows, face = tables.points, tables.windows, faces.face
    a, b, c = (points_at(points, v) for v in face)
    query = frame(a, b, c, tables.lattice)
    window, box = window_ahead(query, tables.ahead, windows)
    first = at(windows.starts, window)
    length = jnp.where(faces.active, at(windows.starts, window + 1) - first, 0)
    small = length <= MOST_MEMBERS
    length = jnp.where(small, length, 0)
    most = jnp.max(length)

    def member(k: Array) -> tuple[Array, Array, Point[Array]]:
        site = at(windows.members, first + k)
        own = (site == face.a) | (site == face.b) | (site == face.c)
        return site, ~own & (k < length), points_at(points, site)

    def propose(k: Array, best: Array) -> Array:
        _, counts, point = member(k)
        distance = jnp.where(counts, _approximate_distance(query, point), BEYOND_ALL)
        return jnp.minimum(best, _with_number(distance, k))

    best = unrolled(most, propose, jnp.full_like(query.centre_error, BEYOND_ALL))
    some = best < BEYOND_ALL / 2
    candidate = at(windows.members, first + jnp.clip(_number_in(best), 0, jnp.maximum(length - 1, 0)))
    low, high = distance_bounds(query, points_at(points, candidate))
    low, high = jnp.where(some, low, jnp.inf), jnp.where(some, high, jnp.inf)

    def count_rival(k: Array, count: Array) -> Array:
        site, counts, point = member(k)
        least, _ = distance_bounds(query, point)
        return count + (counts & ~(some & (site == candidate)) & (least < jnp.inf) & ~(least > high))

    rivals = unrolled(most, count_rival, jnp.zeros_like(first))
    covered = contains(box, cap_cells(query, high, windows.grid)) & small
    return settle(covered, rivals == 0, some, candidate, low, high), jnp.sum(length.astype(jnp.int64))


def _approximate_distance(query: Frame, point: Point[Array]) -> Array:
    """The signed distance of a point that seems above the face, otherwise `BEYOND_ALL`."""
    w = sub(point, query.origin)
    height = dot(query.normal, w)
    beside = sub(sub(w, query.centre), query.centre)
    return jnp.where(height > 0, dot(w, beside) / height, BEYOND_ALL)


def _with_number(x: Array, k: Array) -> Array:
    """x with its last twelve bits replaced by k: a minimum of such numbers is a value and its place.

    One array to reduce instead of two; XLA would compute the distances once for each.
    """
    bits = jax.lax.bitcast_convert_type(x, jnp.int64)
    return jax.lax.bitcast_convert_type((bits & ~jnp.int64(4095)) | k, jnp.float64)


def _number_in(x: Array) -> Array:
    bits: Array = jax.lax.bitcast_convert_type(x, jnp.int64)
    return (bits & 4095).astype(jnp.int32)
