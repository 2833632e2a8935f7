"""From points to rows: copies, and sites that the working precision makes equal."""

import numpy as np
import pytest

import dt3d


def test_sites_that_single_precision_makes_equal_are_listed():
    points = np.random.default_rng(0).random((40, 3))
    points = np.concatenate([points, points[:2], points[5:6] + 1e-12])
    with pytest.warns(dt3d.InconsistencyWarning, match="1 sites differ from others by less") as caught:
        tri = dt3d.Delaunay(points, robustness="perturb", dtype="float32")
    assert caught[0].filename == __file__
    assert tri.duplicates.tolist() == [[40, 0], [41, 1], [42, 5]]
    assert set(np.unique(tri.simplices)) == set(range(40))


def test_a_thin_set_spans_a_volume_exactly_or_not_at_all():
    flat = np.c_[np.random.default_rng(0).random((20, 2)), np.zeros(20)]
    with pytest.raises(dt3d.DegenerateInputError, match="lie on a plane"):
        dt3d.Delaunay(flat, method="extrapolation")
    flat[7, 2] = 1e-13
    tri = dt3d.Delaunay(flat, method="extrapolation")
    assert tri.verify()
