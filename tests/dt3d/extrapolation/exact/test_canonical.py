"""One order of tetrahedra."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import dt3d
from dt3d.extrapolation.exact.canonical import canonical


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1), st.sampled_from([6, 2**23]))
def test_canonical_order_does_not_depend_on_the_order_found(seed, most):
    """Tetrahedra of a real triangulation, numbered and turned at random."""
    rng = np.random.default_rng(seed)
    tri = dt3d.Delaunay(rng.random((8, 3)), method="insertion")
    names = np.sort(rng.choice(max(most, 8), 8, replace=False)).astype(np.int32)
    first = canonical(names[tri.simplices], tri.neighbors, tri.iteration)
    m = len(tri.simplices)
    order = rng.permutation(m)
    place = np.append(np.argsort(order), -1)
    turns = np.array([[0, 1, 2, 3], [1, 2, 0, 3], [3, 2, 1, 0], [1, 0, 3, 2], [2, 0, 1, 3]])[
        rng.integers(5, size=m)
    ]
    simplices = np.take_along_axis(names[tri.simplices][order], turns, 1)
    neighbors = np.take_along_axis(place[tri.neighbors][order], turns, 1)
    again = canonical(simplices, neighbors, tri.iteration[order])
    for x, y in zip(first, again, strict=True):
        np.testing.assert_array_equal(x, y)
