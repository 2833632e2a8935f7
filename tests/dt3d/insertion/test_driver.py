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


def test_reports_are_far_apart_and_end_at_the_end(monkeypatch):
    monkeypatch.setattr(driver, "SITES_PER_REPORT", 100)
    left = []
    driver.triangulate(
        np.random.default_rng(0).random((5000, 3)), 0, 1, lambda sites, slots: left.append(sites)
    )
    assert left[-1] == 0
    assert left == sorted(left, reverse=True)
    assert len(set(left)) == len(left) > 3
    assert (-np.diff(left[:-1]) >= 100).all()


def test_room_for_the_result():
    points = np.random.default_rng(0).random((200, 3))
    want = driver.triangulate(points)
    m = len(want.simplices)
    own = np.full((2, m + 5, 4), 7, np.int32)
    given = []

    def room(needed):
        given.append(needed)
        return own[0, :needed], own[1, :needed]

    out = driver.triangulate(points, room=room)
    assert given == [m]
    np.testing.assert_array_equal(own[:, :m], [want.simplices, want.neighbors])
    assert (own[:, m:] == 7).all()
    assert np.shares_memory(out.simplices, own)
    assert np.shares_memory(out.neighbors, own)


def test_no_room_for_the_result():
    def room(needed):
        raise KeyError(needed)

    with pytest.raises(KeyError, match="1"):
        driver.triangulate(np.concatenate([np.zeros((1, 3)), np.eye(3)]), room=room)
