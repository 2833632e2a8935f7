"""The search of all sites in a face's cap, for faces whose window was too small.

Requests and warrants again (Teng et al. 1993, section 4.2), in two flat lists whose chunks have one length: a
request for every face and row of cells that the box of its cap meets, and an item for every site of the part
of the row that the cap meets, which a formula tells. The best of each face is collected by minima. A face
without a candidate tries growing bounds; the last is none, so every face is settled, or a tie.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple, TypeAlias

import jax
import jax.numpy as jnp
from jax import Array

from ..boxes import Grid, cell_index, corners, volume
from ..caps import cell_margin, half_space_bounds
from ..exact.expansion import ExactFace, cap_cells, cap_error, open_face, plane_of, trial_bound
from ..exact.filtered_distance import Frame, distance_bounds
from ..expansion import TRIALS
from ..points import Point, dot, epsilon, norm
from ..warrants import NO_SITE, Best, least
from .chunks import Faces, at, barrier, expand_chunks, points_at
from .stages import Batch, Expansion, settle
from .tables import Tables

REQUESTS = 4096  # rows of faces looked at together
ITEMS = 4096  # sites examined together


class Trial(NamedTuple):
    """The state of faces that try one bound after the other."""

    number: Array  # how many bounds have been tried
    best: Best[Array]  # of the sites below the last bound
    known: Array  # an upper bound of the signed distance
    going: Array  # whether none of the bounds was enough so far


Found: TypeAlias = tuple[Best[Array], Array]  # and the number of sites examined


@partial(jax.jit, static_argnames="chunk")
def expand_in_caps(tables: Tables, batch: Batch, chunk: int) -> tuple[Expansion, Array]:
    """The outcome for the faces of a batch; and the number of sites examined."""
    return expand_chunks(partial(_search, tables), batch, chunk)


def _search(tables: Tables, faces: Faces) -> tuple[Expansion, Array]:
    a, b, c = (points_at(tables.points, v) for v in faces.face)
    query = open_face(faces.face, a, b, c, tables.lattice)
    infinite = jnp.full_like(query.frame.centre_error, jnp.inf)
    nothing = Best(infinite, jnp.full_like(faces.face.a, NO_SITE), infinite, infinite)

    def try_bound(state: tuple[Trial, Array]) -> tuple[Trial, Array]:
        now, searched = state
        limit = jnp.where(now.known < jnp.inf, now.known, trial_bound(query.frame, now.number))
        last = jnp.isnan(limit) | (now.number > TRIALS)
        limit = jnp.where(last, jnp.inf, limit)
        best, more = _search_caps(tables, query, limit, now.going, nothing)
        over = now.going & ((best.high <= limit) | (limit == jnp.inf))
        best = Best(*(jnp.where(now.going, x, y) for x, y in zip(best, now.best, strict=True)))
        known = jnp.minimum(now.known, best.high)
        return Trial(now.number + 1, best, known, now.going & ~over), searched + more

    # ends after at most TRIALS + 2 trials: the limit of the last is none, and all are over then
    start = Trial(jnp.zeros_like(faces.face.a), nothing, faces.bound, faces.active)
    end, searched = jax.lax.while_loop(lambda s: jnp.any(s[0].going), try_bound, (start, jnp.int64(0)))
    best = end.best
    some = best.low < jnp.inf
    alone = ~some | (best.second > best.high)
    return settle(faces.active, alone, some, best.site, best.low, best.high), searched


def _search_caps(tables: Tables, query: ExactFace, limit: Array, going: Array, best: Best[Array]) -> Found:
    """The best of the sites in the caps below the limits."""
    grid, starts = tables.rows.grid, tables.rows.starts
    box = cap_cells(query.frame, limit, grid)
    empty = (volume(box) <= 0) | ~going
    count = jnp.where(empty, 0, (box.y1 - box.y0 + 1) * (box.z1 - box.z0 + 1))
    requests = jnp.cumsum(count, dtype=jnp.int32)

    def chunk_of_requests(p: Array, state: Found) -> Found:
        best, searched = state
        owner, place, exists = _unfolded(requests, count, p * REQUESTS, REQUESTS)
        asking, below, cells = barrier(jax.tree.map(lambda x: at(x, owner), (query.frame, limit, box)))
        across = jnp.maximum(cells.y1 - cells.y0 + 1, 1)
        j, k = cells.y0 + place % across, cells.z0 + place // across
        first, last = _part_of_row(asking, below, j, k, grid)
        first, last = jnp.maximum(first, cells.x0), jnp.minimum(last, cells.x1)
        some = exists & (first <= last)
        row = grid.nx * (j + grid.ny * k)
        first, last = jnp.where(some, row + first, 0), jnp.where(some, row + last + 1, 0)
        begin, end = barrier((at(starts, first), at(starts, last)))
        length = end - begin
        items = jnp.cumsum(length, dtype=jnp.int32)

        def chunk_of_items(q: Array, best: Best[Array]) -> Best[Array]:
            request, offset, exists = _unfolded(items, length, q * ITEMS, ITEMS)
            site = jnp.where(exists, at(begin, request) + offset, 0)
            return _collect(tables.points, query, best, site, at(owner, request), exists)

        best = jax.lax.fori_loop(0, (items[-1] + ITEMS - 1) // ITEMS, chunk_of_items, best)
        return best, searched + items[-1]

    chunks = (requests[-1] + REQUESTS - 1) // REQUESTS
    found: Found = jax.lax.fori_loop(0, chunks, chunk_of_requests, (best, jnp.int64(0)))
    return found


def _unfolded(after: Array, counts: Array, start: Array, size: int) -> tuple[Array, Array, Array]:
    """Of a chunk of the list that has ``counts`` entries per owner: owners, places, and which exist.

    ``after`` are the sums of the counts.
    """
    entry = start + jnp.arange(size, dtype=jnp.int32)
    owner = jnp.searchsorted(after, entry, side="right").astype(jnp.int32)
    owner = jnp.minimum(owner, len(counts) - 1)
    exists = entry < after[-1]
    place = jnp.where(exists, entry - (at(after, owner) - at(counts, owner)), 0)
    owner, place = barrier((owner, place))
    return owner, place, exists


def _part_of_row(query: Frame, bound: Array, j: Array, k: Array, grid: Grid[Array]) -> tuple[Array, Array]:
    """The cells of a row along x, first and last, that the cap below a bound may meet."""
    low, high = corners(jnp.zeros_like(j), j, k, grid)
    low, high = Point(grid.origin.x, low.y, low.z), Point(grid.high.x, high.y, high.z)
    half_low, half_high = half_space_bounds(plane_of(query), low, high)
    # the ball, with what is not known of it (see `cap_error`)
    finite = jnp.isfinite(bound)
    half = jnp.where(finite, bound, 0) / 2
    length = norm(query.normal)
    size = norm(query.centre) + 2 * jnp.abs(half) * length
    error = cap_error(query, 2 * jnp.abs(half), size)
    radius = jnp.sqrt(dot(query.centre, query.centre) + half * half * length * length) + error
    centre = Point(
        *(p + o + half * n for p, o, n in zip(query.origin, query.centre, query.normal, strict=True))
    )
    gaps = [
        jnp.maximum(jnp.maximum(u - x, x - v) - error, 0)
        for x, u, v in zip(centre[1:], low[1:], high[1:], strict=True)
    ]
    squared = radius * radius
    rest = squared - (gaps[0] * gaps[0] + gaps[1] * gaps[1]) + 64 * epsilon(query.centre_error) * squared
    across = jnp.sqrt(jnp.maximum(rest, 0)) + error
    missed = finite & (rest < 0)
    start = jnp.where(finite, jnp.fmax(half_low.x, centre.x - across), half_low.x)
    end = jnp.where(finite, jnp.fmin(half_high.x, centre.x + across), half_high.x)
    missed |= start > end + 2 * error + grid.side
    margin = cell_margin(grid)
    first = cell_index(start - margin, grid.origin.x, grid.side, grid.nx)
    last = cell_index(end + margin, grid.origin.x, grid.side, grid.nx)
    return first, jnp.where(missed, -1, last)


def _collect(
    points: Point[Array], query: ExactFace, best: Best[Array], site: Array, owner: Array, exists: Array
) -> Best[Array]:
    """The best so far and those of more sites, each for one of the faces."""
    a, b, c = query.face
    own = (site == at(a, owner)) | (site == at(b, owner)) | (site == at(c, owner))
    asking, point = barrier((jax.tree.map(lambda x: at(x, owner), query.frame), points_at(points, site)))
    low, high = distance_bounds(asking, point)
    passed = own | ~exists
    low, high = barrier((jnp.where(passed, jnp.inf, low), jnp.where(passed, jnp.inf, high)))
    infinite, size = jnp.full_like(best.low, jnp.inf), len(best.low)
    least_low = infinite.at[owner].min(low)
    holds = (low == at(least_low, owner)) & (low < jnp.inf)
    no_site = jnp.full(size, 2**31 - 1, jnp.int32)
    holder = no_site.at[jnp.where(holds, owner, size)].min(site, mode="drop")
    others = jnp.where(holds & (site == at(holder, owner)), jnp.inf, low)
    found = least_low < jnp.inf
    here = Best(
        least_low,
        jnp.where(found, holder, NO_SITE),
        infinite.at[owner].min(others),
        infinite.at[owner].min(high),
    )
    return least(best, here)
