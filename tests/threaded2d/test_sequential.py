"""The sequential method: each site is located, then inserted; between, the triangulation is Delaunay."""

import numpy as np
import pytest

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.mesh import ROOTS
from dt3d.threaded2d.sequential import METHOD, step
from dt3d.threaded2d.steps import CHANGED, DONE, FINISHED, LOCATED

from .families import uniform
from .stepping import assert_delaunay, begun, conflicts, leaves


@pytest.mark.parametrize("location", ["dag", "walk"])
def test_site_by_site(location):
    store, tools = begun(uniform(60), "sequential", 1, location)
    mesh, state = store.mesh(), store.state[0]
    for count, q in enumerate(tools.schedule.order.tolist()):
        assert step(mesh, 0, tools) == LOCATED
        assert state[c.SITE] == q
        assert state[c.NODE] in leaves(store)
        assert conflicts(store, state[c.NODE], q)
        assert state[c.INSERTED] == count
        flips = int(state[c.FLIPS])
        assert step(mesh, 0, tools) == CHANGED
        assert store.nodes[state[c.HINT], 0] == q
        # subdivision gives a site three neighbours, and each flip one more
        degree = int((store.nodes[leaves(store), :3] == q).any(axis=1).sum())
        assert state[c.FLIPS] - flips == degree - 3
        assert_delaunay(store)
    assert step(mesh, 0, tools) == FINISHED


@pytest.mark.parametrize("location", ["dag", "walk"])
def test_a_run_does_the_same_as_its_steps(location):
    points = uniform(300)
    store, tools = begun(points, "sequential", 1, location)
    assert METHOD.run(store.mesh(), 0, tools) == DONE
    assert_delaunay(store)
    again, tools = begun(points, "sequential", 1, location)
    while METHOD.step(again.mesh(), 0, tools) != FINISHED:
        pass
    np.testing.assert_array_equal(store.nodes, again.nodes)
    counts = [c.INSERTED, c.VISITED, c.FLIPS]
    np.testing.assert_array_equal(store.state[0, counts], again.state[0, counts])
    # what the history holds: the roots, three triangles of each subdivision, two of each flip
    inserted, _, flips = store.state[0, counts].tolist()
    assert inserted == 297
    assert np.count_nonzero(store.nodes[:, c.CHILD]) == ROOTS + 3 * inserted + 2 * flips
