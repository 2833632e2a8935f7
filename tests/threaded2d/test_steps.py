"""What all methods have in common: why a run comes back, and where its time goes."""

import numba
import numpy as np
import pytest

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.driver import METHODS
from dt3d.threaded2d.in_place import star
from dt3d.threaded2d.mesh import ROOTS, Store
from dt3d.threaded2d.steps import (
    CHANGED,
    DONE,
    FULL,
    GO_ON,
    LOCATED,
    LOCKED,
    OPEN_SWAPS,
    QUEUED,
    STOPPED,
    WAITING,
    add_cycles,
    column_of,
    now,
    specialised,
    stop_reason,
)
from dt3d.threaded2d.virtual_time.costs import prepared

from .families import uniform
from .runs import SEQUENTIAL
from .stepping import assert_delaunay, begun

BETWEEN_INSERTIONS = (c.BEGIN, c.HEAD_START)
BEFORE_CHANGES = (*BETWEEN_INSERTIONS, c.LOCK_CAVITY, c.SUBDIVIDE, c.LEGALISE)
PHASES = (*BEFORE_CHANGES, c.CHANGE)


def _set(store, word):
    store.shared[word, 0] = store.shared[c.USED, 0] - 1 if word == c.SOFT_LIMIT else 1


@pytest.mark.parametrize(
    ("word", "reason", "phases"),
    [
        (c.STOP, STOPPED, BEFORE_CHANGES),
        (c.SOFT_LIMIT, FULL, BETWEEN_INSERTIONS),
        (c.SWAPS_LEFT, OPEN_SWAPS, BETWEEN_INSERTIONS),
    ],
)
def test_a_thread_comes_back_in_phases_in_which_it_may(word, reason, phases):
    store, _ = begun(uniform(20), "sequential", 1)
    mesh = store.mesh()
    for phase in PHASES:
        store.state[0, c.PHASE] = phase
        assert stop_reason(mesh, 0, True) == GO_ON
    _set(store, word)
    for phase in PHASES:
        store.state[0, c.PHASE] = phase
        assert stop_reason(mesh, 0, True) == (reason if phase in phases else GO_ON)
        # in place only the stop counts
        assert stop_reason(mesh, 0, False) == (STOPPED if word == c.STOP else GO_ON)


def test_to_stop_comes_before_to_grow_and_that_before_swaps():
    store, _ = begun(uniform(20), "sequential", 1)
    for word, reason in ((c.SWAPS_LEFT, OPEN_SWAPS), (c.SOFT_LIMIT, FULL), (c.STOP, STOPPED)):
        _set(store, word)
        assert stop_reason(store.mesh(), 0, True) == reason


@pytest.mark.parametrize(("word", "reason"), [(c.STOP, STOPPED), (c.SOFT_LIMIT, FULL)])
def test_a_run_that_came_back_goes_on_to_the_end(word, reason):
    store, tools = begun(uniform(300), "sequential", 1)
    run = METHODS["sequential"].run
    limit = store.shared[c.SOFT_LIMIT, 0]
    if word == c.SOFT_LIMIT:
        # a thread takes blocks of nodes, the first of them in its first insertion
        store.shared[c.SOFT_LIMIT, 0] = ROOTS
    else:
        store.stop()
    assert run(store.mesh(), 0, tools) == reason
    assert store.state[0, c.INSERTED] == (1 if word == c.SOFT_LIMIT else 0)
    store.shared[c.STOP, 0], store.shared[c.SOFT_LIMIT, 0] = 0, limit
    assert run(store.mesh(), 0, tools) == DONE
    assert store.state[0, c.INSERTED] == 297
    assert_delaunay(store)


def test_where_the_time_of_a_step_goes():
    assert {outcome: column_of(outcome) for outcome in (LOCATED, CHANGED, WAITING, QUEUED, LOCKED)} == {
        LOCATED: c.LOCATION_CYCLES,
        QUEUED: c.LOCATION_CYCLES,
        CHANGED: c.CHANGE_CYCLES,
        LOCKED: c.CHANGE_CYCLES,
        WAITING: c.WAIT_CYCLES,
    }


def test_cycles_add_up():
    state = np.zeros((2, c.STATE_COLUMNS), np.int64)
    begun_at = last = now()
    for _ in range(5):
        ended = add_cycles(state, 1, c.WAIT_CYCLES, last)
        assert ended >= last
        last = ended
    assert state[1, c.WAIT_CYCLES] == last - begun_at
    assert np.count_nonzero(state) == 1


def test_in_place_no_clock_is_read():
    store, schedule = prepared(uniform(200), SEQUENTIAL)
    store = Store(store.points, store.nodes[0, :3], 1, ROOTS + 2 * len(store.points))
    tools = star.METHOD.tools(store, schedule, SEQUENTIAL)
    assert star.METHOD.run(store.mesh(), 0, tools) == DONE
    assert not store.state[0, [c.LOCATION_CYCLES, c.CHANGE_CYCLES, c.WAIT_CYCLES]].any()
    store, tools = begun(uniform(200), "sequential", 1)
    begun_at = now()
    assert METHODS["sequential"].run(store.mesh(), 0, tools) == DONE
    spent = store.state[0, [c.LOCATION_CYCLES, c.CHANGE_CYCLES]]
    assert spent.min() > 0
    assert spent.sum() <= now() - begun_at


@numba.njit
def _twice(x):
    return 2 * x


@numba.njit
def _squared(x):
    return x * x


change = None


@numba.njit
def _sum_of_changed(values):
    total = 0
    for x in values:
        total += change(x)
    return total


def test_kernels_with_functions_of_their_own():
    values = np.arange(1, 6)
    kernels = {
        name: specialised(_sum_of_changed, __name__, name, change=function)
        for name, function in (("twice", _twice), ("squared", _squared))
    }
    assert kernels["twice"](values) == 30
    assert kernels["squared"](values) == 55
    assert change is None


def test_no_two_methods_have_one_name_on_disk():
    methods = [*METHODS.values(), star.METHOD]
    runs = [(m.run.py_func.__module__, m.run.py_func.__qualname__) for m in methods]
    assert len(set(runs)) == len(methods)
    assert [module for module, _ in runs] == [m.step.py_func.__module__ for m in methods]
