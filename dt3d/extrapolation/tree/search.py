"""The search through the tree of boxes, for sites that do not fill space evenly.

The leaves of a query's home sites give a first bound of its score. Then it descends into every box that could
hold a better site, and searches the leaves it comes to: first under a bound that is small enough to be cheap,
and if nothing is found below it under greater ones, up to the first bound or without any.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np

import scanvec as sv

from ..._errors import InternalError
from ..buckets import Buckets
from ..points import Point
from ..warrants import LEAST, Answer, Best, Question, better_of, execute, nothing_found
from .boxes import FANOUT, descend, entry_test

# Trials before the search does without a bound, which is the last one; more than any question has.
MOST_TRIALS = 64


class Bounded(NamedTuple):
    """A query and the score that a site must be below."""

    query: Any
    high: Any


class _Steps(NamedTuple):
    """The elementwise steps for one question."""

    enter: Callable
    bound: Callable


@cache  # so that compiled kernels are found again
def _steps_of(question: Question) -> _Steps:
    def admits(query: Bounded, low: Point, high: Point) -> Any:
        return question.admits(query.query, query.high, low, high)

    def bound(query: Any, known: Any, trial: Any) -> Bounded:
        return Bounded(query, jnp.minimum(known, question.trial(query, trial)))

    return _Steps(entry_test(admits), bound)


class _Search(NamedTuple):
    """State of the queries that are still searching."""

    index: Any  # the query's place among all
    query: Any
    known: Any  # an upper bound of the score, from the home sites


def search(buckets: Buckets, queries: Any, question: Question) -> Answer:
    """The site of least score for each of m queries, a record of vectors of length m."""
    machine, m = buckets.machine, len(jax.tree.leaves(queries)[0])
    steps = _steps_of(question)
    near = nothing_found(machine, m, buckets.sites.x.dtype)
    searched = 0
    for home in machine.map(question.homes, queries):
        found, count = _search_leaves(buckets, queries, home // FANOUT, question)
        near, searched = better_of(near, found), searched + count

    answer = nothing_found(machine, m, buckets.sites.x.dtype)
    state, trial = _Search(machine.iota(m), queries, near.high), 0
    while len(state.index):
        if trial == MOST_TRIALS:
            msg = f"{len(state.index)} of {m} searches in a tree do not end without a bound"
            raise InternalError(msg)
        bounded = machine.map(steps.bound, state.query, state.known, trial)
        best, count = _below(buckets, bounded, question)
        # what lies below a bound is complete, and nothing else is
        done = machine.map(_is_complete, best.high, bounded.high, state.known)
        answer = sv.scatter(best, state.index, into=answer, where=done)
        state = sv.pack(state, ~done)
        searched, trial = searched + count, trial + 1
    return Answer(answer, searched)


def _is_complete(found: Any, bound: Any, known: Any) -> Any:
    return (found <= bound) | (bound == known)


def _search_leaves(buckets: Buckets, queries: Any, leaf: sv.Vector, question: Question) -> tuple[Best, int]:
    start, length = leaf.machine.map(_sites_of_leaf, leaf, len(buckets.origin))
    return execute(buckets, queries, start, length, question), int(sv.reduce(length, sv.ADD))


def _sites_of_leaf(leaf: Any, n: Any) -> tuple[Any, Any]:
    start = FANOUT * leaf
    return start, jnp.clip(n - start, 0, FANOUT)


def _below(buckets: Buckets, queries: Bounded, question: Question) -> tuple[Best, int]:
    """The best of the sites that could have a score below each query's bound."""
    machine, m = buckets.machine, len(queries.high)
    best = nothing_found(machine, m, buckets.sites.x.dtype)
    searched = 0
    for requests in descend(buckets.tree, queries, _steps_of(question).enter):
        own = sv.get(queries.query, requests.query)
        found, count = _search_leaves(buckets, own, requests.node, question)
        ones = machine.full(len(requests.query), 1, np.int32)
        counts = sv.send(ones, requests.query, sv.ADD, into=machine.full(m, 0, np.int32))
        best = better_of(best, sv.reduce(found, LEAST, sv.Segments.from_lengths(counts)))
        searched += count
    return best, searched
