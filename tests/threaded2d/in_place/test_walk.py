"""A walk in place ends in a triangle that contains the site, or in a ghost that it is beyond."""

import pytest

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.in_place.walk import walk

from ..families import EVERY_SET, uniform
from ..stepping import conflicts, leaves, orientation
from .stars import half_inserted


@pytest.mark.parametrize("name", EVERY_SET)
def test_from_anywhere_to_where_the_site_is(name):
    store, _, others = half_inserted(EVERY_SET[name](80))
    mesh, present = store.mesh(), leaves(store).tolist()
    for q in others.tolist():
        for t in present[::5]:
            found, steps = walk(mesh, t, q)
            assert found in present
            assert steps <= len(present)
            row = store.nodes[found, :3].tolist()
            edges = [(row[k], row[(k + 1) % 3]) for k in range(3)]
            turns = [orientation(store.points, a, b, q) for a, b in edges if min(a, b) >= 0]
            # the one edge of a ghost is the hull's, seen from beyond
            assert min(turns) >= 0
            if name == "uniform" and len(turns) == 1:
                assert turns[0] > 0


def test_no_step_from_the_triangle_itself():
    store, _, others = half_inserted(uniform(80))
    mesh = store.mesh()
    for q in others.tolist():
        t, _ = walk(mesh, 4, q)
        assert conflicts(store, t, q)
        if store.nodes[t, :3].min() >= 0:
            assert walk(mesh, t, q) == (t, 0)
            beyond = int(store.nodes[t, c.NEIGHBOR]) // 4
            again, one = walk(mesh, beyond, q)
            assert again == t
            assert one >= 1
