"""The search through uniform cells, by requests and warrants: Algorithm Face Expansion.

Teng et al. 1993, section 4.2. All queries search at once, in rounds: each opens some cells, and two segmented
lists turn their unequal loads into lengths of vectors, which the machine shares out evenly:

* a *request* for every (query, cell) pair; cells that cannot hold a better site are pruned;
* for every request, as many *warrants* as its cell's sites need, each for ``sites_per_warrant`` at most.

A query's warrants are consecutive in the list, a super-segment; a segmented scan finds the best of each::

    queries     f1              f2      f3
    requests    c1   c2   c3    c4      c5   c6         the cells that a query opens: a segment
    warrants    ww   w    -     w       www  ww         the sites of a cell: a segment
                |---------|     |---|   |---------|     super-segments, reduced by LEAST_BOUNDS

The same rounds find the nearest sites and smallest circumcircles of gift wrapping, as the paper suggests.
Lines of the algorithm are quoted where they are executed.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Generic, NamedTuple, TypeAlias

import jax.numpy as jnp
import numpy as np
from jax import Array

import scanvec as sv

from .._errors import InternalError
from .boxes import (
    Box,
    Grid,
    HostGrid,
    containment_box,
    contains,
    corners,
    difference_cell,
    empty_box,
    extend,
    missing,
    volume,
)
from .buckets import Buckets, Cells
from .points import Point, T
from .warrants import (
    LEAST_BOUNDS,
    Best,
    Q,
    Ranges,
    SearchResult,
    SearchSpec,
    execute,
    least,
    nothing_found,
)

# A box grows by one cell in each direction for two rounds, then by two for two more, by four, ..., until all
# cells that are left are opened at once.
EVERY_CELL = 2**20  # more cells than any grid has along a side
# Queries that would take a round beyond so many requests wait for the next one; it bounds the memory.
MOST_CELL_REQUESTS = 2**20
ROUNDS_BETWEEN_CHECKS = 64  # at how many rounds the searches have taken, which a machine has to be asked


class Search(NamedTuple, Generic[T]):
    """State of the queries that are still searching."""

    place: T  # the query's among all
    query: object
    best: Best[T]
    dead: Box[T]
    new: Box[T]
    rounds: T


State: TypeAlias = Search[sv.Vector]


def search(
    buckets: Buckets, queries: object, first: tuple[Point[sv.Vector], Point[sv.Vector]], spec: SearchSpec[Q]
) -> SearchResult:
    """The site of least score for each of m queries, a record of vectors of length m.

    The first round opens the cells of the boxes with the corners ``first``.
    """
    assert buckets.cells is not None
    machine, cells = buckets.machine, buckets.cells
    options = buckets.options
    steps = _steps_of(spec, options.sites_per_warrant, options.preset_limit)
    m = len(first[0].x)
    # "newbox := containment_box({a, b, c, o_circ}); deadbox := empty; done := false; min_sd := inf;
    # d := null"
    result = nothing_found(machine, m, buckets.sites.x.dtype)
    dead, new = machine.map(_begin, *first, cells.grid)
    state: State = Search(machine.iota(m), queries, result, dead, new, machine.full(m, 0, np.int32))
    searched = opened = rounds = 0
    done_in: list[np.ndarray] = []
    # "while not globally done, where not done"
    while len(state.place):
        rounds += 1
        if rounds % ROUNDS_BETWEEN_CHECKS == 0:
            _check_rounds(state, cells.grid, options.preset_limit)
        state, done, load = _round(buckets, cells, state, spec, steps)
        searched, opened = searched + load.sites, opened + load.cells
        done_in.append(np.bincount(state.rounds.to_numpy()[done.to_numpy()]))
        result = sv.scatter(state.best, state.place, into=result, where=done)
        state = sv.pack(state, ~done)
    return SearchResult(result, searched, opened, _totals(done_in))


def _totals(counts: list[np.ndarray]) -> tuple[int, ...]:
    """Counts from 0 on, added up; those of 0, which are none, left out."""
    total = np.zeros(max(map(len, counts), default=1), np.int64)
    for some in counts:
        total[: len(some)] += some
    return tuple(int(x) for x in total[1:])


def _check_rounds(state: State, grid: HostGrid, preset_limit: int) -> None:
    """Raise InternalError where a search has taken more rounds than there can be.

    The first one that waits goes on in every round. Its dead box is never the same in two rounds: it grows by
    a cell or more in one of the directions of the grid, or the search ends.
    """
    most = preset_limit + int(grid.nx) + int(grid.ny) + int(grid.nz)
    rounds = int(state.rounds.to_numpy().max())
    if rounds > most:
        msg = f"a search through cells has taken {rounds} rounds, where {most} open all of them"
        raise InternalError(msg)


class _Load(NamedTuple):
    """What a round searched."""

    cells: int
    sites: int


def _round(
    buckets: Buckets, cells: Cells, state: State, spec: SearchSpec[Q], steps: _Steps
) -> tuple[State, sv.Vector, _Load]:
    machine, grid = buckets.machine, cells.grid
    # "compute the number of cells to open"
    counts = machine.map(_cells_to_open, state.new, state.dead)
    # added up in 64 bits: thousands of faces may ask for all of thousands of cells
    going = machine.map(_fits, sv.scan(counts.astype(np.int64), sv.ADD))
    counts = sv.where(going, counts, 0)

    # "allocate the request list; for each request compute its corresponding cell; obtain the range of site
    # indices of the cell"
    requests = sv.Segments.from_lengths(counts)
    asked = sv.get((state.query, state.best.high, state.new, state.dead), requests.ids)
    cell, admitted = machine.map(steps.request, *asked, requests.offsets, grid)
    start, count = sv.get((cells.starts, cells.counts), cell, where=admitted, otherwise=0)

    # "allocate the warrant list; for each warrant w ..."
    wanted = machine.map(steps.warrants, count)
    warrants = sv.Segments.from_lengths(wanted)
    start, count, owner = sv.get((start, count, requests.ids), warrants.ids)
    start, length = machine.map(steps.range, start, count, warrants.offsets)
    ranges = Ranges(start, length, buckets.options.sites_per_warrant)
    found = execute(buckets, sv.get(state.query, owner), ranges, spec)

    # "min_sd := min{min_sd, w.min_sd} for all warrants of the face": the query's super-segment
    per_query = sv.Segments.from_lengths(sv.reduce(wanted, sv.ADD, requests))
    found = sv.reduce(found, LEAST_BOUNDS, per_query)
    state, done = machine.map(steps.conclude, state, found, going, grid)
    return state, done, _Load(len(requests.ids), int(sv.reduce(length, sv.ADD)))


class _Steps(NamedTuple):
    """The elementwise steps of a round for one kind of query."""

    request: Callable[..., tuple[Array, Array]]
    warrants: Callable[[Array], Array]
    range: Callable[..., tuple[Array, Array]]
    conclude: Callable[..., tuple[Search[Array], Array]]


@cache  # so that compiled kernels are found again
def _steps_of(spec: SearchSpec[Q], per_warrant: int, preset_limit: int) -> _Steps:
    def request(
        query: Q, bound: Array, new: Box[Array], dead: Box[Array], k: Array, grid: Grid[Array]
    ) -> tuple[Array, Array]:
        i, j, h = difference_cell(new, dead, k)
        low, high = corners(i, j, h, grid)
        return i + grid.nx * (j + grid.ny * h), spec.may_contain(query, bound, low, high)

    def warrants(count: Array) -> Array:
        return (count + per_warrant - 1) // per_warrant

    def its_range(start: Array, count: Array, k: Array) -> tuple[Array, Array]:
        first = k * per_warrant
        return start + first, jnp.minimum(count - first, per_warrant)

    def conclude(
        state: Search[Array], found: Best[Array], going: Array, grid: Grid[Array]
    ) -> tuple[Search[Array], Array]:
        # "d := p that contributes to this minimum"
        best = least(state.best, found)
        # "deadbox := newbox; newbox := containment_box(circumsphere((a, b, c, d)))", or of its cap
        dead = Box(*(jnp.where(going, n, d) for n, d in zip(state.new, state.dead, strict=True)))
        target = spec.region(state.query, best.high, grid)  # type: ignore[arg-type]  # the query is a Q
        # "if newbox is in deadbox or (unit cube and Hp) is in deadbox: done := true; else adjust newbox"
        done = going & contains(dead, target)
        rounds = state.rounds + going
        growth = jnp.left_shift(1, (rounds - 1) // 2)
        steps = jnp.where(rounds < preset_limit, growth, EVERY_CELL)
        if spec.closing:
            few = jnp.isfinite(best.high) & (missing(dead, target) <= spec.closing)
            steps = jnp.where(few, EVERY_CELL, steps)
        new = extend(dead, target, steps)
        new = Box(*(jnp.where(going, g, n) for g, n in zip(new, state.new, strict=True)))
        return Search(state.place, state.query, best, dead, new, rounds), done

    return _Steps(request, warrants, its_range, conclude)


def _begin(low: Point[Array], high: Point[Array], grid: Grid[Array]) -> tuple[Box[Array], Box[Array]]:
    new = containment_box(low, high, grid)
    return empty_box(new.x0), new


def _cells_to_open(new: Box[Array], dead: Box[Array]) -> Array:
    return volume(new) - volume(dead)


def _fits(before: Array) -> Array:
    return before < MOST_CELL_REQUESTS
