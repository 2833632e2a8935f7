"""Loops of extrapolation that would not end: each ends in an `InternalError`.

No input leads there, so what the loops rely on is broken on purpose.
"""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import dt3d
import scanvec as sv
from dt3d.extrapolation import cell_requests, consistency, dictionary
from dt3d.extrapolation.buckets import bucket
from dt3d.extrapolation.compiled import facet_table, mesh
from dt3d.extrapolation.gift_wrapping import NEAREST, Start
from dt3d.extrapolation.outcome import Outcome
from dt3d.extrapolation.points import Point
from dt3d.extrapolation.tree import search as tree_search

MACHINE = sv.Simulated(processors=1)


def full_dictionary(slots):
    """All slots are taken by one entry."""
    return dictionary.Dictionary(MACHINE.full(slots, 0, np.int32), (MACHINE.full(1, 5, np.int32),))


def test_a_full_dictionary_is_not_searched_for_ever():
    table = full_dictionary(16)
    assert dictionary.look_up(table, (MACHINE.full(1, 5, np.int32),)).to_numpy().tolist() == [0]
    with pytest.raises(dt3d.InternalError, match="a key has looked at all 16 slots.*please report"):
        dictionary.look_up(table, (MACHINE.full(1, 7, np.int32),))
    with pytest.raises(dt3d.InternalError, match="a key has looked at all 16 slots"):
        dictionary.insert(table, (MACHINE.full(2, 7, np.int32),))


def test_a_full_table_of_facets_is_not_searched_for_ever():
    corners = jnp.tile(jnp.array([500, 501, 502, 1], jnp.int32), 20)
    facet = tuple(jnp.full(20, v, jnp.int32) for v in (500, 501, 502))
    half, every = 4 * jnp.arange(20, dtype=jnp.int32) + 3, jnp.ones(20, bool)
    with jax.enable_x64(True):
        look_up, insert = jax.jit(facet_table.look_up), jax.jit(facet_table.insert)
        full, slot = jnp.zeros(64, jnp.int32), jnp.full(20, 40, jnp.int32)
        assert int(look_up(full, corners, facet, every)[2]) == 20
        assert int(insert(full, corners, facet, half, slot, every)[2]) == 20
        one_is_free = full.at[40].set(dictionary.EMPTY_SLOT)  # which is enough for one facet
        assert int(look_up(one_is_free, corners, facet, every)[2]) == 0
        _, found, unplaced = insert(one_is_free, corners, facet, half, slot, every)
        assert found.tolist() == [dictionary.ABSENT, *[3] * 19]
        assert int(unplaced) == 0


def test_more_facets_than_the_table_has_slots(monkeypatch):
    tetrahedra = np.arange(160, dtype=np.int32).reshape(40, 4)
    with jax.enable_x64(True):
        mesh.begun_with(tetrahedra, 64, 32)
        monkeypatch.setattr(mesh, "SLOTS_PER_TETRAHEDRON", 1)
        with pytest.raises(dt3d.InternalError, match="96 facets have looked at all 64 slots"):
            mesh.begun_with(tetrahedra, 64, 32)


def nearest(sites, **functions):
    """Buckets, queries for the sites nearest to all, and the spec with some functions changed."""
    points = Point(*(MACHINE.vector(np.ascontiguousarray(x)) for x in sites.T))
    buckets = bucket(points)
    queries = Start(buckets.sites, MACHINE.iota(len(sites)))
    return buckets, queries, replace(NEAREST, **functions)


def test_a_tree_search_with_bounds_that_are_no_numbers():
    sites = np.random.default_rng(0).random((60, 3))
    buckets, queries, spec = nearest(sites, trial_bound=lambda query, k: jnp.full_like(query.a.x, jnp.nan))
    assert len(tree_search.search(buckets, queries, NEAREST).best.site) == 60
    with pytest.raises(dt3d.InternalError, match="60 of 60 searches in a tree do not end"):
        tree_search.search(buckets, queries, spec)


def test_a_cell_search_whose_boxes_do_not_grow(monkeypatch):
    sites = np.random.default_rng(0).random((200, 3))
    buckets, queries, spec = nearest(sites, start_sites=lambda query: (query.site,))
    monkeypatch.setattr(cell_requests, "ROUNDS_BETWEEN_CHECKS", 4)
    first = queries.a, queries.a
    assert len(cell_requests.search(buckets, queries, first, NEAREST).best.site) == 200
    monkeypatch.setattr(cell_requests, "contains", lambda outer, inner: jnp.zeros_like(outer.x0, bool))
    with pytest.raises(dt3d.InternalError, match="a search through cells has taken .* rounds"):
        cell_requests.search(buckets, queries, first, spec)


def test_more_tetrahedra_than_any_triangulation_has():
    consistency.check_progress(Outcome(per_iteration=[50]), 10, True)
    too_many = Outcome(per_iteration=[50, 1])
    with pytest.raises(dt3d.InternalError, match="51 tetrahedra of 10 sites were found"):
        consistency.check_progress(too_many, 10, True)
    with pytest.raises(dt3d.InconsistencyError, match="Use method='insertion'"):
        consistency.check_progress(too_many, 10, False)
