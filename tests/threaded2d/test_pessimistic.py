"""The pessimistic method: no thread changes anything while another one is in the critical section."""

import numpy as np
import pytest

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.pessimistic import step
from dt3d.threaded2d.steps import CHANGED, FINISHED, LOCATED, WAITING

from .families import uniform
from .stepping import assert_delaunay, begun


@pytest.mark.parametrize("location", ["dag", "walk"])
def test_a_thread_waits_for_the_critical_section(location):
    store, tools = begun(uniform(40), "pessimistic", 2, location)
    mesh = store.mesh(1)
    assert step(mesh, 1, tools) == LOCATED
    store.shared[c.CRITICAL, 0] = 1  # of thread 0
    nodes, state = store.nodes.copy(), store.state.copy()
    for _ in range(3):
        assert step(mesh, 1, tools) == WAITING
    np.testing.assert_array_equal(store.nodes, nodes)
    np.testing.assert_array_equal(store.state, state)
    assert store.shared[c.CRITICAL, 0] == 1
    store.shared[c.CRITICAL, 0] = 0
    assert step(mesh, 1, tools) == CHANGED
    assert store.shared[c.CRITICAL, 0] == 0
    assert store.state[1, c.INSERTED] == 1
    assert store.nodes[store.state[1, c.HINT], 0] == store.state[1, c.SITE]
    assert_delaunay(store)


@pytest.mark.parametrize("location", ["dag", "walk"])
def test_what_was_located_before_others_have_inserted_is_located_again(location):
    store, tools = begun(uniform(120), "pessimistic", 3, location)
    meshes = [store.mesh(k) for k in range(3)]
    stale = 0
    assert step(meshes[2], 2, tools) == LOCATED
    finished = set()
    while finished != {0, 1}:
        for k in (0, 1):
            outcome = step(meshes[k], k, tools)
            assert outcome != WAITING
            if outcome == FINISHED:
                finished.add(k)
        stale += store.nodes[store.state[2, c.NODE], c.CHILD] >= 0
    assert stale > 0
    outcomes = [step(meshes[2], 2, tools)]
    while outcomes[-1] != FINISHED:
        assert store.shared[c.CRITICAL, 0] == 0
        outcomes.append(step(meshes[2], 2, tools))
    assert outcomes == [CHANGED] + [LOCATED, CHANGED] * (len(outcomes) // 2 - 1) + [FINISHED]
    assert store.state[:, c.INSERTED].sum() == 117
    assert_delaunay(store)
