"""The memory of the tetrahedra: the first ones, blocks of slots, and growth."""

import numpy as np
import pytest

from dt3d.insertion.mesh import INFINITE, MOST_SLOTS, aligned, neighbors, squared_radii, vertices
from dt3d.insertion.store import Store

FIRST = np.array([3, 0, 1, 2], np.int32)


def store(slots=100, block=10):
    return Store(aligned(16, np.float64), FIRST, slots, block)


def test_it_begins_with_one_tetrahedron_and_its_ghosts():
    mesh = store().mesh
    assert vertices(mesh)[0].tolist() == FIRST.tolist()
    for k in range(4):
        ghost = vertices(mesh)[1 + k].tolist()
        assert ghost.index(INFINITE) == k
        assert sorted([*ghost, FIRST[k]]) == [0, 1, 2, 3, INFINITE]
        assert neighbors(mesh)[0, k] == 4 * (1 + k) + k
    for t in range(5):
        for k in range(4):
            u, j = divmod(int(neighbors(mesh)[t, k]), 4)
            assert neighbors(mesh)[u, j] == 4 * t + k
            shared = np.setdiff1d(vertices(mesh)[t], vertices(mesh)[t, k])
            assert set(shared) < set(vertices(mesh)[u])
    # of these nothing is known, so that everything about them is decided exactly
    assert squared_radii(mesh)[:5].tolist() == [[-1, np.inf]] * 5


def test_blocks_adjoin_until_there_are_no_slots():
    s = store(slots=28, block=10)
    assert [s.take_block() for _ in range(4)] == [(5, 15), (15, 25), (25, 28), (28, 28)]


def test_growth_keeps_what_is_there():
    s = store()
    s.used = 60
    s.tetrahedra[:480], s.spheres[:240] = np.arange(480), np.arange(240)
    sites = s.sites
    s.grow()
    assert s.capacity == 200
    assert (len(s.tetrahedra), len(s.spheres)) == (1600, 800)
    np.testing.assert_array_equal(s.tetrahedra[:480], np.arange(480))
    np.testing.assert_array_equal(s.spheres[:240], np.arange(240))
    assert s.mesh.sites is sites


def test_slots_that_have_no_name():
    with pytest.raises(ValueError, match="name at most 1073741824 = 2\\^30"):
        store(slots=MOST_SLOTS + 1)
