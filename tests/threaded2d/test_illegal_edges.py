"""Deadlocks of the circum-circle method: where illegal edges may be left."""

import numba
import numpy as np
import pytest

from dt3d import threaded2d
from dt3d.ordering.along_curve import along_curve_in_plane
from dt3d.threaded2d import columns as c
from dt3d.threaded2d import illegal_edges
from dt3d.threaded2d.columns import triangle
from dt3d.threaded2d.compaction import compact
from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.correction import is_illegal
from dt3d.threaded2d.driver import Run
from dt3d.threaded2d.mesh import ROOTS
from dt3d.threaded2d.virtual_time.costs import prepared

from .families import DISTRIBUTIONS, EVERY_SET, canonical


@numba.njit
def _illegal_edges(mesh, leaves):
    """Pairs of leaves beside an illegal edge."""
    found = []
    for t in leaves:
        for k in range(3):
            if is_illegal(mesh, t, k):
                found.append((t, triangle(mesh.nodes[t, c.NEIGHBOR + k])))
    return found


class _Watched(Run):
    """A run that looks at the illegal edges before they are corrected."""

    illegal = 0

    def correct(self):
        store = self.store
        leaves = np.flatnonzero(store.nodes[: store.used, c.CHILD] < 0)
        beside = np.array(_illegal_edges(store.mesh(), leaves)).reshape(-1, 2)
        below = _below(store, illegal_edges.marked(store, self.tools.marks))
        assert np.isin(below, leaves).all()
        assert len(np.unique(below)) == len(below)
        assert np.isin(beside, below).any(axis=1).all()
        self.illegal += len(beside)
        super().correct()


@pytest.mark.parametrize("name", EVERY_SET)
def test_every_illegal_edge_is_beside_what_was_marked(name):
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
    store.shared[c.YIELD_EVERY, 0] = 2 if threads > 1 else 0
    run = kind(options, store, sites)
    run.to_the_end()
    return run


def _below(store, origins):
    used = store.used
    leaves = np.empty(used, np.int32)
    count = illegal_edges.leaves_below(
        store.nodes, origins, np.zeros(used, np.bool_), np.empty(used, np.int32), leaves
    )
    return leaves[:count]


def test_below_the_roots_is_everything():
    store = _run(Run, EVERY_SET["uniform"](300), 1, 0).store
    assert not len(_below(store, np.empty(0, np.int32)))
    everything = _below(store, np.arange(ROOTS, dtype=np.int32))
    np.testing.assert_array_equal(np.sort(everything), np.flatnonzero(store.nodes[: store.used, c.CHILD] < 0))


class _Crowded(Run):
    """A run that counts how often there was no room for marks."""

    full = 0

    def correct(self):
        if (self.store.state[:, c.MARKED] > illegal_edges.MOST_MARKED).any():
            self.full += 1
            np.testing.assert_array_equal(
                illegal_edges.marked(self.store, self.tools.marks), np.arange(ROOTS)
            )
        super().correct()


def test_where_there_is_no_room_for_marks_everything_is_corrected(monkeypatch):
    monkeypatch.setattr(illegal_edges, "MOST_MARKED", 5)
    points = EVERY_SET["uniform"](300)
    want = canonical(threaded2d.Delaunay(points, method="sequential").triangles)
    full = 0
    for seed in range(12):
        run = _run(_Crowded, points, 4, seed)
        full += run.full
        rows = along_curve_in_plane(points)[0]
        np.testing.assert_array_equal(
            canonical(compact(run.store.nodes[: run.store.used], np.sort(rows)).triangles), want
        )
    assert full > 0
