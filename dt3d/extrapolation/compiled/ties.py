"""Ties: faces for which the bounds leave several sites of a window, decided by integers.

Each face marks the sites that its bound leaves. Then all take one of theirs at a time: an orientation tells
whether it is above the face, an in-sphere test whether it beats the best so far. The symbolic perturbation
lets one of them beat all others.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp

from ...predicates.traced import one_case
from ..boxes import Box, contains
from ..exact.expansion import cap_cells
from ..exact.filtered_distance import distance_bounds, frame
from ..points import Point
from ..warrants import NO_SITE
from .expand import FOUND, HULL, WIDER, Expansion, _loop, at, nothing_known
from .windows import CELLS, Windows

WORDS = 4  # of 32 marks; windows with more members are left to others
MARKS = 32 * WORDS


@partial(jax.jit, static_argnames="chunk")
def expand_ties(
    sites: Point,
    digits: Any,
    rank: Any,
    face: Any,
    bound: Any,
    count: Any,
    lattice: Any,
    windows: Windows,
    chunk: int,
) -> tuple[Expansion, Any]:
    """The first ``count`` of the faces, as `expand` takes them; `WIDER` where the window is not enough.

    ``bound`` is an upper bound of the signed distance, the window that about the cap below it. ``digits`` are
    three arrays of int32 (L, n), one for each coordinate; ``rank`` is each site's place in the lexicographic
    order.
    """

    def one_chunk(k: Any, state: Any) -> Any:
        out, searched = state
        start = k * chunk
        *part, below = (jax.lax.dynamic_slice(v, (start,), (chunk,)) for v in (*face, bound))
        active = jnp.arange(chunk) + start < count
        settled, more = _decide(sites, digits, rank, part, below, active, lattice, windows)
        write = jax.lax.dynamic_update_slice
        return jax.tree.map(lambda x, y: write(x, y, (start,)), out, settled), searched + more

    chunks = (count + chunk - 1) // chunk
    return jax.lax.fori_loop(0, chunks, one_chunk, (nothing_known(len(face[0])), jnp.int64(0)))


def _decide(
    sites: Point, digits: Any, rank: Any, face: Any, bound: Any, active: Any, lattice: Any, windows: Windows
) -> tuple[Expansion, Any]:
    a, b, c = (Point(*(at(x, v) for x in sites)) for v in face)
    query = frame(a, b, c, lattice)
    window, box = _window_around(cap_cells(query, bound, windows.grid), windows)
    first = at(windows.starts, window)
    length = jnp.where(active, at(windows.starts, window + 1) - first, 0)
    small = length <= MARKS
    length = jnp.where(small, length, 0)
    most = jnp.max(length)

    def bounds(k: Any) -> tuple[Any, Any]:
        site = at(windows.members, first + k)
        own = (site == face[0]) | (site == face[1]) | (site == face[2])
        low, high = distance_bounds(query, Point(*(at(x, site) for x in sites)))
        passed = own | (k >= length)
        return jnp.where(passed, jnp.inf, low), jnp.where(passed, jnp.inf, high)

    infinite = jnp.full_like(query.blur, jnp.inf)
    high = _loop(most, lambda k, best: jnp.minimum(best, bounds(k)[1]), infinite)

    def mark(word: int) -> Any:
        def body(k: Any, marks: Any) -> Any:
            low, _ = bounds(32 * word + k)
            stays = (low < jnp.inf) & ~(low > high)
            return marks | jnp.where(stays, jnp.left_shift(jnp.uint32(1), k.astype(jnp.uint32)), 0)

        return _loop(jnp.clip(most - 32 * word, 0, 32), body, jnp.zeros(len(first), jnp.uint32))

    def compare(state: Any) -> Any:
        marks, champion = state
        place, left, rest = jnp.full_like(first, -1), [], jnp.zeros_like(active)
        for word, m in enumerate(marks):
            chosen = ~rest & (m != 0)
            bit = m & (~m + 1)
            lowest = (31 - jax.lax.clz(bit)).astype(jnp.int32)
            place = jnp.where(chosen, 32 * word + lowest, place)
            left.append(jnp.where(chosen, m ^ bit, m))
            rest |= chosen
        challenger = at(windows.members, first + jnp.maximum(place, 0))
        corners = [_digits_of(digits, v) for v in face]
        there = _digits_of(digits, challenger)
        above = rest & (jax.vmap(one_case.orient3d)(corners[0], corners[1], corners[2], there) > 0)
        some = champion != NO_SITE
        apex = jnp.where(some, champion, challenger)
        vertices = (*corners, _digits_of(digits, apex))
        ranks = tuple(at(rank, v) for v in (*face, apex))
        wins = jax.vmap(one_case.inside)(vertices, ranks, there, at(rank, challenger))
        return tuple(left), jnp.where(above & (~some | wins), challenger, champion)

    def unfinished(state: Any) -> Any:
        return jnp.any(jnp.stack([m != 0 for m in state[0]]))

    # ends after at most `MARKS` turns: in each every face that is not finished loses a mark
    marks = tuple(mark(w) for w in range(WORDS))
    _, champion = jax.lax.while_loop(unfinished, compare, (marks, jnp.full_like(first, NO_SITE)))
    covered = contains(box, cap_cells(query, high, windows.grid)) & small
    status = jnp.where(covered, jnp.where(champion != NO_SITE, FOUND, HULL), WIDER).astype(jnp.int32)
    site = jnp.where(status == FOUND, champion, NO_SITE)
    settled = Expansion(site, status, jnp.where(status == HULL, jnp.inf, -jnp.inf), high)
    return settled, jnp.sum(length.astype(jnp.int64))


def _window_around(cap: Box, windows: Windows) -> tuple[Any, Box]:
    """The window with a box of cells in its middle, and its cells."""
    grid = windows.grid
    i, last_i = middle(cap.x0, cap.x1, windows.nx, grid.nx)
    j, last_j = middle(cap.y0, cap.y1, windows.ny, grid.ny)
    k, last_k = middle(cap.z0, cap.z1, windows.nz, grid.nz)
    return i + windows.nx * (j + windows.ny * k), Box(i, last_i, j, last_j, k, last_k)


def middle(first: Any, last: Any, places: Any, cells: Any) -> tuple[Any, Any]:
    """The first and last cell along an axis of the window about the cells from ``first`` to ``last``."""
    start = jnp.clip((first + last) // 2 - (CELLS - 1) // 2, 0, places - 1)
    return start, jnp.minimum(start + CELLS, cells) - 1


def _digits_of(digits: Any, site: Any) -> Any:
    """Of each of three coordinates its digits, as the predicates take them."""
    return tuple(tuple(at(row, site) for row in axis) for axis in digits)
