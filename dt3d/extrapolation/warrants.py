"""Warrants: a query examines a few sites and keeps the one of least score.

Teng et al. 1993, section 4.2. Three searches of the algorithm (a nearest site, a smallest circumcircle, a
face expansion) ask for the site of least score near a query. A score may be known up to rounding only, so it
is a pair of bounds, and a result says whether the bounds leave more than one site.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

import scanvec as sv

from .buckets import SITES_PER_CELL, Buckets

SITES_PER_WARRANT = SITES_PER_CELL
NO_SITE = -1


@dataclass(frozen=True)
class Question:
    """What a kind of query asks. The functions are elementwise, on one query at a time.

    Attributes
    ----------
    score : (query, site: Point, index) -> (low, high)
        Bounds of what the best site has least of; both inf for sites that are no answer.
    homes : (query) -> tuple of site indices
        Sites near which a first candidate may be found.
    region : (query, high, grid) -> Box
        All cells that could hold a site whose score is below ``high``.
    admits : (query, high, low: Point, high: Point) -> bool
        Whether the box with these corners could hold a site of score below ``high``. May say yes wrongly,
        never no.
    trial : (query, k) -> float
        The k-th bound to try, from 0; from some k on inf. What is found does not depend on it.
    """

    score: Callable
    homes: Callable
    region: Callable
    admits: Callable
    trial: Callable


class Best(NamedTuple):
    """What is known of the least score among some sites."""

    low: Any  # the least lower bound
    site: Any  # whose it is, or NO_SITE
    second: Any  # the least lower bound of the other sites
    high: Any  # the least upper bound


class Answer(NamedTuple):
    """The outcome of a search over m queries."""

    best: Best  # vectors of length m
    sites_searched: int


def least(a: Best, b: Best) -> Best:
    """What is known of the least score among the sites of both."""
    other = b.low < a.low
    return Best(
        jnp.minimum(a.low, b.low),
        jnp.where(other, b.site, a.site),
        jnp.minimum(jnp.maximum(a.low, b.low), jnp.minimum(a.second, b.second)),
        jnp.minimum(a.high, b.high),
    )


LEAST = sv.Monoid("least", least, lambda dtypes: Best(np.inf, NO_SITE, np.inf, np.inf))


def nothing_found(machine: sv.Machine, m: int, dtype: Any) -> Best:
    infinite = machine.full(m, np.inf, dtype)
    return Best(infinite, machine.full(m, NO_SITE, np.int32), infinite, infinite)


def execute(buckets: Buckets, query: Any, start: sv.Vector, length: sv.Vector, question: Question) -> Best:
    """Warrants: the best of each query's few sites, ``length`` of them from ``start``, at most eight."""
    machine = start.machine
    best = nothing_found(machine, len(start), buckets.sites.x.dtype)
    for k in range(SITES_PER_WARRANT):
        site = start + k
        active = length > k
        point = sv.get(buckets.sites, site, where=active, otherwise=0)
        best = machine.map(_examination(question), query, point, site, active, best)
    return best


@cache  # so that compiled kernels are found again
def _examination(question: Question) -> Callable:
    def examine(query: Any, point: Any, site: Any, active: Any, best: Best) -> Best:
        low, high = question.score(query, point, site)
        worst = jnp.full_like(low, jnp.inf)
        low, high = jnp.where(active, low, worst), jnp.where(active, high, worst)
        return least(best, Best(low, jnp.where(low < worst, site, NO_SITE), worst, high))

    return examine


def better_of(a: Best, b: Best) -> Best:
    """The best of both, elementwise; of equal lower bounds the first's site."""
    return a.low.machine.map(least, a, b)
