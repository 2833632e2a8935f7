"""Both methods on every family of degenerate and nearly degenerate sets."""

import numpy as np
import pytest

import dt3d

from .exact import canonical, check_indices, integers, orient, validate
from .families import LARGE, SMALL, check_ties, grid, integer_sphere, skew_lines, tetrahedra, with_centre

METHODS = ["insertion", "extrapolation"]
QUICK = 600  # sites that extrapolation does in some seconds; fewer of each family are in SMALL
CROWDED = {"rings", "skew lines"}  # unless each face is compared with most of them; fewer are in SMALL


def slow(name, points, method):
    long = len(points) > QUICK or name in CROWDED
    return [pytest.mark.slow] if method == "extrapolation" and long else []


def assert_it_is_what_insertion_finds_in_another_order(tri):
    shuffled = np.random.default_rng(0).permutation(tri.points)
    want = dt3d.Delaunay(shuffled, method="insertion", seed=1)
    np.testing.assert_array_equal(tetrahedra(tri), tetrahedra(want))


# each size compiles vectors of its own
LONG = {"sphere", "tetrahedron", "dodecahedron", "rings"}


@pytest.mark.parametrize(
    ("name", "method"),
    [
        pytest.param(name, method, marks=[pytest.mark.slow] * (method == "extrapolation" and name in LONG))
        for name in SMALL
        for method in METHODS
    ],
)
def test_small_sets(name, method):
    tri = dt3d.Delaunay(SMALL[name], method=method)
    validate(tri)
    check_ties(tri)
    assert tri.verify(), tri.verify()
    assert_it_is_what_insertion_finds_in_another_order(tri)


@pytest.mark.parametrize(
    ("name", "method"),
    [
        pytest.param(name, method, marks=slow(name, points, method))
        for name, points in LARGE.items()
        for method in METHODS
    ],
)
def test_large_sets(name, method):
    tri = dt3d.Delaunay(LARGE[name], method=method)
    assert tri.verify(), tri.verify()
    check_indices(tri)
    corners = integers(tri.points)[tri.simplices]
    assert (orient(*corners.swapaxes(0, 1)) > 0).all(), "a tetrahedron is flat or turned"
    assert_it_is_what_insertion_finds_in_another_order(tri)


@pytest.mark.parametrize("method", METHODS)
def test_cells_of_a_grid_split_alike(method):
    """The perturbation goes by the order of coordinates, which is the same in every cell."""
    tri = dt3d.Delaunay(grid(7), method=method)
    assert len(tri.simplices) == 6 * 6**3
    corners = tri.points[tri.simplices]
    cells = corners - np.floor(corners.min(axis=1))[:, None]
    shapes = np.unique(canonical(cells @ [4, 2, 1]), axis=0)
    assert len(shapes) == 6


@pytest.mark.parametrize("method", METHODS)
def test_numbers_of_tetrahedra_that_do_not_depend_on_ties(method):
    assert len(dt3d.Delaunay(skew_lines(20), method=method).simplices) == 19**2
    # all sites are on the hull, which has 2n - 4 triangles, each with a tetrahedron to the centre
    sphere = integer_sphere(41)
    assert len(dt3d.Delaunay(with_centre(sphere), method=method).simplices) == 2 * len(sphere) - 4
