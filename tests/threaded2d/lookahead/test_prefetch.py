"""What is loaded ahead is what lies around a triangle."""

from types import FunctionType

import numpy as np
import pytest

from dt3d.threaded2d.columns import side, triangle
from dt3d.threaded2d.lookahead import prefetch

from ..families import uniform
from ..runs import half_inserted
from ..stepping import across, leaf_pairs, leaves


def _loaded(function, store, t):
    """What a function, not compiled, would load: rows of the points, and triangles."""
    rows, triangles = [], []

    def load(array, i):
        (rows if array is store.points else triangles).append(int(i))

    source = function.py_func
    names = {"prefetch": load, "triangle": triangle.py_func, "side": side.py_func}
    FunctionType(source.__code__, source.__globals__ | names)(store.mesh(), t)
    return sorted(rows), sorted(triangles)


@pytest.fixture(scope="module")
def store():
    return half_inserted(uniform(100))[0]


def test_around_a_triangle_are_its_vertices_and_neighbours(store):
    pairs = leaf_pairs(store)
    for t in leaves(store).tolist():
        vertices, neighbours = _loaded(prefetch.prefetch_around, store, t)
        assert vertices == sorted(store.nodes[t, :3].tolist())
        assert neighbours == sorted(across(store, t, k, pairs) for k in range(3))


def test_beyond_are_the_far_vertices_and_the_neighbours_of_neighbours(store):
    pairs = leaf_pairs(store)
    for t in leaves(store).tolist():
        far, beyond = [], []
        for k in range(3):
            u = across(store, t, k, pairs)
            row = store.nodes[u, :3].tolist()
            shared = set(store.nodes[t, :3].tolist()) - {int(store.nodes[t, k])}
            far += [v for v in row if v not in shared]
            beyond += [across(store, u, j, pairs) for j in range(3) if row[j] in shared]
        assert _loaded(prefetch.prefetch_beyond, store, t) == (sorted(far), sorted(beyond))


def test_loading_changes_nothing(store):
    before = store.nodes.copy(), store.points.copy()
    for t in range(store.used):
        prefetch.prefetch_around(store.mesh(), t)
        prefetch.prefetch_beyond(store.mesh(), t)
    np.testing.assert_array_equal(store.nodes, before[0])
    np.testing.assert_array_equal(store.points, before[1])
