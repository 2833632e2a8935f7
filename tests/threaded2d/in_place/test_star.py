"""Insertion in place: after each step it is Delaunay, and threads keep out of each other's way."""

import numpy as np

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.in_place.star import METHOD, SITES_PER_STEP, step
from dt3d.threaded2d.mesh import ROOTS
from dt3d.threaded2d.steps import CHANGED, DONE, FINISHED, STOPPED, WAITING

from ..families import uniform
from ..stepping import assert_delaunay, leaf_pairs, leaves
from .stars import begun


def test_a_step_inserts_some_sites_and_each_adds_two_triangles():
    store, tools = begun(uniform(3 + 3 * SITES_PER_STEP + 5))
    mesh, order = store.mesh(), tools.schedule.order
    for done in (SITES_PER_STEP, 2 * SITES_PER_STEP, 3 * SITES_PER_STEP, len(order)):
        assert step(mesh, 0, tools) == CHANGED
        assert store.state[0, c.INSERTED] == done
        assert len(leaves(store)) == ROOTS + 2 * done
        assert set(np.unique(store.nodes[leaves(store), :3])[1:]) >= set(order[:done].tolist())
        assert_delaunay(store)
    assert step(mesh, 0, tools) == FINISHED
    assert (store.nodes[leaves(store), c.LOCK] == 0).all()
    for t, k in [(t, k) for t in leaves(store).tolist() for k in range(3)]:
        u, j = divmod(int(store.nodes[t, c.NEIGHBOR + k]), 4)
        assert store.nodes[u, c.NEIGHBOR + j] == c.edge(t, k)


def test_a_thread_waits_for_triangles_of_another_one_and_goes_on_from_there():
    store, tools = begun(uniform(120), 2)
    mesh = store.mesh(1)
    store.nodes[:, c.LOCK] = 1  # all are thread 0's
    before = store.nodes.copy()
    for tries in (1, 2):
        assert step(mesh, 1, tools) == WAITING
        assert store.state[1, c.RETRIES] == tries
        assert store.state[1, c.INSERTED] == 0
    np.testing.assert_array_equal(store.nodes, before)
    store.nodes[:, c.LOCK] = 0
    while (outcome := step(mesh, 1, tools)) != FINISHED:
        assert outcome == CHANGED
    assert store.state[1, c.RETRIES] == 2
    assert not store.nodes[:, c.LOCK].any()
    assert_delaunay(store)
    leaf_pairs(store)


def test_the_loop_runs_to_the_end_or_until_it_has_to_stop():
    store, tools = begun(uniform(300))
    store.stop()
    assert METHOD.run(store.mesh(), 0, tools) == STOPPED
    assert store.state[0, c.INSERTED] == 0
    store.shared[c.STOP, 0] = 0
    assert METHOD.run(store.mesh(), 0, tools) == DONE
    assert store.state[0, c.INSERTED] == 297
    assert_delaunay(store)
