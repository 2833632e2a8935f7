"""Sites along the curve, also where they crowd."""

import numpy as np
import pytest

from dt3d.ordering.along_curve import along_curve_in_plane, along_curve_in_space, bounds

from ..families import grid


def at_once(work, n):
    work(0, n)


def in_threes(work, n):
    for begin in range(0, n, 3):
        work(begin, min(begin + 3, n))


@pytest.mark.parametrize("k", [2, 4, 16])
def test_in_space_it_goes_from_each_cell_to_one_beside_it(k):
    sites = (grid(k) + 0.5) / k
    along = along_curve_in_space(sites[np.random.default_rng(k).permutation(k**3)], at_once)
    assert sorted(along.tolist()) == list(range(k**3))
    shuffled = sites[np.random.default_rng(k).permutation(k**3)]
    steps = np.abs(np.diff(shuffled[along_curve_in_space(shuffled, in_threes)], axis=0)).sum(axis=1)
    # the box of the sites is not that of the cells, so a few steps are longer
    assert np.median(steps) * k == pytest.approx(1)
    assert steps.mean() * k < 1.5


def test_clusters_within_clusters_have_curves_of_their_own():
    rng = np.random.default_rng(0)
    sites = np.concatenate([rng.random((1000, 3)) * 2.0 ** (-30 * k) for k in range(8)])
    along = along_curve_in_space(sites, at_once)
    assert sorted(along.tolist()) == list(range(len(sites)))
    level = along // 1000
    assert (np.diff(level) != 0).sum() < 40  # each cluster is one stretch, but for its corner at the next
    for k in range(8):
        inside = sites[along[level == k]]
        steps = np.linalg.norm(np.diff(inside, axis=0), axis=1) / 2.0 ** (-30 * k)
        assert steps.mean() < 0.2  # in no order 0.66


@pytest.mark.parametrize("side", [2, 16, 64])
def test_in_the_plane_it_goes_from_each_cell_to_one_beside_it(side):
    y, x = np.divmod(np.arange(side * side), side)
    points = np.column_stack([x, y]).astype(float)
    shuffle = np.random.default_rng(0).permutation(len(points))
    site, pairs = along_curve_in_plane(points[shuffle])
    assert len(pairs) == 0
    path = points[shuffle][site]
    assert len(np.unique(path, axis=0)) == side * side
    assert (np.abs(np.diff(path, axis=0)).sum(axis=1) == 1).all()


@pytest.mark.parametrize("d", [2, 3])
def test_the_box_of_sites(d):
    sites = np.random.default_rng(d).normal(size=(50, d))
    np.testing.assert_array_equal(bounds(sites), [sites.min(axis=0), sites.max(axis=0)])
