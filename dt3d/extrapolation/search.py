"""The search for each query's best site, by requests and warrants.

Teng et al. 1993, section 4.2. Three searches of the algorithm (a nearest site, a smallest circumcircle, a
face expansion) ask for the site of least score near a query. All queries search at once, in rounds: each
opens some cells, and two segmented lists turn their unequal loads into lengths of vectors, which the machine
shares out evenly:

* a *request* for every (query, cell) pair; cells that cannot hold a better site are pruned;
* for every request, as many *warrants* as its cell's sites need, each for at most `SITES_PER_WARRANT` sites.

A query's warrants are consecutive in the list, a super-segment; a segmented scan finds the best of each.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

import scanvec as sv

from .boxes import Box, Grid, contains, corners, difference_cell, empty_box, extend, volume
from .buckets import SITES_PER_CELL, Buckets

SITES_PER_WARRANT = SITES_PER_CELL
# A box grows by one cell in each direction for two rounds, then by two for two more, by four, ... After so
# many rounds all cells that are left are opened at once (the paper's "preset limit").
ROUNDS_BEFORE_ALL = 8
EVERY_CELL = 2**20  # more cells than any grid has along a side
# Queries that would take a round beyond so many requests wait for the next one; it bounds the memory.
MOST_REQUESTS = 2**20

NO_SITE = -1


@dataclass(frozen=True)
class Question:
    """What a kind of query asks. The functions are elementwise, on one query at a time.

    Attributes
    ----------
    score : (query, site: Point, index) -> float
        What the best site has least of; inf for sites that are no answer.
    first_box : (query, grid) -> Box
        The cells opened in the first round; not empty.
    region : (query, score, grid) -> Box
        All cells that could hold a site of smaller score.
    admits : (query, score, low: Point, high: Point) -> bool
        Whether the cell with these corners could hold a site of smaller score. May say yes wrongly, never no.
    """

    score: Callable
    first_box: Callable
    region: Callable
    admits: Callable


class Search(NamedTuple):
    """State of the queries that are still searching."""

    index: Any  # the query's place among all
    query: Any
    score: Any  # of the best site so far
    best: Any  # the best site so far, or NO_SITE
    dead: Box
    new: Box
    rounds: Any


class Answer(NamedTuple):
    """The outcome of a search over m queries."""

    score: sv.Vector  # (m,)
    site: sv.Vector  # int32 (m,), NO_SITE where no site is an answer
    sites_searched: int


def search(buckets: Buckets, queries: Any, question: Question) -> Answer:
    """The site of least score for each of m queries, a record of vectors of length m."""
    machine = buckets.origin.machine
    steps = _steps_of(question)
    m = len(jax.tree.leaves(queries)[0])
    state = machine.map(
        steps.begin, machine.iota(m), queries, buckets.grid, buckets.sites.x.dtype.type(np.inf)
    )
    scores = machine.full(m, np.inf, buckets.sites.x.dtype)
    sites = machine.full(m, NO_SITE, np.int32)
    searched = 0
    while len(state.index):
        state, done, count = _round(buckets, state, steps)
        searched += count
        scores, sites = sv.permute((state.score, state.best), state.index, into=(scores, sites), where=done)
        state = sv.pack(state, ~done)
    return Answer(scores, sites, searched)


def _round(buckets: Buckets, state: Search, steps: _Steps) -> tuple[Search, sv.Vector, int]:
    machine, grid = buckets.origin.machine, buckets.grid
    counts = machine.map(_cells_to_open, state.new, state.dead)
    # added up in 64 bits: thousands of faces may ask for all of thousands of cells
    going = machine.map(_fits, sv.scan(counts.astype(np.int64), sv.ADD))
    counts = machine.map(_if, going, counts, 0)

    # requests: one for each cell that a query opens
    requests = sv.Segments.from_lengths(counts)
    asked = sv.get((state.query, state.score, state.new, state.dead), requests.ids)
    cell, admitted = machine.map(steps.request, *asked, requests.offsets, grid)
    start, count = sv.get((buckets.starts, buckets.counts), cell, where=admitted)

    # warrants: one for each few sites of a request's cell
    wanted = machine.map(_warrants_for, count)
    warrants = sv.Segments.from_lengths(wanted)
    start, count, owner = sv.get((start, count, requests.ids), warrants.ids)
    start, length = machine.map(_range, start, count, warrants.offsets)
    score, best = _execute(buckets, sv.get(state.query, owner), start, length, steps)

    # the best of each query's super-segment
    per_query = sv.Segments.from_lengths(sv.reduce(wanted, sv.ADD, requests))
    found = sv.reduce((score, best), sv.ARGMIN, per_query)
    state, done = machine.map(steps.conclude, state, *found, going, grid)
    return state, done, int(sv.reduce(length, sv.ADD))


def _execute(
    buckets: Buckets, query: Any, start: sv.Vector, length: sv.Vector, steps: _Steps
) -> tuple[sv.Vector, sv.Vector]:
    """Each warrant's best score and site."""
    machine, n = start.machine, len(start)
    score = machine.full(n, np.inf, buckets.sites.x.dtype)
    best = machine.full(n, NO_SITE, np.int32)
    for k in range(SITES_PER_WARRANT):
        site = start + k
        active = length > k
        point = sv.get(buckets.sites, site, where=active)
        score, best = machine.map(steps.examine, query, point, site, active, score, best)
    return score, best


class _Steps(NamedTuple):
    """The elementwise steps of a round for one question."""

    begin: Callable
    request: Callable
    examine: Callable
    conclude: Callable


_STEPS: dict[Question, _Steps] = {}


def _steps_of(question: Question) -> _Steps:
    # made once for a question, so that compiled kernels are found again
    if question not in _STEPS:
        _STEPS[question] = _make_steps(question)
    return _STEPS[question]


def _make_steps(question: Question) -> _Steps:
    def begin(index: Any, query: Any, grid: Grid, worst: Any) -> Search:
        dead = empty_box(index)
        return Search(
            index, query, worst, jnp.full_like(index, NO_SITE), dead, question.first_box(query, grid),
            jnp.zeros_like(index),
        )  # fmt: skip

    def request(query: Any, score: Any, new: Box, dead: Box, k: Any, grid: Grid) -> tuple[Any, Any]:
        i, j, h = difference_cell(new, dead, k)
        low, high = corners(i, j, h, grid)
        return i + grid.nx * (j + grid.ny * h), question.admits(query, score, low, high)

    def examine(query: Any, point: Any, site: Any, active: Any, score: Any, best: Any) -> tuple[Any, Any]:
        value = question.score(query, point, site)
        better = active & (value < score)
        return jnp.where(better, value, score), jnp.where(better, site, best)

    def conclude(state: Search, score: Any, best: Any, going: Any, grid: Grid) -> tuple[Search, Any]:
        better = score < state.score
        score = jnp.where(better, score, state.score)
        best = jnp.where(better, best, state.best)
        dead = Box(*(jnp.where(going, n, d) for n, d in zip(state.new, state.dead, strict=True)))
        target = question.region(state.query, score, grid)
        done = going & contains(dead, target)
        rounds = state.rounds + going
        growth = jnp.left_shift(1, (rounds - 1) // 2)
        new = extend(dead, target, jnp.where(rounds < ROUNDS_BEFORE_ALL, growth, EVERY_CELL))
        new = Box(*(jnp.where(going, g, n) for g, n in zip(new, state.new, strict=True)))
        return Search(state.index, state.query, score, best, dead, new, rounds), done

    return _Steps(begin, request, examine, conclude)


def _cells_to_open(new: Box, dead: Box) -> Any:
    return volume(new) - volume(dead)


def _fits(before: Any) -> Any:
    return before < MOST_REQUESTS


def _if(flag: Any, a: Any, b: Any) -> Any:
    return jnp.where(flag, a, b)


def _warrants_for(count: Any) -> Any:
    return (count + SITES_PER_WARRANT - 1) // SITES_PER_WARRANT


def _range(start: Any, count: Any, k: Any) -> tuple[Any, Any]:
    first = k * SITES_PER_WARRANT
    return start + first, jnp.minimum(count - first, SITES_PER_WARRANT)
