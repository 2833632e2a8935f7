"""The search through the tree of boxes, for sites that do not fill space evenly.

The leaves of a query's start sites give a first bound of its score. Then it descends into every box that
could hold a better site, and searches the leaves it comes to: first under a bound that is small enough to be
cheap, and if nothing is found below it under greater ones, up to the first bound or without any.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Generic, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

import scanvec as sv

from ..._errors import InternalError
from ..buckets import Buckets
from ..points import Point, T
from ..warrants import (
    LEAST_BOUNDS,
    Best,
    Q,
    Ranges,
    SearchResult,
    SearchSpec,
    better_of,
    execute,
    nothing_found,
)
from .boxes import FANOUT, descend, entry_test

# Trials before the search does without a bound, which is the last one; more than any spec has.
MOST_TRIALS = 64


class Bounded(NamedTuple, Generic[Q, T]):
    """A query and the score that a site must be below."""

    query: Q
    high: T


class _Steps(NamedTuple):
    """The elementwise steps for one kind of query."""

    enter: Callable[..., Array]
    bound: Callable[..., Bounded[object, Array]]


@cache  # so that compiled kernels are found again
def _steps_of(spec: SearchSpec[Q]) -> _Steps:
    def may_contain(query: Bounded[Q, Array], low: Point[Array], high: Point[Array]) -> Array:
        return spec.may_contain(query.query, query.high, low, high)

    def bound(query: Q, known: Array, trial: Array) -> Bounded[object, Array]:
        return Bounded(query, jnp.minimum(known, spec.trial_bound(query, trial)))

    return _Steps(entry_test(may_contain), bound)


class _Search(NamedTuple):
    """State of the queries that are still searching."""

    place: sv.Vector  # the query's among all
    query: object
    known: sv.Vector  # an upper bound of the score, from the start sites


def search(buckets: Buckets, queries: object, spec: SearchSpec[Q]) -> SearchResult:
    """The site of least score for each of m queries, a record of vectors of length m."""
    machine, m = buckets.machine, len(jax.tree.leaves(queries)[0])
    steps = _steps_of(spec)
    near = nothing_found(machine, m, buckets.sites.x.dtype)
    searched = 0
    for site in machine.map(spec.start_sites, queries):
        found, count = _search_leaves(buckets, queries, site // FANOUT, spec)
        near, searched = better_of(near, found), searched + count

    result = nothing_found(machine, m, buckets.sites.x.dtype)
    state, trial = _Search(machine.iota(m), queries, near.high), 0
    while len(state.place):
        if trial == MOST_TRIALS:
            msg = f"{len(state.place)} of {m} searches in a tree do not end without a bound"
            raise InternalError(msg)
        bounded = machine.map(steps.bound, state.query, state.known, trial)
        best, count = _below(buckets, bounded, spec)
        # what lies below a bound is complete, and nothing else is
        done = machine.map(_is_complete, best.high, bounded.high, state.known)
        result = sv.scatter(best, state.place, into=result, where=done)
        state = sv.pack(state, ~done)
        searched, trial = searched + count, trial + 1
    return SearchResult(result, searched)


def _is_complete(found: Array, bound: Array, known: Array) -> Array:
    return (found <= bound) | (bound == known)


def _search_leaves(
    buckets: Buckets, queries: object, leaf: sv.Vector, spec: SearchSpec[Q]
) -> tuple[Best[sv.Vector], int]:
    start, length = leaf.machine.map(_sites_of_leaf, leaf, len(buckets.origin))
    return execute(buckets, queries, Ranges(start, length, FANOUT), spec), int(sv.reduce(length, sv.ADD))


def _sites_of_leaf(leaf: Array, n: Array) -> tuple[Array, Array]:
    start = FANOUT * leaf
    return start, jnp.clip(n - start, 0, FANOUT)


def _below(
    buckets: Buckets, queries: Bounded[object, sv.Vector], spec: SearchSpec[Q]
) -> tuple[Best[sv.Vector], int]:
    """The best of the sites that could have a score below each query's bound."""
    machine, m = buckets.machine, len(queries.high)
    best = nothing_found(machine, m, buckets.sites.x.dtype)
    searched = 0
    for requests in descend(buckets.tree, queries, _steps_of(spec).enter):
        own = sv.get(queries.query, requests.query)
        found, count = _search_leaves(buckets, own, requests.node, spec)
        ones = machine.full(len(requests.query), 1, np.int32)
        counts = sv.send(ones, requests.query, sv.ADD, into=machine.full(m, 0, np.int32))
        best = better_of(best, sv.reduce(found, LEAST_BOUNDS, sv.Segments.from_lengths(counts)))
        searched += count
    return best, searched
