"""The correction of swaps that were given up: from edges flipped at random back to Delaunay."""

import numba
import numpy as np
import pytest

from dt3d.predicates import work_array
from dt3d.predicates.filtered2d import orient2d
from dt3d.threaded2d import correction, dag, sequential
from dt3d.threaded2d.compaction import compact
from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.mesh import CHILD, NEIGHBOR, ROOTS, SOFT_LIMIT, USED
from dt3d.threaded2d.steps import DONE
from dt3d.threaded2d.virtual_time.costs import prepared

from .families import EVERY_SET, canonical


@numba.njit
def _spoil(points, nodes, shared, state, edges, w):
    """Flip those of the edges whose two triangles make a convex quadrilateral; how many."""
    flips = 0
    for edge in edges:
        t, k = edge >> 2, edge & 3
        if nodes[t, CHILD] >= 0:
            continue
        u, j = nodes[t, NEIGHBOR + k] >> 2, nodes[t, NEIGHBOR + k] & 3
        p, a, b = nodes[t, k], nodes[t, (k + 1) % 3], nodes[t, (k + 2) % 3]
        d = nodes[u, j]
        if min(p, a, b, d) < 0:
            continue
        if orient2d(points, p, a, d, w) > 0 and orient2d(points, p, d, b, w) > 0:
            correction._flip(nodes, shared, state, t, k)
            flips += 1
    return flips


@pytest.mark.parametrize("name", EVERY_SET)
def test_edges_flipped_at_random_are_flipped_back(name):
    store, sites = prepared(EVERY_SET[name](300), Options(method="sequential", order="random"))
    work = work_array(store.points)
    run = sequential.run(store.points, store.nodes, store.shared, store.state, sites, 0, False, work)
    assert run == DONE
    used, rows = int(store.shared[USED, 0]), np.arange(len(store.points))
    want = canonical(compact(store.nodes, used, rows)[0])
    leaves = np.flatnonzero(store.nodes[:used, CHILD] < 0)
    rng = np.random.default_rng(0)
    edges = 4 * rng.choice(leaves, 200) + rng.integers(0, 3, 200)
    spoilt = _spoil(store.points, store.nodes, store.shared, store.state, edges, work)
    flips = correction.correct(store, np.arange(ROOTS, dtype=np.int32), work, lambda: None)
    assert (flips > 0) == (spoilt > 0)
    triangles, neighbors, _ = compact(store.nodes, int(store.shared[USED, 0]), rows)
    np.testing.assert_array_equal(canonical(triangles), want)
    t, k = np.nonzero(neighbors >= 0)
    assert (neighbors[neighbors[t, k]] == t[:, None]).any(axis=1).all()
    # the history leads every site to a triangle that it is a vertex of
    for q in rows:
        t, _ = dag.locate(store.points, store.nodes, q, work)
        assert q in store.nodes[t, :3]


def test_a_correction_without_room_grows_the_structure():
    store, sites = prepared(EVERY_SET["uniform"](300), Options(method="sequential", order="random"))
    work = work_array(store.points)
    sequential.run(store.points, store.nodes, store.shared, store.state, sites, 0, False, work)
    used, rows = int(store.shared[USED, 0]), np.arange(len(store.points))
    want = canonical(compact(store.nodes, used, rows)[0])
    leaves = np.flatnonzero(store.nodes[:used, CHILD] < 0)
    assert _spoil(store.points, store.nodes, store.shared, store.state, 4 * leaves, work) > 20
    store.shared[SOFT_LIMIT, 0] = store.shared[USED, 0] - 1
    assert correction.correct(store, np.arange(ROOTS, dtype=np.int32), work, lambda: None) > 20
    assert store.growths == 1
    np.testing.assert_array_equal(canonical(compact(store.nodes, int(store.shared[USED, 0]), rows)[0]), want)
