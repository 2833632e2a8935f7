"""The first Delaunay facet of every site, by gift wrapping.

Teng et al. 1993, section 3: b nearest to a gives a Delaunay edge, and the c of smallest circumcircle with
(a, b) a Delaunay facet.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import jax.numpy as jnp

import scanvec as sv

from .boxes import Box, Grid, containment_box
from .buckets import Buckets
from .points import Point, add, bounding_box, cross, dot, scale, sub
from .search import search
from .warrants import Question


class Ball(NamedTuple):
    centre: Point
    radius: Any


def ball_box(ball: Ball, grid: Grid) -> Box:
    """The cells that a ball meets, and perhaps a few more."""
    radius = ball.radius * (1 + 1e-5) + grid.side * 1e-3
    reach = Point(radius, radius, radius)
    return containment_box(sub(ball.centre, reach), add(ball.centre, reach), grid)


def squared_distance_to_box(p: Point, low: Point, high: Point) -> Any:
    """Squared distance from a point to the nearest point of a box; 0 inside it."""
    gap = Point(
        *(jnp.maximum(jnp.maximum(lo - v, v - hi), 0) for v, lo, hi in zip(p, low, high, strict=True))
    )
    return dot(gap, gap)


def ball_meets(ball: Ball, low: Point, high: Point) -> Any:
    return squared_distance_to_box(ball.centre, low, high) <= ball.radius * ball.radius * (1 + 1e-5)


# the nearest site


class Start(NamedTuple):
    a: Point
    site: Any


def _nearest_score(query: Start, site: Point, index: Any) -> tuple[Any, Any]:
    d = sub(site, query.a)
    score = jnp.where(index == query.site, jnp.inf, dot(d, d))
    return score, score


def _nearest_ball(query: Start, score: Any) -> Ball:
    return Ball(query.a, jnp.sqrt(score))


NEAREST = Question(
    score=_nearest_score,
    homes=lambda query: (query.site,),
    region=lambda query, score, grid: ball_box(_nearest_ball(query, score), grid),
    admits=lambda query, score, low, high: ball_meets(_nearest_ball(query, score), low, high),
    trial=lambda query, k: jnp.full_like(query.a.x, jnp.inf),
)


# the smallest circumcircle with an edge


class Edge(NamedTuple):
    a: Point
    b: Point
    site_a: Any
    site_b: Any


def squared_circumradius(a: Point, b: Point, c: Point) -> Any:
    """|ab|^2 |ac|^2 |bc|^2 / (4 |ab x ac|^2); inf for flat triangles."""
    ab, ac, bc = sub(b, a), sub(c, a), sub(c, b)
    normal = cross(ab, ac)
    area = dot(normal, normal)
    flat = area <= 0
    product = dot(ab, ab) * dot(ac, ac) * dot(bc, bc)
    return jnp.where(flat, jnp.inf, product / jnp.where(flat, 1, 4 * area))


def _circle_score(query: Edge, site: Point, index: Any) -> tuple[Any, Any]:
    own = (index == query.site_a) | (index == query.site_b)
    score = jnp.where(own, jnp.inf, squared_circumradius(query.a, query.b, site))
    return score, score


def _circle_ball(query: Edge, score: Any) -> Ball:
    # A circle of radius R through a and b has its centre within h = sqrt(R^2 - |ab|^2/4) of their midpoint,
    # so any c whose circle is smaller lies within R + h of it.
    edge = sub(query.b, query.a)
    height = jnp.sqrt(jnp.maximum(score - dot(edge, edge) / 4, 0))
    return Ball(scale(0.5, add(query.a, query.b)), jnp.sqrt(score) + height)


SMALLEST_CIRCLE = Question(
    score=_circle_score,
    homes=lambda query: (query.site_a, query.site_b),
    region=lambda query, score, grid: ball_box(_circle_ball(query, score), grid),
    admits=lambda query, score, low, high: ball_meets(_circle_ball(query, score), low, high),
    trial=lambda query, k: jnp.full_like(query.a.x, jnp.inf),
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
