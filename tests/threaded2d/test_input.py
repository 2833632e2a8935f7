"""What bad input gets, and what duplicates and extreme coordinates get."""

import numpy as np
import pytest

import dt3d
from dt3d import threaded2d

GOOD = np.random.default_rng(0).random((20, 2))


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (np.zeros((4, 3)), r"shape \(n, 2\), got \(4, 3\)"),
        (np.zeros(4), r"shape \(n, 2\), got \(4,\)"),
        (np.zeros((0, 2)), "empty; a triangulation needs at least three"),
        ([["a", "b"]] * 3, "real numbers"),
        (GOOD * 1j, "real numbers"),
        (np.ma.masked_array(GOOD, GOOD > 0.9), "masked"),
        (
            np.where(np.arange(40).reshape(20, 2) == 7, np.nan, GOOD),
            "1 rows have NaN or infinity, the first is row 3",
        ),
        (
            np.where(np.arange(40).reshape(20, 2) > 37, np.inf, GOOD),
            "1 rows have NaN or infinity, the first is row 19",
        ),
        ([[1, 2], [3]], "one length"),
    ],
)
def test_errors_of_points(points, message):
    with pytest.raises(ValueError, match=message):
        threaded2d.Delaunay(points)


@pytest.mark.parametrize(
    "method", ["auto", "sequential", "batch", "circumcircle", "pessimistic", "optimistic"]
)
@pytest.mark.parametrize(
    ("points", "dimension", "where"),
    [
        ([[1.0, 2.0]], 0, "1 distinct sites that came coincide"),
        ([[1.0, 2.0]] * 5, 0, "1 distinct sites that came coincide"),
        ([[0.0, 0.0], [1.0, 1.0]], 1, "2 distinct sites that came lie on a line"),
        (np.outer(np.arange(50), [3.0, 7.0]), 1, "50 distinct sites that came lie on a line"),
    ],
)
def test_flat_sets(method, points, dimension, where):
    with pytest.raises(dt3d.DegenerateInputError, match=where) as caught:
        threaded2d.Delaunay(points, method=method)
    assert caught.value.dimension == dimension


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"method": "fast"}, "method must be one of 'auto', .* got 'fast'"),
        ({"order": "sorted"}, "order must be"),
        ({"location": "tree"}, "location must be"),
        ({"subdivision": "rows"}, "subdivision must be"),
        ({"threads": 0}, "threads must be an integer of at least 1, got 0"),
        ({"threads": 65}, "at most 64"),
        ({"threads": True}, "threads must be an integer"),
        ({"queue_length": 1}, "queue_length must be an integer of at least 2"),
        ({"seed": None}, "seed must be an integer"),
        ({"method": "sequential", "threads": 2}, "has one thread"),
        ({"method": "batch", "threads": 1}, "needs a searching and a specialised thread"),
        ({"order": "random", "subdivision": "curve"}, "goes with order='brio'"),
    ],
)
def test_errors_of_options(options, message):
    with pytest.raises(ValueError, match=message):
        threaded2d.Delaunay(GOOD, **options)


@pytest.mark.parametrize("order", ["brio", "random"])
def test_duplicates_are_used_once_and_listed(order):
    points = np.vstack([GOOD, GOOD[[4, 4, 9]], GOOD[:2]])
    tri = threaded2d.Delaunay(points, method="optimistic", threads=2, order=order)
    assert tri.duplicates.tolist() == [[20, 4], [21, 4], [22, 9], [23, 0], [24, 1]]
    assert (tri.inserted_by[20:] == -1).all()
    assert (tri.inserted_by[:20] >= 0).all()
    assert tri.verify(), tri.verify()


@pytest.mark.parametrize(
    "points",
    [
        GOOD * 1e150, GOOD * 1e300, GOOD * 1e-300, GOOD * 5e-324 * 1e3, GOOD + 1e6, GOOD * [1, 1e-200],
        np.vstack([GOOD, [[1e300, -1e300], [5e-324, 0]]]), GOOD.astype(np.float32), (GOOD * 100).astype(int),
        np.nextafter(1.0, 2.0 + GOOD),
    ],
)  # fmt: skip
def test_any_finite_coordinates(points):
    try:
        tri = threaded2d.Delaunay(points)
    except dt3d.DegenerateInputError:
        assert len(np.unique(points, axis=0)) < 3
    else:
        assert tri.verify(), tri.verify()


def test_minus_zero_is_zero():
    tri = threaded2d.Delaunay([[0.0, 0.0], [-0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    assert tri.duplicates.tolist() == [[1, 0]]
    assert len(tri.triangles) == 1
