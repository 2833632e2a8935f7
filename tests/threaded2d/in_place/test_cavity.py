"""The conflicts of a site, the edges around them, and exclusive access to both."""

import numpy as np

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.in_place.cavity import BUSY, empty_scratch, lock_cavity, unlock
from dt3d.threaded2d.in_place.walk import walk

from ..families import uniform
from ..stepping import across, conflicts, leaf_pairs, leaves
from .stars import half_inserted


def _cavity_of(store, q):
    return {t for t in leaves(store).tolist() if conflicts(store, t, q)}


def test_the_cavity_and_its_rim_are_those_of_brute_force():
    store, tools, others = half_inserted(uniform(100))
    mesh, pairs = store.mesh(), leaf_pairs(store)
    before = store.nodes.copy()
    for q in others.tolist():
        want = _cavity_of(store, q)
        size, edges, count = lock_cavity(mesh, 0, walk(mesh, 4, q)[0], q, 0, tools.scratch)
        assert set(tools.scratch.cavity[0, :size].tolist()) == want
        assert (size, count, edges) == (len(want), 0, len(want) + 2)
        rim = tools.scratch.rim[0, : 3 * edges].reshape(-1, 3).tolist()
        outside = set()
        for i, (beyond, a, b) in enumerate(rim):
            t, k = divmod(beyond, 4)
            row = store.nodes[t, :3].tolist()
            assert t not in want
            assert across(store, t, k, pairs) in want
            assert (row[(k + 2) % 3], row[(k + 1) % 3]) == (a, b)
            assert b == rim[(i + 1) % edges][1]  # counter-clockwise, one after the other
            outside.add(t)
        assert outside == {across(store, t, k, pairs) for t in want for k in range(3)} - want
    np.testing.assert_array_equal(store.nodes, before)


def test_with_a_lock_all_that_is_met_is_locked_until_it_is_given_back():
    store, _, others = half_inserted(uniform(100))
    mesh, pairs, scratch = store.mesh(), leaf_pairs(store), empty_scratch(100, 2)
    busy = 0
    for q in others.tolist():
        want = _cavity_of(store, q)
        met = want | {across(store, t, k, pairs) for t in want for k in range(3)}
        t = walk(mesh, 4, q)[0]
        size, _, count = lock_cavity(mesh, 0, t, q, 1, scratch)
        assert size == len(want)
        assert set(np.flatnonzero(store.nodes[:, c.LOCK]).tolist()) == met
        assert count == len(met)
        # another thread does not get what one of them has, and notes what it has got
        for r in others[:20].tolist():
            theirs = _cavity_of(store, r)
            around = theirs | {across(store, u, k, pairs) for u in theirs for k in range(3)}
            found, _, got = lock_cavity(mesh, 1, walk(mesh, 4, r)[0], r, 2, scratch)
            assert (found == BUSY) == bool(around & met)
            busy += found == BUSY
            assert got == (store.nodes[:, c.LOCK] == 2).sum()
            unlock(store.nodes, scratch.locked[1], got)
            assert (store.nodes[list(met), c.LOCK] == 1).all()
        unlock(store.nodes, scratch.locked[0], count)
        assert not store.nodes[:, c.LOCK].any()
    assert 0 < busy < 20 * len(others)


def test_a_triangle_that_is_not_in_conflict_any_more_is_busy():
    store, _, others = half_inserted(uniform(60))
    mesh, scratch, q = store.mesh(), empty_scratch(60, 1), int(others[0])
    t = next(int(t) for t in leaves(store) if not conflicts(store, t, q))
    size, _, count = lock_cavity(mesh, 0, t, q, 1, scratch)
    assert (size, count) == (BUSY, 1)
    assert scratch.locked[0, 0] == t


def test_rows_of_threads_are_in_lines_of_their_own():
    for rows in empty_scratch(10, 3):
        assert rows.dtype == np.int32
        assert rows.strides[0] % 128 == rows.ctypes.data % 128 == 0
