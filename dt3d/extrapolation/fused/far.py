"""The far search: faces at the hull and slivers, whose caps reach across many cells.

Few faces at a time look at all rows of cells. Each row has a part that the cap meets, which a formula tells;
the sites of all parts form one list, that is examined in pieces, and the best of each face collected by
minima. A face without a candidate tries growing bounds; the last is none, so every face is settled.
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp

from ..expansion import TRIALS, _exact_trial
from ..filtered_distance import Frame, distance_bounds, frame
from ..points import Point
from ..search import NO_SITE, Best
from ..search import _least as least
from .expand import Expansion, Query, at, nothing_known, settle
from .wide import Rows, part_of_row

ROWS = 1024  # looked at together
ITEMS = 4096  # sites examined together


class Pass(NamedTuple):
    """Where each face is."""

    trial: Any
    limit: Any
    best: Best
    known: Any
    going: Any


@partial(jax.jit, static_argnames="chunk")
def expand_far(
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
    query = frame(*(Point(*(at(x, v) for x in sites)) for v in face), lattice)
    infinite = jnp.full_like(query.blur, jnp.inf)
    nothing = Best(infinite, jnp.full_like(face[0], NO_SITE), infinite, infinite)

    def one_pass(state: Any) -> Any:
        now, searched = state
        limit = jnp.where(now.known < jnp.inf, now.known, _exact_trial(Query(query), now.trial))
        last = jnp.isnan(limit) | (now.trial > TRIALS)
        limit = jnp.where(last, jnp.inf, limit)
        best, more = _look(sites, query, face, limit, now.going, rows, nothing)
        over = now.going & ((best.high <= limit) | (limit == jnp.inf))
        best = Best(*(jnp.where(now.going, x, y) for x, y in zip(best, now.best, strict=True)))
        known = jnp.minimum(now.known, best.high)
        return Pass(now.trial + 1, limit, best, known, now.going & ~over), searched + more

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
    every = grid.ny * grid.nz
    lanes = jax.tree.map(lambda x: x[:, None], query)

    def block(b: Any, state: Any) -> Any:
        best, searched = state
        row = b * ROWS + jnp.arange(ROWS, dtype=jnp.int32)
        exists = (row < every) & going[:, None]
        j, k = row % grid.ny, jnp.minimum(row // grid.ny, grid.nz - 1)
        first, last = part_of_row(lanes, limit[:, None], j, k, grid)
        some = exists & (last >= first)
        begin = jnp.where(some, at(rows.starts, jnp.where(some, grid.nx * row + first, 0)), 0)
        end = jnp.where(some, at(rows.starts, jnp.where(some, grid.nx * row + last + 1, 0)), 0)
        begin, length = begin.ravel(), (end - begin).ravel()
        after = jnp.cumsum(length, dtype=jnp.int32)
        total = after[-1]

        def piece(p: Any, best: Best) -> Best:
            item = p * ITEMS + jnp.arange(ITEMS, dtype=jnp.int32)
            pair = jnp.minimum(jnp.searchsorted(after, item, side="right"), len(after) - 1)
            site = at(begin, pair) + item - (at(after, pair) - at(length, pair))
            return _collect(sites, query, face, best, site, (pair // ROWS).astype(jnp.int32), item < total)

        best = jax.lax.fori_loop(0, (total + ITEMS - 1) // ITEMS, piece, best)
        return best, searched + total

    return jax.lax.fori_loop(0, (every + ROWS - 1) // ROWS, block, (best, jnp.int64(0)))


def _collect(sites: Point, query: Frame, face: Any, best: Best, site: Any, owner: Any, exists: Any) -> Best:
    """The best so far and those of more sites, each for one of the faces."""
    there = jnp.where(exists, site, 0)
    own = (there == at(face[0], owner)) | (there == at(face[1], owner)) | (there == at(face[2], owner))
    asking = jax.lax.optimization_barrier(jax.tree.map(lambda x: at(x, owner), query))
    low, high = distance_bounds(asking, Point(*(at(x, there) for x in sites)))
    passed = own | ~exists
    low, high = jax.lax.optimization_barrier(
        (jnp.where(passed, jnp.inf, low), jnp.where(passed, jnp.inf, high))
    )
    infinite, size = jnp.full_like(best.low, jnp.inf), len(best.low)
    least_low = infinite.at[owner].min(low)
    holds = (low == at(least_low, owner)) & (low < jnp.inf)
    nobody = jnp.full(size, 2**31 - 1, jnp.int32)
    holder = nobody.at[jnp.where(holds, owner, size)].min(there, mode="drop")
    others = jnp.where(holds & (there == at(holder, owner)), jnp.inf, low)
    found = least_low < jnp.inf
    here = Best(
        least_low,
        jnp.where(found, holder, NO_SITE),
        infinite.at[owner].min(others),
        infinite.at[owner].min(high),
    )
    return least(best, here)
