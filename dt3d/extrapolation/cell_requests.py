"""The search through uniform cells, by requests and warrants.

Teng et al. 1993, section 4.2. All queries search at once, in rounds: each opens some cells, and two segmented
lists turn their unequal loads into lengths of vectors, which the machine shares out evenly:

* a *request* for every (query, cell) pair; cells that cannot hold a better site are pruned;
* for every request, as many *warrants* as its cell's sites need, each for at most `SITES_PER_WARRANT` sites.

A query's warrants are consecutive in the list, a super-segment; a segmented scan finds the best of each.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

import scanvec as sv

from .._errors import InternalError
from .boxes import Box, Grid, containment_box, contains, corners, difference_cell, empty_box, extend, volume
from .buckets import Buckets, Cells
from .points import Point
from .warrants import LEAST, SITES_PER_WARRANT, Answer, Best, Question, execute, least, nothing_found

# A box grows by one cell in each direction for two rounds, then by two for two more, by four, ... After so
# many rounds all cells that are left are opened at once (the paper's "preset limit").
ROUNDS_BEFORE_ALL = 8
EVERY_CELL = 2**20  # more cells than any grid has along a side
# Queries that would take a round beyond so many requests wait for the next one; it bounds the memory.
MOST_REQUESTS = 2**20
TURNS_BETWEEN_LOOKS = 64  # at how many rounds the searches have taken, which a machine has to be asked


class Search(NamedTuple):
    """State of the queries that are still searching."""

    index: Any  # the query's place among all
    query: Any
    best: Best
    dead: Box
    new: Box
    rounds: Any


def search(buckets: Buckets, queries: Any, first: tuple[Point, Point], question: Question) -> Answer:
    """The site of least score for each of m queries, a record of vectors of length m.

    The first round opens the cells of the boxes with the corners ``first``.
    """
    assert buckets.cells is not None
    machine, cells = buckets.machine, buckets.cells
    steps = _steps_of(question)
    m = len(first[0].x)
    answer = nothing_found(machine, m, buckets.sites.x.dtype)
    dead, new = machine.map(_begin, *first, cells.grid)
    state = Search(machine.iota(m), queries, answer, dead, new, machine.full(m, 0, np.int32))
    searched = turns = 0
    while len(state.index):
        turns += 1
        if turns % TURNS_BETWEEN_LOOKS == 0:
            _check_rounds(state, cells.grid)
        state, done, count = _round(buckets, cells, state, question, steps)
        searched += count
        answer = sv.scatter(state.best, state.index, into=answer, where=done)
        state = sv.pack(state, ~done)
    return Answer(answer, searched)


def _check_rounds(state: Search, grid: Grid) -> None:
    """Raise InternalError where a search has taken more rounds than there can be.

    The first one that waits goes on in every turn. Its dead box is never the same in two rounds: it grows by
    a cell or more in one of the directions of the grid, or the search ends.
    """
    most = ROUNDS_BEFORE_ALL + int(grid.nx) + int(grid.ny) + int(grid.nz)
    rounds = int(state.rounds.to_numpy().max())
    if rounds > most:
        msg = f"a search through cells has taken {rounds} rounds, where {most} open all of them"
        raise InternalError(msg)


def _round(
    buckets: Buckets, cells: Cells, state: Search, question: Question, steps: _Steps
) -> tuple[Search, sv.Vector, int]:
    machine, grid = buckets.machine, cells.grid
    counts = machine.map(_cells_to_open, state.new, state.dead)
    # added up in 64 bits: thousands of faces may ask for all of thousands of cells
    going = machine.map(_fits, sv.scan(counts.astype(np.int64), sv.ADD))
    counts = sv.where(going, counts, 0)

    # requests: one for each cell that a query opens
    requests = sv.Segments.from_lengths(counts)
    asked = sv.get((state.query, state.best.high, state.new, state.dead), requests.ids)
    cell, admitted = machine.map(steps.request, *asked, requests.offsets, grid)
    start, count = sv.get((cells.starts, cells.counts), cell, where=admitted, otherwise=0)

    # warrants: one for each few sites of a request's cell
    wanted = machine.map(_warrants_for, count)
    warrants = sv.Segments.from_lengths(wanted)
    start, count, owner = sv.get((start, count, requests.ids), warrants.ids)
    start, length = machine.map(_range, start, count, warrants.offsets)
    found = execute(buckets, sv.get(state.query, owner), start, length, question)

    # the best of each query's super-segment
    per_query = sv.Segments.from_lengths(sv.reduce(wanted, sv.ADD, requests))
    found = sv.reduce(found, LEAST, per_query)
    state, done = machine.map(steps.conclude, state, found, going, grid)
    return state, done, int(sv.reduce(length, sv.ADD))


class _Steps(NamedTuple):
    """The elementwise steps of a round for one question."""

    request: Callable
    conclude: Callable


@cache  # so that compiled kernels are found again
def _steps_of(question: Question) -> _Steps:
    def request(query: Any, bound: Any, new: Box, dead: Box, k: Any, grid: Grid) -> tuple[Any, Any]:
        i, j, h = difference_cell(new, dead, k)
        low, high = corners(i, j, h, grid)
        return i + grid.nx * (j + grid.ny * h), question.admits(query, bound, low, high)

    def conclude(state: Search, found: Best, going: Any, grid: Grid) -> tuple[Search, Any]:
        best = least(state.best, found)
        dead = Box(*(jnp.where(going, n, d) for n, d in zip(state.new, state.dead, strict=True)))
        target = question.region(state.query, best.high, grid)
        done = going & contains(dead, target)
        rounds = state.rounds + going
        growth = jnp.left_shift(1, (rounds - 1) // 2)
        new = extend(dead, target, jnp.where(rounds < ROUNDS_BEFORE_ALL, growth, EVERY_CELL))
        new = Box(*(jnp.where(going, g, n) for g, n in zip(new, state.new, strict=True)))
        return Search(state.index, state.query, best, dead, new, rounds), done

    return _Steps(request, conclude)


def _begin(low: Point, high: Point, grid: Grid) -> tuple[Box, Box]:
    new = containment_box(low, high, grid)
    return empty_box(new.x0), new


def _cells_to_open(new: Box, dead: Box) -> Any:
    return volume(new) - volume(dead)


def _fits(before: Any) -> Any:
    return before < MOST_REQUESTS


def _warrants_for(count: Any) -> Any:
    return (count + SITES_PER_WARRANT - 1) // SITES_PER_WARRANT


def _range(start: Any, count: Any, k: Any) -> tuple[Any, Any]:
    first = k * SITES_PER_WARRANT
    return start + first, jnp.minimum(count - first, SITES_PER_WARRANT)
