"""Threads that wait: they look whether others come on, and lose patience when none does."""

import numpy as np
import pytest

from dt3d import InternalError
from dt3d._numba.atomics import TURNS
from dt3d.threaded2d import columns as c
from dt3d.threaded2d.mesh import MOST_LOOKS, Store
from dt3d.threaded2d.patience import BETWEEN_LOOKS, GIVING_WAY, NAP, STEP, strive, wait_in_turns

from .families import uniform

NANOSECONDS = 8  # that a unit of effort takes at least


@pytest.fixture
def store():
    found = Store(uniform(10), np.array([0, 1, 2]), 3)
    found.shared[c.MOST_LOOKS, 0] = 4
    return found


def test_effort_adds_up_to_a_look(store):
    mesh = store.mesh()
    strive(mesh, 1, STEP)
    strive(mesh, 1, BETWEEN_LOOKS - STEP - 1)
    assert store.state[1, [c.EFFORT, c.LOOKED]].tolist() == [BETWEEN_LOOKS - 1, 0]
    strive(mesh, 1, 1)
    assert store.state[1, [c.EFFORT, c.LOOKED]].tolist() == [0, 1]
    assert not store.state[[0, 2]][:, [c.EFFORT, c.LOOKED]].any()


def test_patience_ends_after_so_many_looks_in_vain(store):
    mesh = store.mesh()
    for look in range(4):
        strive(mesh, 0, BETWEEN_LOOKS)
        assert store.state[0, c.LOOKED] == look + 1
    with pytest.raises(InternalError, match="wait for each other, and none comes on"):
        strive(mesh, 0, BETWEEN_LOOKS)


@pytest.mark.parametrize("column", [c.INSERTED, c.FLIPS, c.NEXT])
@pytest.mark.parametrize("other", [0, 2])
def test_whatever_any_thread_does_renews_it(store, column, other):
    mesh = store.mesh()
    for done in range(1, 20):
        if done % 4 == 0:
            store.state[other, column] += 1
        strive(mesh, 0, BETWEEN_LOOKS)
        assert store.state[0, c.LOOKED] == done % 4
        assert store.state[0, c.SEEN] == done // 4


def test_other_columns_are_no_progress(store):
    store.state[1, [c.VISITED, c.WAITS, c.RETRIES, c.ACCESSES, c.TESTS]] = 5
    strive(store.mesh(), 0, BETWEEN_LOOKS)
    assert store.state[0, c.LOOKED] == 1


def test_it_lasts_longer_than_any_insertion():
    assert MOST_LOOKS * BETWEEN_LOOKS * NANOSECONDS > 120 * 10**9


def test_a_wait_is_counted_once_and_sleeps_after_some_turns(store):
    mesh = store.mesh()
    effort = [wait_in_turns(mesh, 2, waited) for waited in range(TURNS + 3)]
    assert effort == [GIVING_WAY] * TURNS + [NAP] * 3
    assert store.state[:, c.WAITS].tolist() == [0, 0, 1]
    wait_in_turns(mesh, 2, 0)
    assert store.state[2, c.WAITS] == 2
