"""The wide search: all sites in a face's cap, for faces whose window was too small.

Requests and warrants again (Teng et al. 1993, section 4.2), in two flat lists whose pieces have one length:
a request for every face and row of cells that the box of its cap meets, and an item for every site of the
part of the row that the cap meets, which a formula tells. The best of each face is collected by minima. A
face without a candidate tries growing bounds; the last is none, so every face is settled, or a tie.
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp

from ..boxes import Grid, _cell, corners, volume
from ..caps import half_space_bounds
from ..exact.expansion import cap_cells, trial_bound
from ..exact.filtered_distance import Frame, distance_bounds, frame
from ..expansion import TRIALS
from ..points import Point, dot, epsilon, norm
from ..warrants import NO_SITE, Best, least
from .expand import Expansion, at, nothing_known, settle

REQUESTS = 4096  # rows of faces looked at together
ITEMS = 4096  # sites examined together


class Rows(NamedTuple):
    """The cells; the sites are in the order of these, so that those of a row follow each other."""

    grid: Grid
    starts: Any  # int32 (cells + 1, or more)


class Pass(NamedTuple):
    """Where each face is."""

    trial: Any
    limit: Any
    best: Best
    known: Any
    going: Any


@partial(jax.jit, static_argnames="chunk")
def expand_widely(
    sites: Point, face: Any, bound: Any, count: Any, lattice: Any, rows: Rows, chunk: int
) -> tuple[Expansion, Any]:
    """The first ``count`` of the faces, for which ``bound`` is an upper bound of the signed distance."""

    def one_chunk(k: Any, state: Any) -> Any:
        out, searched = state
        start = k * chunk
        *part, known = (jax.lax.dynamic_slice(v, (start,), (chunk,)) for v in (*face, bound))
        active = jnp.arange(chunk) + start < count
        settled, more = _search(sites, part, known, active, lattice, rows)
        write = jax.lax.dynamic_update_slice
        return jax.tree.map(lambda x, y: write(x, y, (start,)), out, settled), searched + more

    chunks = (count + chunk - 1) // chunk
    return jax.lax.fori_loop(0, chunks, one_chunk, (nothing_known(len(face[0])), jnp.int64(0)))


def _search(
    sites: Point, face: Any, known: Any, active: Any, lattice: Any, rows: Rows
) -> tuple[Expansion, Any]:
    a, b, c = (Point(*(at(x, v) for x in sites)) for v in face)
    query = frame(a, b, c, lattice)
    infinite = jnp.full_like(query.blur, jnp.inf)
    nothing = Best(infinite, jnp.full_like(face[0], NO_SITE), infinite, infinite)

    def one_pass(state: Any) -> Any:
        now, searched = state
        limit = jnp.where(now.known < jnp.inf, now.known, trial_bound(query, now.trial))
        last = jnp.isnan(limit) | (now.trial > TRIALS)
        limit = jnp.where(last, jnp.inf, limit)
        best, more = _look(sites, query, face, limit, now.going, rows, nothing)
        over = now.going & ((best.high <= limit) | (limit == jnp.inf))
        best = Best(*(jnp.where(now.going, x, y) for x, y in zip(best, now.best, strict=True)))
        known = jnp.minimum(now.known, best.high)
        return Pass(now.trial + 1, limit, best, known, now.going & ~over), searched + more

    # ends after at most TRIALS + 2 passes: the limit of the last is none, and all are over then
    start = Pass(jnp.zeros_like(face[0]), infinite, nothing, known, active)
    end, searched = jax.lax.while_loop(lambda s: jnp.any(s[0].going), one_pass, (start, jnp.int64(0)))
    best = end.best
    some = best.low < jnp.inf
    alone = ~some | (best.second > best.high)
    return settle(active, alone, some, best.site, best.low, best.high), searched


def _look(
    sites: Point, query: Frame, face: Any, limit: Any, going: Any, rows: Rows, best: Best
) -> tuple[Best, Any]:
    """The best of the sites in the caps below the limits."""
    grid = rows.grid
    box = cap_cells(query, limit, grid)
    empty = (volume(box) <= 0) | ~going
    count = jnp.where(empty, 0, (box.y1 - box.y0 + 1) * (box.z1 - box.z0 + 1))
    requests = jnp.cumsum(count, dtype=jnp.int32)

    def piece_of_requests(p: Any, state: Any) -> Any:
        best, searched = state
        owner, place, exists = _unfolded(requests, count, p * REQUESTS, REQUESTS)
        asking, below, cells = jax.lax.optimization_barrier(
            jax.tree.map(lambda x: at(x, owner), (query, limit, box))
        )
        across = jnp.maximum(cells.y1 - cells.y0 + 1, 1)
        j, k = cells.y0 + place % across, cells.z0 + place // across
        first, last = part_of_row(asking, below, j, k, grid)
        first, last = jnp.maximum(first, cells.x0), jnp.minimum(last, cells.x1)
        some = exists & (first <= last)
        row = grid.nx * (j + grid.ny * k)
        first, last = jnp.where(some, row + first, 0), jnp.where(some, row + last + 1, 0)
        begin, end = jax.lax.optimization_barrier((at(rows.starts, first), at(rows.starts, last)))
        length = end - begin
        items = jnp.cumsum(length, dtype=jnp.int32)

        def piece_of_items(q: Any, best: Best) -> Best:
            request, offset, exists = _unfolded(items, length, q * ITEMS, ITEMS)
            site = jnp.where(exists, at(begin, request) + offset, 0)
            return _collect(sites, query, face, best, site, at(owner, request), exists)

        best = jax.lax.fori_loop(0, (items[-1] + ITEMS - 1) // ITEMS, piece_of_items, best)
        return best, searched + items[-1]

    pieces = (requests[-1] + REQUESTS - 1) // REQUESTS
    return jax.lax.fori_loop(0, pieces, piece_of_requests, (best, jnp.int64(0)))


def _unfolded(after: Any, counts: Any, start: Any, size: int) -> tuple[Any, Any, Any]:
    """Of a piece of the list that has ``counts`` entries for each owner: owners, places, and which exist.

    ``after`` are the sums of the counts.
    """
    entry = start + jnp.arange(size, dtype=jnp.int32)
    owner = jnp.searchsorted(after, entry, side="right").astype(jnp.int32)
    owner = jnp.minimum(owner, len(counts) - 1)
    exists = entry < after[-1]
    place = jnp.where(exists, entry - (at(after, owner) - at(counts, owner)), 0)
    return (*jax.lax.optimization_barrier((owner, place)), exists)


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


def _collect(sites: Point, query: Frame, face: Any, best: Best, site: Any, owner: Any, exists: Any) -> Best:
    """The best so far and those of more sites, each for one of the faces."""
    own = (site == at(face[0], owner)) | (site == at(face[1], owner)) | (site == at(face[2], owner))
    asking, point = jax.lax.optimization_barrier(
        (jax.tree.map(lambda x: at(x, owner), query), Point(*(at(x, site) for x in sites)))
    )
    low, high = distance_bounds(asking, point)
    passed = own | ~exists
    low, high = jax.lax.optimization_barrier(
        (jnp.where(passed, jnp.inf, low), jnp.where(passed, jnp.inf, high))
    )
    infinite, size = jnp.full_like(best.low, jnp.inf), len(best.low)
    least_low = infinite.at[owner].min(low)
    holds = (low == at(least_low, owner)) & (low < jnp.inf)
    nobody = jnp.full(size, 2**31 - 1, jnp.int32)
    holder = nobody.at[jnp.where(holds, owner, size)].min(site, mode="drop")
    others = jnp.where(holds & (site == at(holder, owner)), jnp.inf, low)
    found = least_low < jnp.inf
    here = Best(
        least_low,
        jnp.where(found, holder, NO_SITE),
        infinite.at[owner].min(others),
        infinite.at[owner].min(high),
    )
    return least(best, here)
