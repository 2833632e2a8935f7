"""Deadlocks of the circum-circle method: who counts as waiting, and where illegal edges may be left."""

import numba
import numpy as np
import pytest

from dt3d import threaded2d
from dt3d.predicates import work_array
from dt3d.threaded2d import illegal_edges, pool
from dt3d.threaded2d.compaction import compact
from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.correction import _illegal
from dt3d.threaded2d.driver import Run
from dt3d.threaded2d.mesh import CHILD, EXCEPTIONS, NEIGHBOR, NOTED, ROOTS, STUMBLE, SUSPECT, USED
from dt3d.threaded2d.order import along_curve
from dt3d.threaded2d.virtual_time.costs import prepared

from .families import DISTRIBUTIONS, EVERY_SET, canonical

blocker_of, wait_for, still_waits, publish, retire = (
    numba.njit(f.py_func)
    for f in (pool.blocker_of, pool.wait_for, pool.still_waits, pool.publish, pool.retire)
)


def _three_threads():
    """A store whose first triangle every site is in conflict with or a vertex of, and an empty pool."""
    store, _ = prepared(EVERY_SET["uniform"](20), Options(method="circumcircle", threads=3, order="random"))
    return store, pool.empty_pool(3), work_array(store.points)


def _blocker(store, entries, me, w):
    vertices = store.nodes[0, :3]
    for i in range(3):
        publish(entries, i, int(vertices[i]))
    return blocker_of(store.points, store.nodes, store.state, entries, me, (0,), 1, w)


def test_one_that_waits_for_this_insertion_is_left_out_and_flagged():
    store, entries, w = _three_threads()
    assert _blocker(store, entries, 0, w) == (1, 0)
    assert wait_for(store.shared, entries, 1, 2, 0)
    assert wait_for(store.shared, entries, 2, 0, 0)
    assert not wait_for(store.shared, entries, 0, 1, 0)  # that would be for ever
    store.state[2, pool.PHASE] = pool.LEGALISE
    assert _blocker(store, entries, 0, w)[0] == pool.NOBODY
    assert entries[:, pool.EXCEPTIONAL].tolist() == [0, 1, 1]
    assert store.state[0, EXCEPTIONS] == 2
    assert store.state[0, SUSPECT] == 1


def test_one_that_has_not_noticed_the_end_of_its_wait_does_not_count_as_waiting():
    store, entries, w = _three_threads()
    assert wait_for(store.shared, entries, 1, 2, 0)
    assert wait_for(store.shared, entries, 2, 0, 0)
    retire(entries, 0)
    # thread 0 is at its next insertion; 2, and so 1, may go on at any moment
    assert _blocker(store, entries, 0, w) == (1, 0)
    assert entries[:, pool.EXCEPTIONAL].tolist() == [0, 0, 0]
    assert wait_for(store.shared, entries, 0, 1, 0)
    assert still_waits(entries, 1)
    assert not still_waits(entries, 2)


@numba.njit
def _illegal_edges(points, nodes, leaves, w):
    """Pairs of leaves beside an illegal edge."""
    found = []
    for t in leaves:
        for k in range(3):
            if _illegal(points, nodes, t, k, w):
                found.append((t, nodes[t, NEIGHBOR + k] >> 2))
    return found


class _Watched(Run):
    """A run that looks at the illegal edges before they are corrected."""

    illegal = 0

    def correct(self):
        store = self.store
        leaves = np.flatnonzero(store.nodes[: store.shared[USED, 0], CHILD] < 0)
        beside = np.array(_illegal_edges(store.points, store.nodes, leaves, self.work[0])).reshape(-1, 2)
        below = _below(store, illegal_edges.noted(store, self.notes))
        assert np.isin(below, leaves).all()
        assert len(np.unique(below)) == len(below)
        assert np.isin(beside, below).any(axis=1).all()
        self.illegal += len(beside)
        super().correct()


@pytest.mark.parametrize("name", EVERY_SET)
def test_every_illegal_edge_is_beside_what_was_noted(name):
    corrected = illegal = 0
    points = EVERY_SET[name](300)
    for seed in range(12):
        run = _run(_Watched, points, 2 + seed % 5, seed)
        corrected += run.corrected
        illegal += run.illegal
    if name in DISTRIBUTIONS:
        assert corrected > 0
        assert illegal > 0


def _run(kind, points, threads, seed):
    """A run under contention, without a head start."""
    options = Options(method="circumcircle", threads=threads, order="random", seed=seed)
    store, sites = prepared(points, options)
    store.shared[STUMBLE, 0] = 2 if threads > 1 else 0
    run = kind(options, store, sites)
    run.to_the_end()
    return run


def _below(store, origins):
    used = int(store.shared[USED, 0])
    leaves = np.empty(used, np.int32)
    count = illegal_edges.leaves_below(
        store.nodes, origins, np.zeros(used, np.bool_), np.empty(used, np.int32), leaves
    )
    return leaves[:count]


def test_below_the_roots_is_everything():
    store = _run(Run, EVERY_SET["uniform"](300), 1, 0).store
    assert not len(_below(store, np.empty(0, np.int32)))
    everything = _below(store, np.arange(ROOTS, dtype=np.int32))
    used = int(store.shared[USED, 0])
    np.testing.assert_array_equal(np.sort(everything), np.flatnonzero(store.nodes[:used, CHILD] < 0))


class _Crowded(Run):
    """A run that counts how often there was no room for notes."""

    full = 0

    def correct(self):
        if (self.store.state[:, NOTED] > illegal_edges.CAPACITY).any():
            self.full += 1
            np.testing.assert_array_equal(illegal_edges.noted(self.store, self.notes), np.arange(ROOTS))
        super().correct()


def test_where_there_is_no_room_for_notes_everything_is_corrected(monkeypatch):
    monkeypatch.setattr(illegal_edges, "CAPACITY", 5)
    points = EVERY_SET["uniform"](300)
    want = canonical(threaded2d.Delaunay(points, method="sequential").triangles)
    full = 0
    for seed in range(12):
        run = _run(_Crowded, points, 4, seed)
        full += run.full
        used = int(run.store.shared[USED, 0])
        rows = along_curve(points)[0]
        np.testing.assert_array_equal(canonical(compact(run.store.nodes, used, np.sort(rows))[0]), want)
    assert full > 0
