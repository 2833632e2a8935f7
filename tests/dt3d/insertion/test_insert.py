"""The compiled loop over sites: what it returns, and that nothing is half done when it needs something."""

import numpy as np
import pytest

from dt3d.insertion import insert as module
from dt3d.insertion.insert import insert
from dt3d.insertion.worker import State, scratch_for

from .growing import check_links, grown, living

POINTS = np.random.default_rng(0).random((60, 3))


def call(team, sites):
    worker = team.workers[0]
    worker.assign(np.array(sites, np.uint32), 0, len(POINTS))
    worker.state[State.STOP] = len(sites)
    arguments = team.store.mesh, worker.todo, worker.state, worker.scratch, team.scale, worker.work
    return insert(*arguments), worker


def test_all_sites_are_inserted_where_there_is_room():
    team = grown(POINTS, 50, block=1000)
    created = team.counts()["created"]
    result, worker = call(team, range(50, 60))
    assert (result, worker.inserted, worker.state[State.DEFERRED]) == (module.DONE, 10, 0)
    assert team.counts()["created"] > created + 40
    assert team.slots == len(living(team))
    check_links(team)


@pytest.mark.parametrize("need", [module.NEEDS_SCRATCH, module.NEEDS_SLOTS])
def test_what_it_needs_is_said_before_anything_changes(need):
    team = grown(POINTS, 50)
    state = team.workers[0].state
    if need == module.NEEDS_SCRATCH:
        team.workers[0].scratch = scratch_for(8)
    else:
        state[State.FRESH_END], state[State.FREE_COUNT] = state[State.FRESH], 0
    before = [a.copy() for a in (team.store.tetrahedra, team.store.spheres)]
    result, worker = call(team, [50, 51])
    assert (result, worker.inserted, worker.left.tolist()) == (need, 0, [50, 51])
    for array, old in zip((team.store.tetrahedra, team.store.spheres), before, strict=True):
        used = len(array) * team.store.used // team.store.capacity
        assert array[:used].tobytes() == old[:used].tobytes()


def test_sites_that_others_are_in_the_way_of_are_deferred():
    team = grown(POINTS, 50, block=1000)
    worker = team.workers[0]
    worker.assign(np.arange(50, 60, dtype=np.uint32), 0, 2)
    worker.state[State.STOP] = 10
    insert(team.store.mesh, worker.todo, worker.state, worker.scratch, team.scale, worker.work)
    assert worker.state[State.DEFERRED] == 10
    assert worker.inserted == 0
    np.testing.assert_array_equal(worker.left, np.arange(50, 60))
    check_links(team)


def test_a_site_that_is_there_is_a_fault():
    result, _ = call(grown(POINTS, 50, block=1000), [7])
    assert result == module.OCCUPIED
    assert "another one is already" in module.FAULTS[result]
