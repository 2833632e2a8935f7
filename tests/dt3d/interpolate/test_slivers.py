"""Natural neighbours in simplices that are nearly flat and in sets of all magnitudes."""

import numpy as np
import pytest

import dt3d
from dt3d.interpolate import NaturalNeighbor, Nearest

RNG = np.random.default_rng(5)


def grid(d, k):
    return np.stack(np.meshgrid(*[np.arange(float(k))] * d), -1).reshape(-1, d)


def turned_grid(d):
    """Rounding makes slivers of sites on the hull: triangles and tetrahedra 1e-16 high."""
    turn, _ = np.linalg.qr(np.random.default_rng(0).normal(size=(d, d)))
    return grid(d, 6) @ turn


def narrow_clusters(d):
    rng = np.random.default_rng(1)
    return rng.random((6, 1, d)).repeat(50, axis=1).reshape(-1, d) + 1e-9 * rng.random((300, d))


def all_magnitudes(d):
    return np.exp(np.random.default_rng(2).uniform(-300, 0, (300, d)))


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("sites", [turned_grid, narrow_clusters, all_magnitudes])
def test_planes_are_reproduced_in_every_simplex(sites, d):
    points = sites(d)
    tri = dt3d.Delaunay(points)
    corners = points[tri.simplices[RNG.integers(0, len(tri.simplices), 600)]]
    weights = RNG.dirichlet(np.ones(d + 1), 600)
    middles = [points[tri.edges].mean(axis=1)[:300], points[tri.convex_hull].mean(axis=1)[:300]]
    xi = np.concatenate([(weights[:, :, None] * corners).sum(axis=1), *middles])
    inside = tri.find_simplex(xi) >= 0
    assert inside.sum() > 500
    f = NaturalNeighbor(tri, points)
    matrix = f.weights(xi)
    assert (np.diff(matrix.indptr)[inside] > 0).all()
    assert matrix.data.min() >= 0
    np.testing.assert_allclose(matrix.sum(axis=1), inside, atol=1e-12)
    np.testing.assert_allclose(f(xi)[inside], xi[inside], rtol=0, atol=1e-9 * np.abs(points).max())


@pytest.mark.parametrize("d", [2, 3])
def test_of_sites_that_are_as_near_the_first_is_taken(d):
    points = RNG.permutation(grid(d, 5))
    xi = np.concatenate([grid(d, 9) / 2, grid(d, 4) * 2 - 1, grid(d, 5) * 3 - 4])
    squares = ((xi[:, None] - points) ** 2).sum(axis=2)  # exact
    np.testing.assert_array_equal(Nearest(points, np.zeros(len(points))).sites(xi), squares.argmin(axis=1))


def test_all_sites_on_a_circle_are_as_near_to_its_center():
    for seed in range(20):
        rng = np.random.default_rng(seed)
        # all integer points at the distance 325 from the origin
        every = np.stack(np.meshgrid(*[np.arange(-325, 326)] * 2), -1).reshape(-1, 2)
        points = rng.permutation(every[(every**2).sum(axis=1) == 325**2])
        f = Nearest(points, np.zeros(len(points)))
        assert f.sites([[0, 0], [0, 0]]).tolist() == [0, 0]
