"""Exact insertion: against SciPy, its memory and what it counts."""

import numpy as np
import pytest
import scipy.spatial

import dt3d
from dt3d.insertion import driver

from ..exact import canonical, check_indices, check_neighbors, validate
from ..families import skew_lines


@pytest.mark.parametrize("n", [10, 300, 20_000])
def test_equals_scipy(n):
    points = np.random.default_rng(n).standard_normal((n, 3))
    tri = dt3d.Delaunay(points, method="insertion")
    want = scipy.spatial.Delaunay(points).simplices
    np.testing.assert_array_equal(canonical(tri.simplices), canonical(want))
    check_indices(tri)
    check_neighbors(tri)


def test_memory_grows_where_the_output_is_quadratic(monkeypatch):
    monkeypatch.setattr(driver, "SLOTS_PER_SITE", 0)  # begin with 64
    tri = dt3d.Delaunay(skew_lines(40))
    assert len(tri.simplices) == 39 * 39
    validate(tri)


def test_statistics_and_phases():
    tri = dt3d.Delaunay(np.random.default_rng(0).random((2000, 3)))
    assert isinstance(tri.stats, dt3d.InsertionStatistics)
    # a site destroys about 20 tetrahedra and makes about 27
    assert 20 < tri.stats.created / 2000 < 30
    assert tri.stats.created < tri.stats.tested
    assert list(tri.stats.seconds) == ["order", "insertion", "compaction", "total"]
    assert (tri.iteration == 1).all()
