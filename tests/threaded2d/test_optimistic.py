"""The optimistic method: before a thread changes anything, all it may change is its own."""

import numpy as np

from dt3d.threaded2d import columns as c
from dt3d.threaded2d import optimistic
from dt3d.threaded2d.optimistic import step, unlock_star
from dt3d.threaded2d.steps import CHANGED, FINISHED, LOCATED, LOCKED, WAITING

from .families import uniform
from .runs import half_inserted
from .stepping import across, assert_delaunay, begun, conflicts, leaf_pairs, leaves


def _locked(store, *locks):
    """The leaves that have one of these locks; what an insertion made and flipped again stays locked."""
    present = leaves(store)
    return set(present[np.isin(store.nodes[present, c.LOCK], locks)].tolist())


def test_the_conflicts_and_those_around_them_are_locked_and_given_back():
    store, tools = begun(uniform(40), "optimistic", 1)
    mesh = store.mesh()
    for count in range(37):
        assert step(mesh, 0, tools) == LOCATED
        assert not _locked(store, 1, 2)
        assert step(mesh, 0, tools) == LOCKED
        q, pairs = int(store.state[0, c.SITE]), leaf_pairs(store)
        cavity = {t for t in leaves(store).tolist() if conflicts(store, t, q)}
        around = {across(store, t, k, pairs) for t in cavity for k in range(3)}
        assert _locked(store, 1) == cavity | around
        assert store.state[0, c.LOCKED] == len(cavity | around)
        assert step(mesh, 0, tools) == CHANGED
        assert not _locked(store, 1, 2)
        assert q == store.nodes[store.state[0, c.HINT], 0]
        assert store.state[0, c.INSERTED] == count + 1
        assert_delaunay(store)
    assert step(mesh, 0, tools) == FINISHED
    assert store.state[0, c.ACCESSES] == 37
    assert store.state[0, c.RETRIES] == 0


def test_a_thread_that_does_not_get_all_gives_back_what_it_got():
    store, tools = begun(uniform(200), "optimistic", 2)
    meshes = [store.mesh(k) for k in range(2)]
    waits = 0
    for _ in range(90):
        assert [step(meshes[k], k, tools) for k in range(2)] == [LOCATED] * 2
        assert step(meshes[0], 0, tools) == LOCKED
        before, own = store.nodes.copy(), _locked(store, 1)
        outcome = step(meshes[1], 1, tools)
        assert _locked(store, 1) == own
        if outcome == WAITING:
            waits += 1
            np.testing.assert_array_equal(store.nodes, before)
        else:
            assert outcome == LOCKED
            assert _locked(store, 2)
        assert store.state[1, c.RETRIES] == waits
        assert step(meshes[0], 0, tools) == CHANGED
        # the thread that waited locates again from where it was, and now gets all
        while outcome != CHANGED:
            outcome = step(meshes[1], 1, tools)
            assert outcome in (LOCKED, CHANGED)
        assert not _locked(store, 1, 2)
    assert 0 < waits < 90
    assert store.state[:, c.INSERTED].tolist() == [90, 90]
    assert_delaunay(store)


def test_all_triangles_about_a_site_are_unlocked_and_no_others():
    store, _ = half_inserted(uniform(100))
    present = leaves(store)
    checked = 0
    made = [int(f) for f in present if store.nodes[f, 0] >= 0]
    for f in made[::5]:
        star = {int(t) for t in present if store.nodes[t, 0] == store.nodes[f, 0]}
        about = {int(t) for t in present if store.nodes[f, 0] in store.nodes[t, :3]}
        if star != about:
            continue  # a star that later insertions have changed
        store.nodes[present, c.LOCK] = 1
        unlock_star(store.nodes, f)
        checked += 1
        assert _locked(store, 1) == set(present.tolist()) - star
    assert checked > 3


def test_tools_have_a_row_of_scratch_for_each_thread():
    store, tools = begun(uniform(30), "optimistic", 3)
    assert all(len(rows) == 3 for rows in tools.scratch)
    assert len(tools.schedule.order) == len(store.points) - 3
    assert optimistic.METHOD.step is step
