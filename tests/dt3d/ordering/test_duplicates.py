"""Equal sites are found along the curve, and the one of least index is kept."""

import numpy as np
import pytest

from dt3d._input import first_copies
from dt3d.ordering.along_curve import along_curve_in_plane, along_curve_in_space, gather
from dt3d.ordering.duplicates import copied, copies_among, separate_copies


def with_copies(seed, distinct, n, scale):
    rng = np.random.default_rng(seed)
    return (rng.random((distinct, 3)) * scale)[rng.integers(distinct, size=n)]


@pytest.mark.parametrize("scale", [1.0, 2.0**-600, 2.0**-1060])
@pytest.mark.parametrize(("distinct", "n"), [(1, 300), (5, 1000), (500, 1000), (2000, 2000)])
def test_equal_sites_are_found_and_the_first_is_kept(distinct, n, scale):
    sites = with_copies(n, distinct, n, scale)
    along = along_curve_in_space(sites, lambda work, n: work(0, n))
    assert sorted(along.tolist()) == list(range(n))
    used, pairs = separate_copies(sites, along)
    want, copies = first_copies(sites)
    np.testing.assert_array_equal(np.sort(along[:used]), np.sort(want))
    np.testing.assert_array_equal(pairs, copies)


def test_a_copy_beside_its_original_is_seen():
    sites = np.array([[0, 1, 2], [0, 1, 3], [-0.0, 1, 3], [4, 1, 3]], float)
    rows = np.empty(16)
    gather(sites, np.array([3, 2, 1, 0]), rows, 0, 4)
    assert rows.reshape(4, 4)[:, :3].tolist() == sites[::-1].tolist()
    assert copied(rows, 0, 4)
    assert copied(rows, 2, 3)
    assert not copied(rows, 0, 2)
    assert not copied(rows, 3, 4)


def test_copies_are_found_on_the_curve():
    points = np.random.default_rng(1).integers(0, 6, (60, 2)) / 7
    site, pairs = along_curve_in_plane(points)
    _, first = np.unique(points, axis=0, return_index=True)
    assert sorted(site) == sorted(first)
    assert sorted(np.append(site, pairs[:, 0])) == list(range(60))
    np.testing.assert_array_equal(points[pairs[:, 0]], points[pairs[:, 1]])


def test_copies_among_some_sites():
    sites = np.array([[0, 0], [1, 1], [0, 0], [1, 1], [0, 0]], float)
    assert copies_among(sites, np.array([4, 2, 0, 1])).tolist() == [[2, 0], [4, 0]]
