"""The batch method: searching threads fill the queue, the specialised one empties it."""

import pytest

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.batch import METHOD, step, tools
from dt3d.threaded2d.configuration import INTERLEAVED, Options
from dt3d.threaded2d.dag import descend
from dt3d.threaded2d.queue import fill_of
from dt3d.threaded2d.steps import CHANGED, FINISHED, LOCATED, QUEUED, WAITING
from dt3d.threaded2d.virtual_time.costs import prepared

from .families import uniform
from .stepping import assert_delaunay, conflicts


def begun(n, threads, **own):
    options = Options(method="batch", threads=threads, order="random", **own)
    store, schedule = prepared(uniform(n), options)
    return store, tools(store, schedule, options), [store.mesh(k) for k in range(threads)]


def test_sites_are_located_then_queued_then_inserted():
    store, t, meshes = begun(100, 2, queue_length=16)
    assert step(meshes[1], 1, t) == WAITING  # nothing is in the queue
    assert [step(meshes[0], 0, t) for _ in range(INTERLEAVED)] == [LOCATED] * INTERLEAVED
    assert fill_of(store.shared) == 0
    assert step(meshes[0], 0, t) == QUEUED
    assert fill_of(store.shared) == INTERLEAVED
    assert [step(meshes[1], 1, t) for _ in range(INTERLEAVED)] == [CHANGED] * INTERLEAVED
    assert step(meshes[1], 1, t) == WAITING
    assert store.state[:, c.INSERTED].tolist() == [0, INTERLEAVED]
    assert_delaunay(store)


@pytest.mark.parametrize("helping", [False, True])
def test_a_full_queue_makes_searching_threads_wait_or_help(helping):
    store, t, meshes = begun(100, 2, queue_length=4, helping=helping)
    outcomes = [step(meshes[0], 0, t) for _ in range(INTERLEAVED + 8)]
    first = outcomes[: INTERLEAVED + 1]
    assert first == [LOCATED] * INTERLEAVED + [QUEUED]
    # it keeps what found no room; a helper takes an element, finishes its location, and puts it back
    assert set(outcomes[INTERLEAVED + 1 :]) == ({LOCATED, QUEUED} if helping else {WAITING})
    assert fill_of(store.shared) == (4 if store.state[0, c.HELPED] == 0 else 3)
    while (outcome := step(meshes[1], 1, t)) != FINISHED:
        if outcome == WAITING:
            step(meshes[0], 0, t)
    assert store.state[:, c.INSERTED].tolist() == [0, 97]
    assert_delaunay(store)


def test_one_site_at_a_time_goes_to_the_queue_with_its_leaf_s_parent():
    store, t, meshes = begun(100, 2, queue_length=16, interleave=1, queue_parents=True)
    below = 0
    for count in range(1, 60):
        outcomes = [step(meshes[0], 0, t) for _ in range(2)]
        assert outcomes == [LOCATED, QUEUED]
        site, parent, _, _ = t.cells[(count - 1) % 16]
        leaf, visited = descend(meshes[1], parent, site)
        assert visited == (leaf != parent)
        below += visited  # all but those at roots that are leaves
        assert conflicts(store, leaf, site)
        assert step(meshes[1], 1, t) == CHANGED
        assert store.state[1, c.INSERTED] == count
        assert store.state[1, c.VISITED] == below
    assert below > 50
    assert_delaunay(store)


def test_searching_threads_end_when_their_sites_are_queued():
    store, t, meshes = begun(60, 3, queue_length=64)
    ended = set()
    while ended != {0, 1}:
        for k in (0, 1):
            if step(meshes[k], k, t) == FINISHED:
                ended.add(k)
    assert fill_of(store.shared) == 57
    while step(meshes[2], 2, t) != FINISHED:
        pass
    assert store.state[2, c.INSERTED] == 57
    assert store.state[2, c.QUEUE_FILL] > 57  # elements found at each get, added up
    assert_delaunay(store)
    assert METHOD.step is step
