"""Sizes, circumcenters, weights, edges and graphs, beside exact fractions."""

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
import scipy.spatial

import dt3d
from dt3d.geometry.barycentric import barycentric_weights
from dt3d.geometry.circumcenters import circumcenters
from dt3d.geometry.measures import measures

from . import families

RNG = np.random.default_rng(11)
DIMENSIONS = pytest.mark.parametrize("d", [2, 3])


def simplices(d, k):
    """Random simplices of every shape: k rows of d + 1 own points, many of them slivers, and their rows."""
    corners = RNG.normal(size=(k, d + 1, d))
    corners[k // 4 :, -1] = corners[k // 4 :, :-1].mean(axis=1)  # on the plane of the others, up to rounding
    corners[k // 2 :, -1] += RNG.normal(size=(k - k // 2, d)) * 2.0 ** -RNG.integers(1, 60, (k - k // 2, 1))
    return corners.reshape(-1, d), np.arange(k * (d + 1), dtype=np.int32).reshape(k, d + 1)


def minors(rows):
    if len(rows) == 1:
        return rows[0][0]
    return sum(
        (-1) ** k * rows[0][k] * minors([row[:k] + row[k + 1 :] for row in rows[1:]])
        for k in range(len(rows))
    )


def exact(corners):
    """The measure and the circumcenter of a simplex as fractions; no center if it is flat."""
    a, *others = [[Fraction(x) for x in row] for row in corners.tolist()]
    d = len(a)
    sides = [[x - y for x, y in zip(row, a, strict=True)] for row in others]
    det = minors(sides)
    if det == 0:
        return det, None
    squares = [sum(x * x for x in side) / 2 for side in sides]
    center = []
    for k in range(d):  # Cramer's rule for side . c = |side|^2 / 2
        replaced = [[*row[:k], s, *row[k + 1 :]] for row, s in zip(sides, squares, strict=True)]
        center.append(minors(replaced) / det)
    return det / math.factorial(d), [x + y for x, y in zip(center, a, strict=True)]


@DIMENSIONS
@pytest.mark.parametrize("scale", [1.0, 2.0**-300, 2.0**300, 1e-100, 1e6])
def test_measures_and_circumcenters_are_those_of_fractions(d, scale):
    points, rows = simplices(d, 200)
    points *= scale
    got, (centers, radii) = measures(points, rows), circumcenters(points, rows)
    slivers = 0
    for t, row in enumerate(rows):
        size, center = exact(points[row])
        if size == 0:
            assert got[t] == 0
            continue
        slivers += abs(size) < Fraction(2) ** -40 * Fraction(scale) ** d
        assert got[t] == pytest.approx(float(size), rel=1e-14, abs=0)
        square = sum((x - Fraction(y)) ** 2 for x, y in zip(center, points[row[0]].tolist(), strict=True))
        radius = float(square / Fraction(scale) ** 2) ** 0.5 * scale
        assert radii[t] == pytest.approx(radius, rel=1e-14)
        # against the radius, and the coordinates themselves, which are rounded
        size = radius + np.abs(points[row]).max()
        np.testing.assert_allclose(centers[t], [float(x) for x in center], rtol=0, atol=1e-14 * size)
    assert slivers > 20


@DIMENSIONS
def test_weights_are_those_of_fractions(d):
    points, rows = simplices(d, 200)
    inside = RNG.dirichlet(np.ones(d + 1), len(rows))
    xi = np.einsum("ij,ijk->ik", inside, points[rows])
    weights = barycentric_weights(points, rows, np.arange(len(rows), dtype=np.int32), xi)
    for t, row in enumerate(rows):
        size, _ = exact(points[row])
        if size == 0:
            continue
        for k in range(d + 1):
            moved = points[row].copy()
            moved[k] = xi[t]
            wanted = float(exact(moved)[0] / size)
            assert weights[t, k] == pytest.approx(wanted, rel=1e-11, abs=1e-11)


@DIMENSIONS
def test_sizes_of_triangulations(d):
    sets = {
        "random": RNG.random((500, d)),
        "a grid": np.stack(np.meshgrid(*[np.arange(5.0)] * d), -1).reshape(-1, d),
        "far away": RNG.random((300, d)) + 1e6,
        "tiny": RNG.random((300, d)) * 1e-90,
        "huge": RNG.random((300, d)) * 1e100,
        "slivers": RNG.random((300, d)) * [1e-12, *[1] * (d - 1)],
        "all magnitudes": RNG.normal(size=(300, d)) * 10.0 ** RNG.integers(-40, 40, (300, 1)),
    }
    for name, points in sets.items():
        tri = dt3d.Delaunay(points)
        assert (tri.volumes > 0).all(), name
        if name != "all magnitudes":  # Qhull gives up on it
            hull = scipy.spatial.ConvexHull(points / np.ptp(points, axis=0))
            extent = np.prod(np.ptp(points, axis=0))
            np.testing.assert_allclose(tri.volumes.sum() / extent, hull.volume, rtol=1e-9, err_msg=name)
        distance = np.linalg.norm(tri.points[tri.simplices] - tri.circumcenters[:, None], axis=2)
        size = tri.circumradii + np.abs(points).max()
        assert (np.abs(distance - tri.circumradii[:, None]) <= 1e-14 * size[:, None]).all(), name
        for array in (tri.volumes, tri.circumcenters, tri.circumradii, tri.edges):
            with pytest.raises(ValueError, match="read-only"):
                array[:] = 0


@DIMENSIONS
def test_sizes_that_float64_cannot_hold(d):
    corners = np.concatenate([np.zeros((1, d)), np.eye(d)])
    tiny, huge = dt3d.Delaunay(corners * 1e-300), dt3d.Delaunay(corners * 1e300)
    assert tiny.volumes.tolist() == [0.0]
    assert huge.volumes.tolist() == [math.inf]
    np.testing.assert_allclose(tiny.circumcenters * 1e300, 0.5)
    np.testing.assert_allclose(huge.circumcenters / 1e300, 0.5)
    assert huge.circumradii[0] == pytest.approx(d**0.5 / 2 * 1e300)


@DIMENSIONS
def test_barycentric_coordinates(d):
    tri = dt3d.Delaunay(RNG.random((400, d)))
    xi = RNG.uniform(-0.1, 1.1, (30, 40, d))
    xi[3, 3] = np.nan
    found, weights = tri.barycentric(xi)
    np.testing.assert_array_equal(found, tri.find_simplex(xi))
    inside = found >= 0
    assert weights.shape == (30, 40, d + 1)
    assert np.isnan(weights[~inside]).all()
    assert (weights[inside] > -1e-14).all()
    np.testing.assert_allclose(weights[inside].sum(axis=-1), 1, rtol=1e-14)
    again = np.einsum("ij,ijk->ik", weights[inside], tri.points[tri.simplices[found[inside]]])
    np.testing.assert_allclose(again, xi[inside], atol=1e-14)
    part = tri.subset(tri.volumes > np.median(tri.volumes))
    found, weights = part.barycentric(xi)
    inside = found >= 0
    again = np.einsum("ij,ijk->ik", weights[inside], part.points[part.simplices[found[inside]]])
    np.testing.assert_allclose(again, xi[inside], atol=1e-14)
    one, weights = tri.barycentric(np.full(d, 0.5))
    assert (one.shape, weights.shape) == ((), (d + 1,))


@DIMENSIONS
def test_weights_at_sites_and_on_a_grid_are_exact(d):
    grid = np.stack(np.meshgrid(*[np.arange(4.0)] * d), -1).reshape(-1, d)
    tri = dt3d.Delaunay(grid)
    for points in (grid, (grid + 0.5)[(grid < 3).all(axis=1)]):
        found, weights = tri.barycentric(points)
        again = np.einsum("ij,ijk->ik", weights, tri.points[tri.simplices[found]])
        np.testing.assert_array_equal(again, points)


@DIMENSIONS
def test_edges_and_graphs(d):
    points = np.concatenate([RNG.random((100, d)), np.zeros((2, d))])
    tri = dt3d.Delaunay(points)
    pairs = {tuple(sorted(e)) for t in tri.simplices.tolist() for e in itertools.combinations(t, 2)}
    assert tri.edges.dtype == np.int32
    assert [tuple(e) for e in tri.edges.tolist()] == sorted(pairs)
    graph = tri.to_sparse()
    assert graph.shape == (102, 102)
    assert graph.nnz == 2 * len(pairs) == graph.sum()
    lengths = tri.to_sparse("length")
    for u, v in tri.edges[::7]:
        assert lengths[u, v] == lengths[v, u] == pytest.approx(np.linalg.norm(points[u] - points[v]))
    near = scipy.sparse.csgraph.shortest_path(lengths, indices=[0])
    straight = np.linalg.norm(points - points[0], axis=1)
    assert (near[0][np.isfinite(near[0])] >= straight[np.isfinite(near[0])] * (1 - 1e-12)).all()
    with pytest.raises(ValueError, match="weights must be 'one' or 'length', got 'distance'"):
        tri.to_sparse("distance")
    part = tri.subset(tri.volumes > np.median(tri.volumes))
    kept = {tuple(sorted(e)) for t in part.simplices.tolist() for e in itertools.combinations(t, 2)}
    assert [tuple(e) for e in part.edges.tolist()] == sorted(kept)
    np.testing.assert_array_equal(part.volumes, tri.volumes[part.kept])
    np.testing.assert_array_equal(part.circumcenters, tri.circumcenters[part.kept])


@DIMENSIONS
def test_boundaries_and_alpha_shapes(d):
    tri = dt3d.Delaunay(RNG.random((300, d)))
    keep = tri.circumradii < np.median(tri.circumradii)
    np.testing.assert_array_equal(tri.boundary(keep), tri.subset(keep).boundary)
    np.testing.assert_array_equal(tri.boundary(np.ones(tri.nsimplex, bool)), tri.convex_hull)
    alpha = float(np.median(tri.circumradii))
    shape = tri.alpha_shape(alpha)
    np.testing.assert_array_equal(shape.kept, np.flatnonzero(tri.circumradii <= alpha))
    assert alpha in shape.circumradii or tri.nsimplex % 2 == 0
    # every facet of the boundary is seen an even number of times from each of its own facets
    ends = np.concatenate([np.delete(shape.boundary, k, axis=1) for k in range(d)])
    counts = np.unique(np.sort(ends), axis=0, return_counts=True)[1]
    assert (counts % 2 == 0).all()
    assert len(tri.alpha_shape(0).simplices) == 0
    assert len(tri.alpha_shape(np.inf).simplices) == tri.nsimplex
    for alpha in (-1, np.nan, "auto", None, True):
        with pytest.raises(ValueError, match="alpha must be a radius"):
            tri.alpha_shape(alpha)


def test_a_grid_has_no_flat_simplices():
    tri = dt3d.Delaunay(families.grid(5))
    np.testing.assert_allclose(tri.volumes, 1 / 6)
    np.testing.assert_allclose(tri.circumradii, 0.75**0.5)
