"""The rounds of requests end, and wait where memory is bounded."""

from dataclasses import replace

import jax.numpy as jnp
import numpy as np
import pytest

import dt3d
from dt3d.extrapolation import cell_requests
from dt3d.extrapolation.buckets import bucket
from dt3d.extrapolation.gift_wrapping import NEAREST, Start
from dt3d.extrapolation.points import Point

from .searching import MACHINE, SETS, nearest


def test_queries_wait_where_memory_is_bounded(monkeypatch):
    buckets = bucket(Point(*(MACHINE.vector(c.copy()) for c in SETS["uniform"].T)))
    free = nearest(buckets)
    monkeypatch.setattr(cell_requests, "MOST_CELL_REQUESTS", 64)
    bounded = nearest(buckets)
    np.testing.assert_array_equal(bounded.best.site.to_numpy(), free.best.site.to_numpy())
    assert bounded.sites_searched == free.sites_searched


def nearest_with(sites, **functions):
    """Buckets, queries for the sites nearest to all, and the spec with some functions changed."""
    points = Point(*(MACHINE.vector(np.ascontiguousarray(x)) for x in sites.T))
    buckets = bucket(points)
    queries = Start(buckets.sites, MACHINE.iota(len(sites)))
    return buckets, queries, replace(NEAREST, **functions)


def test_a_cell_search_whose_boxes_do_not_grow(monkeypatch):
    sites = np.random.default_rng(0).random((200, 3))
    buckets, queries, spec = nearest_with(sites, start_sites=lambda query: (query.site,))
    monkeypatch.setattr(cell_requests, "ROUNDS_BETWEEN_CHECKS", 4)
    first = queries.a, queries.a
    assert len(cell_requests.search(buckets, queries, first, NEAREST).best.site) == 200
    monkeypatch.setattr(cell_requests, "contains", lambda outer, inner: jnp.zeros_like(outer.x0, bool))
    with pytest.raises(dt3d.InternalError, match="a search through cells has taken .* rounds"):
        cell_requests.search(buckets, queries, first, spec)
