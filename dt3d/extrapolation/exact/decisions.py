"""Exact face expansions: the filtered search, and exact decisions where it leaves several sites open.

Sites are perturbed symbolically: site p is lifted to height |p|^2 + e_p with infinitesimals e_p. Then each
face has one right fourth vertex, which depends on nothing but the sites (`dt3d.predicates.space`).
"""

from __future__ import annotations

import warnings
from typing import Generic, NamedTuple, TypeAlias

import jax.numpy as jnp
import numpy as np
from jax import Array

import scanvec as sv

from ..._errors import QuadraticSearchWarning
from ..expansion import OpenFace, search_faces
from ..faces import Face
from ..outcome import Counts, added, counted
from ..points import Point, T
from ..tree.boxes import FANOUT, Request, descend, entry_test, unfold
from ..tree.search import Bounded
from ..warrants import NO_SITE, Best
from .expansion import FILTERED, ExactFace, open_face
from .filtered_distance import Frame
from .sites import ExactSites

# Leaves that a face compares exactly, on average, before a warning says so.
CROWD = 256

# open faces whose signed distance must be at most a bound
_Queries: TypeAlias = Bounded[OpenFace[Frame, sv.Vector], sv.Vector]


class Expansion(NamedTuple, Generic[T]):
    """The outcome of expanding m faces; vectors of length m."""

    site: T  # int32; NO_SITE where no site is on the positive side
    low: T  # a lower bound of its signed distance; -inf where exact decisions were needed
    violator: T  # int32: a coplanar site inside the face's perturbed circumcircle, or NO_SITE


def expand_exactly(exact: ExactSites, faces: Face[sv.Vector]) -> tuple[Expansion[sv.Vector], Counts]:
    """The fourth vertex of each face under the symbolic perturbation."""
    buckets = exact.buckets
    machine, m = buckets.machine, len(faces.a)
    corners = [sv.get(buckets.sites, v) for v in faces]
    queries = machine.map(open_face, faces, *corners, exact.lattice)
    result = search_faces(buckets, queries, corners, FILTERED)
    best, more = result.best, 0
    site, low, undecided = machine.map(_conclude, best)
    violator = machine.full(m, NO_SITE, np.int32)
    index = sv.pack_index(undecided)
    if len(index):
        few, bound = sv.get((queries, best.high), index)
        winner, violating, more = _decide(exact, Bounded(few, bound))
        site, violator = sv.scatter((winner, violating), index, into=(site, violator))
    counts = added(counted(m, result, len(index)), Counts(sites_searched=more))
    return Expansion(site, low, violator), counts


def _conclude(best: Best[Array]) -> tuple[Array, Array, Array]:
    """The site and its lower bound, if only one is left; and whether more are."""
    undecided = (best.low < jnp.inf) & ~(best.second > best.high)
    return best.site, jnp.where(undecided, -jnp.inf, best.low), undecided


def _decide(exact: ExactSites, queries: _Queries) -> tuple[sv.Vector, sv.Vector, int]:
    """For each face the winner among the sites that its bound leaves, and a violating site."""
    machine, m = exact.buckets.machine, len(queries.high)
    faces = queries.query.face
    above = coplanar = Request(machine.full(0, 0, np.int32), machine.full(0, 0, np.int32))
    searched = 0
    for requests in descend(exact.buckets.tree, queries, _ENTER):
        _warn_of_crowds(requests)
        searched += FANOUT * len(requests.query)
        pairs = unfold(requests, _open_sites(exact, queries, requests))
        sign = exact.orientation(sv.get(faces, pairs.query), pairs.node)
        above = sv.append(above, sv.pack(pairs, sign > 0))
        coplanar = sv.append(coplanar, sv.pack(pairs, sign == 0))
    no_site = machine.full(m, NO_SITE, np.int32)
    rivals = _tournament(exact, faces, above)
    winner = sv.scatter(rivals.node, rivals.query, into=no_site)

    apex = sv.get(winner, coplanar.query)
    beside, apex = sv.pack((coplanar, apex), apex != NO_SITE)
    violates = exact.inside(sv.get(faces, beside.query), apex, beside.node)
    violator = sv.send(beside.node, beside.query, sv.MAX, into=no_site, where=violates)
    return winner, violator, searched


def _warn_of_crowds(requests: Request[sv.Vector]) -> None:
    """Say so where the faces of a batch have thousands of rivals each."""
    n = len(requests.query)
    if n > CROWD:
        machine = requests.query.machine
        faces = int(machine.item(requests.query, -1)) - int(machine.item(requests.query, 0)) + 1
        if n > CROWD * faces:
            msg = (
                f"over {FANOUT * CROWD} sites are nearly cospherical with an open face, on average, and all "
                f"are compared exactly: time grows with the square of their number. method='insertion' "
                f"finishes such sets"
            )
            warnings.warn(msg, QuadraticSearchWarning, stacklevel=2)


def _enters(query: Bounded[ExactFace, Array], low: Point[Array], high: Point[Array]) -> Array:
    return FILTERED.may_contain(query.query, query.high, low, high)


_ENTER = entry_test(_enters)


def _open_sites(exact: ExactSites, queries: _Queries, requests: Request[sv.Vector]) -> sv.Vector:
    """For each leaf a mask of the sites that may be its query's result."""
    machine, n = requests.query.machine, len(exact.buckets.origin)
    query = sv.get(queries, requests.query)
    mask = machine.full(len(requests.query), 0, np.int32)
    for k in range(FANOUT):
        site = requests.node * FANOUT + k
        exists = site < n
        point = sv.get(exact.buckets.sites, site, where=exists, otherwise=0)
        mask = machine.map(_mark, mask, query, point, site, exists, k)
    return mask


def _mark(
    mask: Array, query: Bounded[ExactFace, Array], point: Point[Array], site: Array, exists: Array, k: Array
) -> Array:
    low, _ = FILTERED.score(query.query, point, site)
    return mask | jnp.where(exists & (low < jnp.inf) & (low <= query.high), jnp.left_shift(1, k), 0)


def _tournament(exact: ExactSites, faces: Face[sv.Vector], rivals: Request[sv.Vector]) -> Request[sv.Vector]:
    """One site for each face that has any: the one inside whose sphere with the face no other is.

    Neighbours in the list of a face meet, and the winners go on: as many rounds as the logarithm of the
    longest list. Every round makes the list shorter.
    """
    while True:
        segments = sv.Segments.from_ids(rivals.query)
        place = segments.offsets
        left = place % 2 == 0
        pair = left & (place + 1 < sv.get(segments.lengths, segments.ids))
        index = sv.pack_index(pair)
        if not len(index):
            return rivals
        owner, champion = sv.get(rivals, index)
        challenger = sv.get(rivals.node, index + 1)
        wins = exact.inside(sv.get(faces, owner), champion, challenger)
        winner = sv.where(wins, challenger, champion)
        sites = sv.scatter(winner, index, into=rivals.node)
        rivals = sv.pack(Request(rivals.query, sites), left)
