"""Normalisation is exact where it can be; the perturbation is linear and small."""

import hypothesis.extra.numpy as hnp
import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

from dt3d.extrapolation import normalise, perturb
from dt3d.extrapolation.perturbation import MAGNITUDE

arrays = hnp.arrays(
    np.float64, (6, 3), elements=st.floats(allow_nan=False, allow_infinity=False, allow_subnormal=False)
)


@given(arrays)
def test_normalised_sites_fill_the_unit_cube(points):
    if not (points.max(axis=0) / 4 - points.min(axis=0) / 4).max() > 0:
        return
    sites = normalise(points)
    assert (sites >= 0).all()
    assert 0.5 <= sites.max() <= 1


@given(hnp.arrays(np.int32, (6, 3), elements=st.integers(-(2**25), 2**25)), st.integers(-1000, 900))
def test_lattices_stay_lattices(points, exponent):
    if (points == points[0]).all():
        return
    sites = normalise(np.ldexp(points.astype(float), exponent))
    ratio = sites.max() / (points - points.min(axis=0)).max()
    assert np.frexp(ratio)[0] == 0.5  # a power of two
    np.testing.assert_array_equal(sites, (points - points.min(axis=0)) * ratio)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_perturbation(dtype):
    sites = np.random.default_rng(0).random((50, 3))
    moved = perturb(sites, dtype, seed=1)
    assert moved.dtype == dtype
    change = moved.astype(float) - sites.astype(dtype)
    assert 0 < np.abs(change).max() < 4 * MAGNITUDE[np.dtype(dtype)]
    np.testing.assert_array_equal(perturb(sites, dtype, seed=1), moved)
    assert not np.array_equal(perturb(sites, dtype, seed=2), moved)
    # linear: the change of a sum is the sum of the changes, up to rounding of the coordinates
    halves = perturb(sites / 2, np.float64, 1) - sites / 2
    whole = perturb(sites, np.float64, 1) - sites
    np.testing.assert_allclose(2 * halves, whole, atol=4e-16)
