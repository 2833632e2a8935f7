"""Warrants: a query's few consecutive sites, of which it takes the best.

Teng et al. 1993, section 4.2: a warrant performs the search over several sites for one face, as many as a
cell is expected to hold. Three searches of the algorithm (a nearest site, a smallest circumcircle, a face
expansion) ask for the site of least score near a query. A score may be known up to rounding only, so it is a
pair of bounds, and a result says whether the bounds leave more than one site.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Generic, NamedTuple, TypeVar

import jax.numpy as jnp
import numpy as np
import numpy.typing as npt
from jax import Array

import scanvec as sv

from .boxes import Box, Grid
from .buckets import Buckets
from .points import Point, T

NO_SITE = -1

Q = TypeVar("Q")  # the record of a query


@dataclass(frozen=True)
class SearchSpec(Generic[Q]):
    """What a kind of query searches for. The functions are elementwise, on one query at a time.

    Attributes
    ----------
    score : (query, site: Point, index) -> (low, high)
        Bounds of what the best site has least of; both inf for sites that do not qualify.
    start_sites : (query) -> tuple of site indices
        Sites near which a first candidate may be found.
    region : (query, high, grid) -> Box
        All cells that could hold a site whose score is below ``high``.
    may_contain : (query, high, low: Point, high: Point) -> bool
        Whether the box with these corners could hold a site of score below ``high``. May say yes wrongly,
        never no.
    trial_bound : (query, k) -> float
        The k-th bound to try, from 0; from some k on inf. What is found does not depend on it.
    closing : int
        Once there is a candidate, a box that lacks no more cells than so many grows by all of them at once.
    """

    score: Callable[[Q, Point[Array], Array], tuple[Array, Array]]
    start_sites: Callable[[Q], tuple[Array, ...]]
    region: Callable[[Q, Array, Grid[Array]], Box[Array]]
    may_contain: Callable[[Q, Array, Point[Array], Point[Array]], Array]
    trial_bound: Callable[[Q, Array], Array]
    closing: int = 0


class Best(NamedTuple, Generic[T]):
    """What is known of the least score among some sites."""

    low: T  # the least lower bound
    site: T  # whose it is, or NO_SITE
    second: T  # the least lower bound of the other sites
    high: T  # the least upper bound


class SearchResult(NamedTuple):
    """The outcome of a search over m queries."""

    best: Best[sv.Vector]  # vectors of length m
    sites_searched: int
    cells_opened: int = 0  # by a search through cells
    rounds: tuple[int, ...] = ()  # how many queries took 1, 2, ... rounds of it


def least(a: Best[Array], b: Best[Array]) -> Best[Array]:
    """What is known of the sites of both; of equal lower bounds the first's site."""
    other = b.low < a.low
    return Best(
        jnp.minimum(a.low, b.low),
        jnp.where(other, b.site, a.site),
        jnp.minimum(jnp.maximum(a.low, b.low), jnp.minimum(a.second, b.second)),
        jnp.minimum(a.high, b.high),
    )


LEAST_BOUNDS = sv.Monoid("least", least, lambda dtypes: Best(np.inf, NO_SITE, np.inf, np.inf))


def nothing_found(machine: sv.Machine, m: int, dtype: npt.DTypeLike) -> Best[sv.Vector]:
    """The best of no sites, for m queries."""
    infinite = machine.full(m, np.inf, dtype)
    return Best(infinite, machine.full(m, NO_SITE, np.int32), infinite, infinite)


def better_of(a: Best[sv.Vector], b: Best[sv.Vector]) -> Best[sv.Vector]:
    """The best of both, elementwise; of equal lower bounds the first's site."""
    best: Best[sv.Vector] = a.low.machine.map(least, a, b)
    return best


class Ranges(NamedTuple):
    """Consecutive sites: one range for each warrant."""

    start: sv.Vector  # int32 (w,)
    length: sv.Vector  # int32 (w,)
    most: int  # at least every length


def execute(buckets: Buckets, query: object, sites: Ranges, spec: SearchSpec[Q]) -> Best[sv.Vector]:
    """The best of each warrant's sites.

    Of Algorithm Face Expansion: "for each warrant w: S := the range of its site indices; w.min_sd :=
    min{SD(p) | p in w.S and p in Hp}".
    """
    start, length, most = sites
    machine = start.machine
    best = nothing_found(machine, len(start), buckets.sites.x.dtype)
    for k in range(most):
        site = start + k
        active = length > k
        point = sv.get(buckets.sites, site, where=active, otherwise=0)
        best = machine.map(_examination(spec), query, point, site, active, best)
    return best


@cache  # so that compiled kernels are found again
def _examination(spec: SearchSpec[Q]) -> Callable[..., Best[Array]]:
    def examine(query: Q, point: Point[Array], site: Array, active: Array, best: Best[Array]) -> Best[Array]:
        low, high = spec.score(query, point, site)
        worst = jnp.full_like(low, jnp.inf)
        low, high = jnp.where(active, low, worst), jnp.where(active, high, worst)
        return least(best, Best(low, jnp.where(low < worst, site, NO_SITE), worst, high))

    return examine
