"""The correction of swaps that were given up: from edges flipped at random back to Delaunay."""

import numba
import numpy as np
import pytest

from dt3d.predicates.filtered2d import orient2d
from dt3d.threaded2d import columns as c
from dt3d.threaded2d import correction, dag
from dt3d.threaded2d.columns import edges_of, side, triangle
from dt3d.threaded2d.compaction import compact
from dt3d.threaded2d.mesh import ROOTS

from .families import EVERY_SET, canonical
from .runs import inserted


@numba.njit
def _spoil(mesh, edges):
    """Flip those of the edges whose two triangles make a convex quadrilateral; how many."""
    points, nodes, w = mesh.points, mesh.nodes, mesh.workspace
    flips = 0
    for edge in edges:
        t, k = triangle(edge), side(edge)
        if nodes[t, c.CHILD] >= 0:
            continue
        beyond = nodes[t, c.NEIGHBOR + k]
        p, a, b = nodes[t, k], nodes[t, (k + 1) % 3], nodes[t, (k + 2) % 3]
        d = nodes[triangle(beyond), side(beyond)]
        if min(p, a, b, d) < 0:
            continue
        if orient2d(points, p, a, d, w) > 0 and orient2d(points, p, d, b, w) > 0:
            correction.flip_edge(mesh, t, k)
            flips += 1
    return flips


@numba.njit
def _located(mesh, q):
    return dag.locate(mesh, q)[0]


def _leaves(store):
    return np.flatnonzero(store.nodes[: store.used, c.CHILD] < 0)


@pytest.mark.parametrize("name", EVERY_SET)
def test_edges_flipped_at_random_are_flipped_back(name):
    store, _ = inserted(EVERY_SET[name](300))
    rows = np.arange(len(store.points))
    want = canonical(compact(store.nodes[: store.used], rows).triangles)
    edges = np.random.default_rng(0).choice(edges_of(_leaves(store)), 200)
    spoilt = _spoil(store.mesh(), edges)
    flips = correction.correct(store, np.arange(ROOTS, dtype=np.int32))
    assert (flips > 0) == (spoilt > 0)
    triangles, neighbors, _ = compact(store.nodes[: store.used], rows)
    np.testing.assert_array_equal(canonical(triangles), want)
    t, k = np.nonzero(neighbors >= 0)
    assert (neighbors[neighbors[t, k]] == t[:, None]).any(axis=1).all()
    # the history leads every site to a triangle that it is a vertex of
    for q in rows:
        assert q in store.nodes[_located(store.mesh(), q), :3]


def test_a_correction_without_room_grows_the_structure():
    store, _ = inserted(EVERY_SET["uniform"](300))
    rows = np.arange(len(store.points))
    want = canonical(compact(store.nodes[: store.used], rows).triangles)
    assert _spoil(store.mesh(), edges_of(_leaves(store))[::3]) > 20
    store.shared[c.SOFT_LIMIT, 0] = store.used - 1
    assert correction.correct(store, np.arange(ROOTS, dtype=np.int32)) > 20
    assert store.growths == 1
    np.testing.assert_array_equal(canonical(compact(store.nodes[: store.used], rows).triangles), want)
