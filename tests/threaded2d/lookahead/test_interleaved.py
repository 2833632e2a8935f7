"""Interleaved searches find what one location after the other finds."""

import numba
import numpy as np
import pytest

from dt3d.threaded2d import columns as c
from dt3d.threaded2d import dag
from dt3d.threaded2d.lookahead import interleaved

from ..families import EVERY_SET
from ..runs import half_inserted


@numba.njit
def _by_searches(mesh, searches, count, sites):
    """The leaves of the sites by way of the searches, and their parents."""
    found = np.full((len(mesh.points), 2), -1)
    begun = 0
    while True:
        for i in range(count):
            if searches[i, interleaved.SEARCH_SITE] == interleaved.IDLE and begun < len(sites):
                interleaved.start(mesh, searches, i, sites[begun])
                begun += 1
        i, _ = interleaved.advance(mesh, searches, count)
        if i == interleaved.IDLE:
            return found
        q = searches[i, interleaved.SEARCH_SITE]
        found[q, 0] = searches[i, interleaved.SEARCH_NODE]
        found[q, 1] = searches[i, interleaved.SEARCH_PARENT]
        searches[i, interleaved.SEARCH_SITE] = interleaved.IDLE


@numba.njit
def _one_by_one(mesh, sites):
    found = np.full(len(mesh.points), -1)
    for q in sites:
        found[q], _ = dag.locate(mesh, q)
    return found


@pytest.mark.parametrize("count", [1, 8, 13])
@pytest.mark.parametrize("name", EVERY_SET)
def test_interleaved_searches_lead_to_the_leaf_that_a_location_finds(name, count):
    store, others = half_inserted(EVERY_SET[name](300))
    found = _by_searches(store.mesh(), interleaved.idle_searches(1, count)[0], count, others)
    np.testing.assert_array_equal(found[:, 0], _one_by_one(store.mesh(), others))
    for leaf, parent in found[others].tolist():
        children = int(store.nodes[parent, c.CHILD])
        first = c.first_child(children)
        assert first <= leaf < first + (3 if c.is_subdivided(children) else 2)
