"""Interleaved searches find what one location after the other finds."""

import numba
import numpy as np
import pytest

from dt3d.threaded2d import dag
from dt3d.threaded2d.lookahead import interleaved

from ..families import EVERY_SET
from ..runs import half_inserted


@numba.njit
def _by_searches(mesh, searches, sites):
    """The leaves of the sites by way of the searches."""
    found = np.full(len(mesh.points), -1)
    begun = 0
    while True:
        for i in range(len(searches)):
            if searches[i, interleaved.SEARCH_SITE] == interleaved.IDLE and begun < len(sites):
                interleaved.start(mesh, searches, i, sites[begun])
                begun += 1
        i, _ = interleaved.advance(mesh, searches)
        if i == interleaved.IDLE:
            return found
        found[searches[i, interleaved.SEARCH_SITE]] = searches[i, interleaved.SEARCH_NODE]
        searches[i, interleaved.SEARCH_SITE] = interleaved.IDLE


@numba.njit
def _one_by_one(mesh, sites):
    found = np.full(len(mesh.points), -1)
    for q in sites:
        found[q], _ = dag.locate(mesh, q)
    return found


@pytest.mark.parametrize("name", EVERY_SET)
def test_interleaved_searches_lead_to_the_leaf_that_a_location_finds(name):
    store, others = half_inserted(EVERY_SET[name](300))
    found = _by_searches(store.mesh(), interleaved.idle_searches(1)[0], others)
    np.testing.assert_array_equal(found, _one_by_one(store.mesh(), others))
