"""Faces look for their fourth vertices, a chunk at a time, each in one window of sites.

A first pass over the window finds a candidate, in plain floating point. A second one compares the bounds of
all other sites' signed distances with the candidate's, and looks whether the cap that could hold a better
site lies within the window. So a face is settled, or left to a wider search, or to exact decisions.
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp

from ..boxes import Box, contains
from ..exact.expansion import cap_cells
from ..exact.filtered_distance import Frame, distance_bounds, frame
from ..points import Point, add, dot, norm, scale, sub
from ..warrants import NO_SITE
from .windows import CELLS, Windows

SLOTS = 4  # sites examined in one turn of a loop
MOST_MEMBERS = 2**12 - SLOTS  # of a window that is searched; the number of a member fits what `_marked` has
# What becomes of a face.
FOUND, HULL, WIDER, TIE = 0, 1, 2, 3
AHEAD = 0.5  # where a window is centred: so many sides of a finest cell above the face
NOTHING = 1e300  # a signed distance beyond all others


class Expansion(NamedTuple):
    """The outcome for each face."""

    site: Any  # int32; NO_SITE unless found
    status: Any  # int32: FOUND, HULL, WIDER, TIE
    low: Any  # lower bound of the signed distance; inf for the hull, -inf where undecided
    high: Any  # the candidate's upper bound


def nothing_known(size: int) -> Expansion:
    return Expansion(
        jnp.full(size, NO_SITE, jnp.int32),
        jnp.full(size, WIDER, jnp.int32),
        jnp.full(size, -jnp.inf),
        jnp.full(size, jnp.inf),
    )


@partial(jax.jit, static_argnames="chunk")
def expand(
    sites: Point, face: Any, count: Any, lattice: Any, ahead: Any, windows: Windows, chunk: int
) -> tuple[Expansion, Any]:
    """The first ``count`` of the faces, three arrays of indices; and the number of sites examined.

    ``sites`` are three arrays of coordinates; ``ahead`` is a length, `AHEAD` cells.
    """

    def one_chunk(k: Any, state: Any) -> Any:
        out, searched = state
        start = k * chunk
        part = [jax.lax.dynamic_slice(v, (start,), (chunk,)) for v in face]
        active = jnp.arange(chunk) + start < count
        settled, more = _expand_chunk(sites, part, active, lattice, ahead, windows)
        write = jax.lax.dynamic_update_slice
        return jax.tree.map(lambda x, y: write(x, y, (start,)), out, settled), searched + more

    chunks = (count + chunk - 1) // chunk
    return jax.lax.fori_loop(0, chunks, one_chunk, (nothing_known(len(face[0])), jnp.int64(0)))


def at(array: Any, index: Any) -> Any:
    """Elements whose indices are known to exist."""
    return array.at[index].get(mode="promise_in_bounds")


def _expand_chunk(
    sites: Point, face: Any, active: Any, lattice: Any, ahead: Any, windows: Windows
) -> tuple[Expansion, Any]:
    a, b, c = (Point(*(at(x, v) for x in sites)) for v in face)
    query = frame(a, b, c, lattice)
    window, box = _window_about(query, ahead, windows)
    first = at(windows.starts, window)
    length = jnp.where(active, at(windows.starts, window + 1) - first, 0)
    small = length <= MOST_MEMBERS
    length = jnp.where(small, length, 0)
    most = jnp.max(length)

    def member(k: Any) -> tuple[Any, Any, Point]:
        site = at(windows.members, first + k)
        own = (site == face[0]) | (site == face[1]) | (site == face[2])
        return site, ~own & (k < length), Point(*(at(x, site) for x in sites))

    def propose(k: Any, best: Any) -> Any:
        _, counts, point = member(k)
        return jnp.minimum(best, _marked(jnp.where(counts, approximate(query, point), NOTHING), k))

    best = _loop(most, propose, jnp.full_like(query.blur, NOTHING))
    some = best < NOTHING / 2
    candidate = at(windows.members, first + jnp.clip(_mark(best), 0, jnp.maximum(length - 1, 0)))
    low, high = distance_bounds(query, Point(*(at(x, candidate) for x in sites)))
    low, high = jnp.where(some, low, jnp.inf), jnp.where(some, high, jnp.inf)

    def rivals(k: Any, count: Any) -> Any:
        site, counts, point = member(k)
        least, _ = distance_bounds(query, point)
        return count + (counts & ~(some & (site == candidate)) & (least < jnp.inf) & ~(least > high))

    others = _loop(most, rivals, jnp.zeros_like(first))
    covered = contains(box, cap_cells(query, high, windows.grid)) & small
    return settle(covered, others == 0, some, candidate, low, high), jnp.sum(length.astype(jnp.int64))


def settle(covered: Any, alone: Any, some: Any, candidate: Any, low: Any, high: Any) -> Expansion:
    """What becomes of faces: the region searched, no rival left, a candidate and its bounds."""
    decided = jnp.where(alone, jnp.where(some, FOUND, HULL), TIE)
    status = jnp.where(covered, decided, WIDER).astype(jnp.int32)
    return Expansion(
        jnp.where(status == FOUND, candidate, NO_SITE),
        status,
        jnp.where(status <= HULL, low, -jnp.inf),
        high,
    )


def approximate(query: Frame, point: Point) -> Any:
    """The signed distance of a point that seems above the face, otherwise `NOTHING`."""
    w = sub(point, query.origin)
    height = dot(query.normal, w)
    beside = sub(sub(w, query.centre), query.centre)
    return jnp.where(height > 0, dot(w, beside) / height, NOTHING)


def _loop(most: Any, body: Any, start: Any) -> Any:
    """The body for 0, 1, ... up to ``most`` or a few more."""

    def turn(state: Any) -> Any:
        k, value = state
        for j in range(SLOTS):
            value = body(k + j, value)
        return k + SLOTS, value

    return jax.lax.while_loop(lambda state: state[0] < most, turn, (jnp.int32(0), start))[1]


def _marked(x: Any, k: Any) -> Any:
    """x with its last twelve bits replaced by k: a minimum of such numbers is a value and its place.

    One array to reduce instead of two; XLA would compute the distances once for each.
    """
    bits = jax.lax.bitcast_convert_type(x, jnp.int64)
    return jax.lax.bitcast_convert_type((bits & ~jnp.int64(4095)) | k, jnp.float64)


def _mark(x: Any) -> Any:
    return (jax.lax.bitcast_convert_type(x, jnp.int64) & 4095).astype(jnp.int32)


def _window_about(query: Frame, ahead: Any, windows: Windows) -> tuple[Any, Box]:
    """The window about the place where a face's fourth vertex is expected, and its cells."""
    grid = windows.grid
    place = add(add(query.origin, query.centre), scale(ahead / norm(query.normal), query.normal))
    corner = []
    shape = (windows.nx, windows.ny, windows.nz)
    for x, low, high, n in zip(place, grid.origin, grid.high, shape, strict=True):
        first = jnp.round((jnp.clip(x, low, high) - low) / grid.side - CELLS / 2)
        corner.append(jnp.where(jnp.isnan(first), 0, jnp.clip(first, 0, n - 1)).astype(jnp.int32))
    i, j, k = corner
    last = [
        jnp.minimum(c + CELLS, cells) - 1
        for c, cells in zip(corner, (grid.nx, grid.ny, grid.nz), strict=True)
    ]
    return i + windows.nx * (j + windows.ny * k), Box(i, last[0], j, last[1], k, last[2])
