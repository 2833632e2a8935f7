"""The input contract: what bad input gets, word for word."""

import numpy as np
import pytest

import dt3d
import scanvec as sv

from .exact import as_coordinates, validate

RNG = np.random.default_rng(0)
POINTS = RNG.random((20, 3))
DYADIC = np.round(POINTS * 2**20) / 2**20


def with_value(value):
    points = POINTS.copy()
    points[[4, 9], 1] = value
    return points


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (POINTS.ravel(), r"shape \(n, 2\) or \(n, 3\), got \(60,\)"),
        (POINTS[None], r"shape \(n, 2\) or \(n, 3\), got \(1, 20, 3\)"),
        ([[1, 2, 3], [4, 5]], r"rows that came do not have one length"),
        (np.zeros((0, 3)), "points are empty"),
        (POINTS + 1j, "real numbers.*complex128"),
        (POINTS.astype(str), "real numbers.*<U"),
        (POINTS > 0.5, "real numbers.*bool"),
        (np.where(POINTS > 0.9, None, POINTS), "real numbers; row .* is None, of type NoneType"),
        (np.ma.masked_array(POINTS, POINTS > 0.9), "masked array"),
        (with_value(np.nan), "2 rows have NaN or infinity, the first is row 4"),
        (with_value(np.inf), "2 rows have NaN or infinity, the first is row 4"),
        ((POINTS * 2**60).astype(np.int64) | 1, "row 0, column 0 of points is .*does not hold"),
    ],
)
def test_what_is_no_set_of_points(points, message):
    with pytest.raises(ValueError, match=message):
        dt3d.Delaunay(points)


@pytest.mark.parametrize(
    ("points", "dimension", "words"),
    [
        (np.ones((7, 3)), 0, "the 1 distinct sites that came coincide"),
        (POINTS[:1], 0, "coincide"),
        (np.outer(np.arange(9), [1, 2, 3]), 1, "lie on a line"),
        (POINTS[:2], 1, "lie on a line"),
        (POINTS * [1, 1, 0], 2, "lie on a plane"),
        (POINTS[:3], 2, "lie on a plane"),
        (np.c_[DYADIC[:, :2], DYADIC[:, :2].sum(axis=1)], 2, "lie on a plane"),  # without rounding
        (np.concatenate([POINTS[:3], POINTS[:3]]), 2, "the 3 distinct sites"),
    ],
)
@pytest.mark.parametrize("method", ["insertion", "extrapolation"])
def test_sets_without_volume(points, dimension, words, method):
    with pytest.raises(dt3d.DegenerateInputError, match=words) as caught:
        dt3d.Delaunay(points, method=method)
    assert caught.value.dimension == dimension
    assert f"dimension {dimension}" in str(caught.value)
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"method": "flip"}, "method must be 'auto', 'insertion' or 'extrapolation', got 'flip'"),
        ({"robustness": "none"}, "robustness must be 'exact' or 'perturb', got 'none'"),
        ({"method": "insertion", "robustness": "perturb"}, "go with method='extrapolation'"),
        ({"method": "insertion", "machine": sv.Device()}, "go with method='extrapolation'"),
        ({"dtype": "float32"}, "cannot hold the sites exactly; it goes with robustness='perturb'"),
        ({"dtype": "float16"}, "dtype must be float64 or float32, got 'float16'"),
        ({"dtype": "no"}, "dtype must be float64 or float32, got 'no'"),
        ({"machine": "gpu"}, "machine must be a scanvec machine"),
        ({"seed": -1}, "seed must be an integer that is not negative, of any size, got -1"),
        ({"seed": True}, "seed must be an integer that is not negative, of any size, got True"),
        ({"seed": 1.0}, "seed must be an integer that is not negative, of any size, got 1.0"),
        ({"callback": 3}, "callback must be callable"),
    ],
)
def test_unknown_options(options, message):
    with pytest.raises(ValueError, match=message):
        dt3d.Delaunay(POINTS, **options)


def test_duplicates_are_used_once_and_listed():
    points = np.concatenate([POINTS, POINTS[[3, 3, 7]], -0.0 * POINTS[:1], 0.0 * POINTS[:1]])
    tri = dt3d.Delaunay(points)
    assert tri.duplicates.tolist() == [[20, 3], [21, 3], [22, 7], [24, 23]]  # -0.0 equals 0.0
    validate(tri)


def test_sites_that_single_precision_cannot_tell_apart_are_listed():
    points = np.concatenate([POINTS, POINTS[:2] + 1e-12])
    with pytest.warns(dt3d.InconsistencyWarning, match="2 sites differ from others by less than float32"):
        tri = dt3d.Delaunay(points, robustness="perturb", dtype="float32")
    assert tri.duplicates.tolist() == [[20, 0], [21, 1]]


@pytest.mark.parametrize("dtype", [np.int16, np.uint64, np.float32, np.float16])
def test_other_numbers_are_taken(dtype):
    points = (RNG.random((30, 3)) * 1000).astype(dtype)
    tri = dt3d.Delaunay(points)
    assert tri.points.dtype == np.float64
    validate(tri)


def test_the_input_is_not_changed():
    points = POINTS.copy()
    points.flags.writeable = False
    np.testing.assert_array_equal(dt3d.Delaunay(points).points, POINTS)


@pytest.mark.parametrize("method", ["insertion", "extrapolation"])
@pytest.mark.parametrize("exponent", [-1060, -300, 300, 1020])
def test_extreme_magnitudes(exponent, method):
    points = np.ldexp(np.round(POINTS * 4096), exponent - 12)
    validate(dt3d.Delaunay(points, method=method))


def magnitudes(*values):
    """Some points whose coordinates are of these magnitudes, mixed, and 0."""
    rng = np.random.default_rng(0)
    return rng.choice([0.0, *values, *(-x for x in values)], (60, 3)) * rng.integers(1, 3, (60, 3))


@pytest.mark.parametrize(
    "points",
    [
        np.concatenate([POINTS, [[1e-50, 0, 0], [1e-50, 1e-60, 0], [0, 1e-50, 1e-300]]]),
        np.concatenate([POINTS, np.round(POINTS * 3) * 1e-50]),
        np.concatenate([POINTS, np.round(POINTS * 9) * 5e-324]),  # subnormal numbers
        np.round(POINTS * 9) * 5e-324,
        np.concatenate([POINTS * 1e300, POINTS, POINTS * 1e-300]),
        np.concatenate([POINTS, [[1e300, 0, 0], [0, -1e300, 1.7e308]]]),
        magnitudes(1e-300, 1, 1e300),
        magnitudes(5e-324, 1e-50, 1, 8e307),
        np.concatenate([np.round(POINTS * 3) * 5e-324, np.round(POINTS * 3) * 1e-300 + [1e300, 0, 0]]),
        np.round(POINTS * 9) * [1e285, 1e-300, 5e-324] + [1e300, 0, 0],
    ],
)
def test_magnitudes_far_apart(points):
    tri = dt3d.Delaunay(points, method="insertion")
    validate(tri)
    assert tri.verify()
    again = dt3d.Delaunay(points[::-1], method="insertion")
    assert as_coordinates(again.points, again.simplices) == as_coordinates(points, tri.simplices)


def test_a_plane_of_coordinates_far_apart():
    points = np.concatenate([POINTS * 1e300, POINTS, POINTS * 1e-300])
    points[:, 2] = -1e-300
    with pytest.raises(dt3d.DegenerateInputError, match="the 60 distinct sites that came lie on a plane"):
        dt3d.Delaunay(points, method="insertion")
    with pytest.raises(dt3d.DegenerateInputError, match="lie on a line"):
        dt3d.Delaunay(points * [0, 1, 0], method="insertion")


@pytest.mark.parametrize("method", ["insertion", "extrapolation"])
def test_a_plane_up_to_rounding_has_volume(method):
    points = np.c_[POINTS[:, :2], POINTS[:, :2].sum(axis=1) / 3]
    validate(dt3d.Delaunay(points, method=method))
    with pytest.raises(dt3d.DegenerateInputError, match="lie on a plane"):
        dt3d.Delaunay(points, robustness="perturb")


@pytest.mark.parametrize("method", ["insertion", "extrapolation"])
def test_far_from_the_origin(method):
    validate(dt3d.Delaunay(POINTS + 1e6, method=method))


@pytest.mark.parametrize("method", ["insertion", "extrapolation"])
def test_differences_that_would_overflow(method):
    validate(dt3d.Delaunay((DYADIC * 2 - 1) * 1.7e308, method=method))
