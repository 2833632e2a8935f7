"""Tetrahedra without gaps: the same ones, numbered in the order of their slots."""

import numpy as np
import pytest

from dt3d.insertion.compaction import count_finite, number_finite, write_finite
from dt3d.insertion.mesh import FREE, neighbors, vertices
from dt3d.insertion.worker import State

from .growing import grown

POINTS = np.random.default_rng(0).random((50, 3))


@pytest.mark.parametrize("chunk", [1, 7, 10_000])
def test_rows_are_what_is_finite_in_the_order_of_the_slots(chunk):
    team = grown(POINTS, 50)
    store, state = team.store, team.workers[0].state
    mesh, corners = store.mesh, vertices(store.mesh)
    corners[state[State.FRESH] : state[State.FRESH_END], 0] = FREE
    finite = np.flatnonzero((corners[: store.used] < FREE).all(axis=1))
    chunks = [(i, min(i + chunk, store.used)) for i in range(0, store.used, chunk)]
    counts = [count_finite(mesh, i, j) for i, j in chunks]
    assert sum(counts) == len(finite)
    number = np.empty(store.used, np.int32)
    for (i, j), before in zip(chunks, np.cumsum([0, *counts]), strict=False):
        number_finite(mesh, i, j, before, number)
    want = np.full(store.used, -1)
    want[finite] = np.arange(len(finite))
    np.testing.assert_array_equal(number, want)
    original = np.random.default_rng(1).permutation(50).astype(np.int32)
    simplices, beyond = np.empty((len(finite), 4), np.int32), np.empty((len(finite), 4), np.int32)
    for i, j in chunks:
        write_finite(mesh, i, j, number, original, simplices, beyond)
    np.testing.assert_array_equal(simplices, original[corners[finite]])
    np.testing.assert_array_equal(beyond, want[neighbors(mesh)[finite] // 4])
