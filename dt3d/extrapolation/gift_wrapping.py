"""The first Delaunay facet of every site, by gift wrapping.

Teng et al. 1993, section 3: b nearest to a gives a Delaunay edge, and the c of smallest circumcircle with
(a, b) a Delaunay facet.
"""

from __future__ import annotations

from typing import Generic, NamedTuple

import jax.numpy as jnp
from jax import Array

import scanvec as sv

from .boxes import Box, Grid, containment_box
from .buckets import Buckets
from .points import Point, T, add, bounding_box, cross, dot, scale, sub
from .search import search
from .warrants import SearchSpec


class Ball(NamedTuple):
    """Where a nearer site, or one of a smaller circle, must be."""

    centre: Point[Array]
    radius: Array


def ball_box(ball: Ball, grid: Grid[Array]) -> Box[Array]:
    """The cells that a ball meets, and perhaps a few more."""
    radius = ball.radius * (1 + 1e-5) + grid.side * 1e-3
    half = Point(radius, radius, radius)
    return containment_box(sub(ball.centre, half), add(ball.centre, half), grid)


def squared_distance_to_box(p: Point[Array], low: Point[Array], high: Point[Array]) -> Array:
    """Squared distance from a point to the nearest point of a box; 0 inside it."""
    gap = Point(
        *(jnp.maximum(jnp.maximum(lo - v, v - hi), 0) for v, lo, hi in zip(p, low, high, strict=True))
    )
    return dot(gap, gap)


def ball_meets(ball: Ball, low: Point[Array], high: Point[Array]) -> Array:
    """Whether a ball, a little widened, meets a box."""
    return squared_distance_to_box(ball.centre, low, high) <= ball.radius * ball.radius * (1 + 1e-5)


# the nearest site


class Start(NamedTuple, Generic[T]):
    """A site that looks for the nearest one."""

    a: Point[T]
    site: T


def _nearest_score(query: Start[Array], site: Point[Array], index: Array) -> tuple[Array, Array]:
    d = sub(site, query.a)
    score = jnp.where(index == query.site, jnp.inf, dot(d, d))
    return score, score


def _nearest_ball(query: Start[Array], score: Array) -> Ball:
    return Ball(query.a, jnp.sqrt(score))


NEAREST: SearchSpec[Start[Array]] = SearchSpec(
    score=_nearest_score,
    start_sites=lambda query: (query.site,),
    region=lambda query, score, grid: ball_box(_nearest_ball(query, score), grid),
    may_contain=lambda query, score, low, high: ball_meets(_nearest_ball(query, score), low, high),
    trial_bound=lambda query, k: jnp.full_like(query.a.x, jnp.inf),
)


# the smallest circumcircle with an edge


class Edge(NamedTuple, Generic[T]):
    """A Delaunay edge that looks for the site of the smallest circle with it."""

    a: Point[T]
    b: Point[T]
    site_a: T
    site_b: T


def squared_circumradius(a: Point[Array], b: Point[Array], c: Point[Array]) -> Array:
    """|ab|^2 |ac|^2 |bc|^2 / (4 |ab x ac|^2); inf for flat triangles."""
    ab, ac, bc = sub(b, a), sub(c, a), sub(c, b)
    normal = cross(ab, ac)
    area = dot(normal, normal)
    flat = area <= 0
    product = dot(ab, ab) * dot(ac, ac) * dot(bc, bc)
    return jnp.where(flat, jnp.inf, product / jnp.where(flat, 1, 4 * area))


def _circle_score(query: Edge[Array], site: Point[Array], index: Array) -> tuple[Array, Array]:
    own = (index == query.site_a) | (index == query.site_b)
    score = jnp.where(own, jnp.inf, squared_circumradius(query.a, query.b, site))
    return score, score


def _circle_ball(query: Edge[Array], score: Array) -> Ball:
    # A circle of radius R through a and b has its centre within h = sqrt(R^2 - |ab|^2/4) of their midpoint,
    # so any c whose circle is smaller lies within R + h of it.
    edge = sub(query.b, query.a)
    height = jnp.sqrt(jnp.maximum(score - dot(edge, edge) / 4, 0))
    return Ball(scale(0.5, add(query.a, query.b)), jnp.sqrt(score) + height)


SMALLEST_CIRCLE: SearchSpec[Edge[Array]] = SearchSpec(
    score=_circle_score,
    start_sites=lambda query: (query.site_a, query.site_b),
    region=lambda query, score, grid: ball_box(_circle_ball(query, score), grid),
    may_contain=lambda query, score, low, high: ball_meets(_circle_ball(query, score), low, high),
    trial_bound=lambda query, k: jnp.full_like(query.a.x, jnp.inf),
)


def first_facets(buckets: Buckets, a: sv.Vector | None = None) -> tuple[sv.Vector, sv.Vector, sv.Vector]:
    """A Delaunay facet (a, b, c) for every site a, or for those given: three int32 vectors of one length."""
    sites, machine = buckets.sites, buckets.machine
    starts = sites if a is None else sv.get(sites, a)
    a = machine.iota(len(buckets.origin)) if a is None else a
    b = search(buckets, Start(starts, a), (starts, starts), NEAREST).best.site
    ends = starts, sv.get(sites, b)
    first = machine.map(bounding_box, *ends)
    c = search(buckets, Edge(*ends, a, b), first, SMALLEST_CIRCLE).best.site
    return a, b, c
