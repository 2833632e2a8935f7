"""One thread with interleaved searches: the same triangles, and every site once."""

import numpy as np
import pytest

from dt3d.threaded2d import Delaunay
from dt3d.threaded2d import columns as c
from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.lookahead.alone import METHOD, step, tools
from dt3d.threaded2d.steps import CHANGED, DONE, FINISHED, LOCATED
from dt3d.threaded2d.virtual_time.costs import prepared

from ..families import EVERY_SET, uniform
from ..stepping import assert_delaunay


def test_several_sites_are_located_then_inserted_one_by_one():
    options = Options(method="sequential", order="random", interleave=5)
    store, schedule = prepared(uniform(60), options)
    t = tools(store, schedule, options)
    mesh = store.mesh()
    assert [step(mesh, 0, t) for _ in range(5)] == [LOCATED] * 5
    assert store.state[0, c.INSERTED] == 0
    assert [step(mesh, 0, t) for _ in range(5)] == [CHANGED] * 5
    assert store.state[0, c.INSERTED] == 5
    assert METHOD.run(mesh, 0, t) == DONE
    assert store.state[0, c.INSERTED] == 57
    assert step(mesh, 0, t) == FINISHED
    assert_delaunay(store)


@pytest.mark.parametrize("name", EVERY_SET)
def test_the_triangles_are_those_of_one_site_at_a_time(name):
    points = EVERY_SET[name](400)
    one, eight = (Delaunay(points, method="sequential", interleave=k, order="random") for k in (1, 8))
    assert (one.stats.interleave, eight.stats.interleave) == (1, 8)
    np.testing.assert_array_equal(*(np.unique(np.sort(t.simplices, axis=1), axis=0) for t in (one, eight)))
    assert eight.inserted_by.tolist() == one.inserted_by.tolist()
