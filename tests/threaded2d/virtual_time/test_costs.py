"""The costs of operations: of a run that is prepared as a real one, and measured on these points."""

import math

import numpy as np
import pytest

from dt3d.ordering.along_curve import along_curve_in_plane
from dt3d.threaded2d import columns as c
from dt3d.threaded2d import sequential
from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.steps import DONE
from dt3d.threaded2d.virtual_time import costs
from dt3d.threaded2d.virtual_time.costs import Costs, measure, prepared

from ..families import EVERY_SET, uniform
from ..runs import half_inserted
from ..stepping import across, conflicts, leaf_pairs, leaves


@pytest.mark.parametrize("name", EVERY_SET)
@pytest.mark.parametrize("order", ["brio", "random"])
def test_a_prepared_run_has_every_site_once(name, order):
    points = EVERY_SET[name](300)
    store, schedule = prepared(points, Options(method="optimistic", threads=3, order=order))
    sites, _ = along_curve_in_plane(points)
    np.testing.assert_array_equal(store.points, points[sites if order == "brio" else np.sort(sites)])
    rows = np.concatenate([store.nodes[0, :3], schedule.order])
    np.testing.assert_array_equal(np.sort(rows), np.arange(len(np.unique(points, axis=0))))
    assert len(schedule.parts) == len(store.state) == 3


@pytest.mark.parametrize("name", EVERY_SET)
def test_a_prepared_run_has_room_to_its_end(name):
    options = Options(method="sequential", order="random")
    store, schedule = prepared(EVERY_SET[name](300), options)
    tools = sequential.tools(store, schedule, options)
    assert sequential.METHOD.run(store.mesh(), 0, tools) == DONE
    assert store.used < len(store.nodes)
    assert store.state[0, c.INSERTED] == len(store.points) - 3


@pytest.mark.parametrize("order", ["brio", "random"])
def test_what_is_measured_takes_some_time(order):
    found = measure(uniform(300), order, repeats=1)
    for seconds in (found.visit, found.node, found.test):
        assert math.isfinite(seconds)
        assert seconds > 0
    assert found == Costs(*found[:3])  # the others are of the usual size
    assert min(found) > 0


def test_the_tests_that_are_timed_are_those_of_the_pool():
    store, others = half_inserted(uniform(100))
    pairs, picked = leaf_pairs(store), leaves(store)[::3]
    sites = np.concatenate([others[:3], store.nodes[0, :2]])

    around = [u for t in picked for u in (t, *(across(store, t, k, pairs) for k in range(3)))]

    def counted(q):
        return sum(q in store.nodes[t, :3] or conflicts(store, t, q) for t in around)

    by_site = [counted(int(q)) for q in sites]
    assert min(by_site) > 0
    # the rounds take the sites in turn
    assert costs._tests(store.mesh(), picked, sites, 12) == 2 * sum(by_site) + sum(by_site[:2])
