"""The shared structure: the roots, blocks of nodes for threads, and growth."""

import numpy as np
import pytest

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.mesh import BLOCK, MOST_LOOKS, ROOTS, Store, inject_yield, unused_nodes

from .families import uniform

FIRST = np.array([7, 2, 5], np.int64)


def store(threads=1, capacity=None):
    return Store(uniform(20), FIRST, threads, capacity)


def test_it_begins_with_one_triangle_and_its_ghosts():
    nodes = store().nodes
    assert nodes[0, :3].tolist() == FIRST.tolist()
    assert (nodes[:ROOTS, c.CHILD] == -1).all()
    assert (nodes[:, c.LOCK] == 0).all()
    # unused words are of no triangle
    assert (nodes[ROOTS:, c.CHILD] == 0).all()
    for i in range(3):
        ghost = nodes[1 + i, :3].tolist()
        assert ghost == [c.INFINITE, nodes[0, (i + 2) % 3], nodes[0, (i + 1) % 3]]
    for t in range(ROOTS):
        row = nodes[t, :3].tolist()
        for k in range(3):
            u, j = divmod(int(nodes[t, c.NEIGHBOR + k]), 4)
            assert nodes[u, c.NEIGHBOR + j] == 4 * t + k
            other = nodes[u, :3].tolist()
            # the edge leads the other way there
            assert (row[(k + 1) % 3], row[(k + 2) % 3]) == (other[(j + 2) % 3], other[(j + 1) % 3])


def test_threads_take_nodes_that_no_other_one_has():
    s = store(threads=3)
    rng, taken = np.random.default_rng(0), []
    for _ in range(1200):
        me, count = int(rng.integers(0, 3)), int(rng.integers(2, 4))
        at = unused_nodes(s.mesh(me), me, count)
        assert ROOTS <= at <= s.used - count
        taken.append(range(at, at + count))
    every = np.concatenate([np.arange(r.start, r.stop) for r in taken])
    assert len(np.unique(every)) == len(every)
    # what a block has left at its end is less than what was wanted, and a block is left to each thread
    blocks = (s.used - ROOTS) // BLOCK
    assert s.used == ROOTS + BLOCK * blocks
    assert len(every) > s.used - ROOTS - 3 * BLOCK - 2 * blocks


def test_growth_keeps_what_is_there_and_leaves_a_reserve():
    s = store(threads=2)
    soft = int(s.shared[c.SOFT_LIMIT, 0])
    assert len(s.nodes) == soft + s.reserve
    s.shared[c.USED, 0] = soft + 5
    s.nodes[: soft + 5] = np.arange(8 * (soft + 5)).reshape(-1, 8)
    before, points = s.nodes.copy(), s.points
    s.grow()
    assert s.growths == 1
    assert s.shared[c.SOFT_LIMIT, 0] == soft * 3 // 2
    assert len(s.nodes) == soft * 3 // 2 + s.reserve
    np.testing.assert_array_equal(s.nodes[: soft + 5], before[: soft + 5])
    assert not s.nodes[soft + 5 :].any()
    assert s.mesh(1).nodes is s.nodes
    assert s.mesh(1).points is points


def test_more_nodes_than_have_names():
    s = store()
    s.shared[c.SOFT_LIMIT, 0] = 2**29
    with pytest.raises(ValueError, match="the history of 20 sites has more triangles than 32-bit"):
        s.grow()
    assert s.growths == 0


def test_threads_share_all_but_the_workspace_of_predicates():
    s = store(threads=3, capacity=44)
    assert len(s.nodes) == 44
    meshes = [s.mesh(k) for k in range(3)]
    for mesh in meshes[1:]:
        assert all(a is b for a, b in zip(mesh[:4], meshes[0][:4], strict=True))
    assert len({mesh.workspace.ctypes.data for mesh in meshes}) == 3
    assert s.state[:, c.PART].tolist() == [0, 1, 2]
    assert s.shared[c.MOST_LOOKS, 0] == MOST_LOOKS
    assert s.shared[c.STOP, 0] == 0
    s.stop()
    assert s.shared[c.STOP, 0] == 1


def test_threads_give_way_at_random_only_where_tests_ask_for_it():
    s = store(threads=2)
    drawn = s.state[:, c.RANDOM].copy()
    inject_yield(s.mesh(), 0)
    np.testing.assert_array_equal(s.state[:, c.RANDOM], drawn)
    s.shared[c.YIELD_EVERY, 0] = 2
    seen = [[], []]
    for me in (0, 1):
        for _ in range(1000):
            inject_yield(s.mesh(me), me)
            seen[me].append(int(s.state[me, c.RANDOM]))
    assert len(set(seen[0]) | set(seen[1])) == 2000
    for numbers in seen:
        assert min(numbers) > 0
        assert 400 < sum(x % 2 == 0 for x in numbers) < 600
