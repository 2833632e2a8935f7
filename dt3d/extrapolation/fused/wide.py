"""The wide search: all cells that a face's cap meets, row by row, for faces whose window was too small.

Every face walks by itself: it has a bound on the signed distance, goes through the rows of cells that the
cap below this bound meets, and the sites of each row's part within the cap. A better candidate lowers the
bound. A face without any candidate tries growing bounds, as `tree_search` does, the last of which is none.
All take their steps together, and after so many of them (`turns`) those that are not done are left.
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp

from ..boxes import Box, Grid, _cell, corners
from ..expansion import TRIALS, _exact_trial, _region
from ..filtered_distance import Frame, distance_bounds, frame
from ..points import Point, dot, epsilon, norm
from ..regions import half_space_bounds
from ..search import NO_SITE, Best
from ..search import _least as least
from .expand import Expansion, Query, at, nothing_known, settle

STEPS = 4  # sites that a face examines in one turn, at most


class Rows(NamedTuple):
    """The finest cells; the sites are in the order of these, so that those of a row follow each other."""

    grid: Grid
    starts: Any  # int32 (cells + 1, or more)


class Walk(NamedTuple):
    """Where each face is."""

    trial: Any  # the next bound to try
    limit: Any  # the bound of this pass
    box: Box  # the cells of its cap
    j: Any  # the row that comes next
    k: Any
    site: Any  # the sites of a row still to be examined
    end: Any
    best: Best
    known: Any  # the least upper bound of all passes
    going: Any
    covered: Any  # whether the last pass has seen all that could be better
    searched: Any


@partial(jax.jit, static_argnames="chunk")
def expand_widely(
    sites: Point, face: Any, bound: Any, count: Any, lattice: Any, rows: Rows, turns: Any, chunk: int
) -> tuple[Expansion, Any]:
    """The first ``count`` of the faces, for which ``bound`` is an upper bound of the signed distance."""

    def one_chunk(k: Any, state: Any) -> Any:
        out, searched = state
        start = k * chunk
        *part, limit = (jax.lax.dynamic_slice(v, (start,), (chunk,)) for v in (*face, bound))
        active = jnp.arange(chunk) + start < count
        settled, more = _walk(sites, part, limit, active, lattice, rows, turns)
        write = jax.lax.dynamic_update_slice
        return jax.tree.map(lambda x, y: write(x, y, (start,)), out, settled), searched + more

    chunks = (count + chunk - 1) // chunk
    return jax.lax.fori_loop(0, chunks, one_chunk, (nothing_known(len(face[0])), jnp.int64(0)))


def _walk(
    sites: Point, face: Any, bound: Any, active: Any, lattice: Any, rows: Rows, turns: Any
) -> tuple[Expansion, Any]:
    query = frame(*(Point(*(at(x, v) for x in sites)) for v in face), lattice)
    zero = jnp.zeros_like(face[0])
    infinite = jnp.full_like(query.blur, jnp.inf)
    nothing = Best(infinite, jnp.full_like(zero, NO_SITE), infinite, infinite)
    empty = Box(*[zero] * 6)
    never = jnp.zeros_like(active)
    # a pass over nothing comes before the first
    walk = Walk(zero, -infinite, empty, zero, zero + 1, zero, zero, nothing, bound, active, never, zero)

    def turn(state: Any) -> Any:
        n, walk = state
        over = walk.going & (walk.k > walk.box.z1) & (walk.site >= walk.end)
        walk = jax.lax.cond(
            jnp.any(over), lambda w: _next_pass(query, rows.grid, nothing, w, over), lambda w: w, walk
        )
        walk = _next_row(query, rows, walk)
        return n + 1, _examine(query, sites, face, walk)

    def goes_on(state: Any) -> Any:
        return (state[0] < turns) & jnp.any(state[1].going)

    walk = jax.lax.while_loop(goes_on, turn, (jnp.int32(0), walk))[1]
    best = walk.best
    some = best.low < jnp.inf
    settled = settle(walk.covered, ~some | (best.second > best.high), some, best.site, best.low, best.high)
    return settled._replace(high=jnp.minimum(walk.known, best.high)), jnp.sum(walk.searched.astype(jnp.int64))


def _next_pass(query: Frame, grid: Grid, nothing: Best, walk: Walk, over: Any) -> Walk:
    """Faces whose pass is over end, if it has covered what it had to, or begin the next one."""
    known = jnp.where(over, jnp.minimum(walk.known, walk.best.high), walk.known)
    covered = over & (walk.limit > -jnp.inf) & ((walk.best.high <= walk.limit) | (walk.limit == jnp.inf))
    again = over & ~covered
    limit = jnp.where(known < jnp.inf, known, _exact_trial(Query(query), walk.trial))
    limit = jnp.where(jnp.isnan(limit), jnp.inf, limit)
    limit = jnp.where(walk.trial > TRIALS, jnp.inf, limit)
    box = _region(Query(query), limit, grid)
    box = Box(*(jnp.where(again, x, y) for x, y in zip(box, walk.box, strict=True)))
    best = Best(*(jnp.where(again, x, y) for x, y in zip(nothing, walk.best, strict=True)))
    return walk._replace(
        trial=walk.trial + again,
        limit=jnp.where(again, limit, walk.limit),
        box=box,
        j=jnp.where(again, box.y0, walk.j),
        k=jnp.where(again, box.z0, walk.k),
        best=best,
        known=known,
        going=walk.going & ~covered,
        covered=walk.covered | covered,
    )


def _next_row(query: Frame, rows: Rows, walk: Walk) -> Walk:
    """Faces that have examined a row's sites take the next row, if there is one."""
    grid, box = rows.grid, walk.box
    moves = walk.going & (walk.site >= walk.end) & (walk.k <= box.z1)
    bound = jnp.minimum(walk.limit, walk.best.high)
    first, last = part_of_row(query, bound, walk.j, walk.k, grid)
    first, last = jnp.maximum(first, box.x0), jnp.minimum(last, box.x1)
    row = grid.nx * (walk.j + grid.ny * walk.k)
    empty = last < first
    site = at(rows.starts, jnp.where(moves, row + first, 0))
    end = jnp.where(empty, site, at(rows.starts, jnp.where(moves & ~empty, row + last + 1, 0)))
    wraps = walk.j >= box.y1
    return walk._replace(
        j=jnp.where(moves, jnp.where(wraps, box.y0, walk.j + 1), walk.j),
        k=jnp.where(moves & wraps, walk.k + 1, walk.k),
        site=jnp.where(moves, site, walk.site),
        end=jnp.where(moves, end, walk.end),
    )


def part_of_row(query: Frame, bound: Any, j: Any, k: Any, grid: Grid) -> tuple[Any, Any]:
    """The cells of a row along x, first and last, that the cap below a bound may meet."""
    low, high = corners(jnp.zeros_like(j), j, k, grid)
    low, high = Point(grid.origin.x, low.y, low.z), Point(grid.high.x, high.y, high.z)
    half_low, half_high = half_space_bounds(query.origin, query.normal, query.doubt, low, high)
    # the ball, with what is not known of it (see `expansion._region`)
    e = epsilon(query.blur)
    finite = jnp.isfinite(bound)
    half = jnp.where(finite, bound, 0) / 2
    length = norm(query.normal)
    reach = norm(query.centre) + 2 * jnp.abs(half) * length
    slack = 4 * (query.blur + 2 * jnp.abs(half) * norm(query.doubt)) + 64 * e * reach
    radius = jnp.sqrt(dot(query.centre, query.centre) + half * half * length * length) + slack
    centre = Point(
        *(p + o + half * n for p, o, n in zip(*query[:1], query.centre, query.normal, strict=True))
    )
    gaps = [
        jnp.maximum(jnp.maximum(u - x, x - v) - slack, 0)
        for x, u, v in zip(centre[1:], low[1:], high[1:], strict=True)
    ]
    squared = radius * radius
    rest = squared - (gaps[0] * gaps[0] + gaps[1] * gaps[1]) + 64 * e * squared
    across = jnp.sqrt(jnp.maximum(rest, 0)) + slack
    missed = finite & (rest < 0)
    start = jnp.where(finite, jnp.fmax(half_low.x, centre.x - across), half_low.x)
    end = jnp.where(finite, jnp.fmin(half_high.x, centre.x + across), half_high.x)
    missed |= start > end + 2 * slack + grid.side
    room = grid.side * 1e-3 + grid.slack
    first = _cell(start - room, grid.origin.x, grid.side, grid.nx)
    last = _cell(end + room, grid.origin.x, grid.side, grid.nx)
    return first, jnp.where(missed, -1, last)


def _examine(query: Frame, sites: Point, face: Any, walk: Walk) -> Walk:
    best, before = walk.best, walk.site
    for step in range(STEPS):
        site = before + step
        counts = walk.going & (site < walk.end)
        there = jnp.where(counts, site, 0)
        own = (site == face[0]) | (site == face[1]) | (site == face[2])
        point = jax.lax.optimization_barrier(Point(*(at(x, there) for x in sites)))
        low, high = distance_bounds(query, point)
        passed = own | ~counts
        low, high = jnp.where(passed, jnp.inf, low), jnp.where(passed, jnp.inf, high)
        low, high = jax.lax.optimization_barrier((low, high))
        best = least(
            best, Best(low, jnp.where(low < jnp.inf, site, NO_SITE), jnp.full_like(low, jnp.inf), high)
        )
    after = jnp.where(walk.going, jnp.minimum(before + STEPS, walk.end), before)
    after = jnp.maximum(after, before)
    return walk._replace(best=best, site=after, searched=walk.searched + (after - before))
