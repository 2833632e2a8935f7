"""Interpolation: linear functions are reproduced, and what is between is that of SciPy or of cells."""

import pickle
import threading

import numpy as np
import pytest
import scipy.interpolate
import scipy.spatial

import dt3d
from dt3d.interpolate import Linear, NaturalNeighbor, Nearest

RNG = np.random.default_rng(17)
KINDS = [Linear, NaturalNeighbor, Nearest]
DIMENSIONS = pytest.mark.parametrize("d", [2, 3])


def grid(d, k):
    return np.stack(np.meshgrid(*[np.arange(float(k))] * d), -1).reshape(-1, d)


def sets(d):
    return {
        "random": RNG.random((300, d)),
        "a grid": grid(d, 5),
        "duplicates": np.repeat(RNG.random((60, d)), 2, axis=0),
        "far away": RNG.random((200, d)) + 1e6,
        "clusters": RNG.random((6, 1, d)).repeat(50, axis=1).reshape(-1, d) + 1e-4 * RNG.random((300, d)),
        "tiny": RNG.random((200, d)) * 1e-150,
        "huge": RNG.random((200, d)) * 1e150,
        "few": np.concatenate([np.zeros((1, d)), np.eye(d), np.full((1, d), 0.3)]),
    }


def queries(points, k=300):
    """Points within the box, at sites, in the middle of edges and facets, and on the hull."""
    tri = dt3d.Delaunay(points)
    low, high = points.min(axis=0), points.max(axis=0)
    middles = [points[tri.edges[:40]].mean(axis=1), points[tri.convex_hull[:40]].mean(axis=1)]
    middles.append(points[tri.simplices[:40, 1:]].mean(axis=1))
    return np.concatenate([RNG.random((k, len(low))) * (high - low) + low, points[:40], *middles])


@DIMENSIONS
@pytest.mark.parametrize("kind", [Linear, NaturalNeighbor])
def test_linear_functions_are_reproduced(kind, d):
    slope = np.arange(1, d + 1)
    for name, points in sets(d).items():
        low, size = points.min(axis=0), np.ptp(points)
        accuracy = {"far away": 1e-8, "clusters": 1e-9}.get(
            name, 1e-10
        )  # of coordinates, and of limits on the hull
        values = 2 + (points - low) @ slope / size
        f = kind(points, values)
        xi = queries(points)
        got = f(xi)
        inside = dt3d.Delaunay(points).find_simplex(xi) >= 0
        assert inside.sum() > 50, name
        assert np.isnan(got[~inside]).all(), name
        wanted = 2 + (xi - low) @ slope / size
        assert np.abs(got - wanted)[inside].max() < accuracy, name
        plain = inside.copy()
        plain[300:] = False
        if name not in ("far away", "clusters"):
            assert np.abs(got - wanted)[plain].max() < 1e-12, name
        slopes = f.gradient(xi[plain])
        if name == "clusters":  # nearly flat simplices between clusters
            continue
        np.testing.assert_allclose(slopes * size, np.broadcast_to(slope, slopes.shape), rtol=1e-6, atol=1e-6)


@DIMENSIONS
@pytest.mark.parametrize("kind", KINDS)
def test_values_at_sites_are_the_data(kind, d):
    for name, points in sets(d).items():
        values = RNG.random(len(points))
        used = np.arange(len(points))
        tri = dt3d.Delaunay(points)
        used[tri.duplicates[:, 0]] = tri.duplicates[:, 1]
        got = kind(tri, values)(points)
        np.testing.assert_allclose(got, values[used], rtol=1e-9, atol=1e-12, err_msg=name)


@DIMENSIONS
def test_linear_is_scipys(d):
    points, values = RNG.random((300, d)), RNG.normal(size=(300, 2, 3))
    xi = RNG.uniform(-0.2, 1.2, (7, 40, d))
    for rescale in (False, True):
        scaled = points * np.arange(1, d + 1) ** 5
        mine = Linear(scaled, values, fill_value=-7, rescale=rescale)
        theirs = scipy.interpolate.LinearNDInterpolator(scaled, values, fill_value=-7, rescale=rescale)
        x = xi * np.arange(1, d + 1) ** 5
        np.testing.assert_allclose(mine(x), theirs(x), rtol=1e-9, atol=1e-11)


@DIMENSIONS
def test_nearest_is_the_nearest(d):
    for name, points in sets(d).items():
        xi = np.concatenate([queries(points), points[:60] * 3 - points.mean(axis=0) * 2])
        f = Nearest(points, np.arange(len(points)))
        sites = f.sites(xi)
        low, size = points.min(axis=0), np.ptp(points)
        distance = scipy.spatial.distance.cdist((xi - low) / size, (points - low) / size)
        least = distance.min(axis=1)
        mine = distance[np.arange(len(xi)), sites]
        np.testing.assert_allclose(mine, least, rtol=1e-12, atol=1e-15, err_msg=name)
        np.testing.assert_array_equal(f(xi), sites)
    assert f.sites([[np.nan] * d, [0] * d]).tolist() == [-1, 0]
    assert np.isnan(f([np.inf] * d))


def cell_sizes(points, x):
    """What a point takes of each cell, by the cells with it and without it, within a great box."""
    d = points.shape[1]
    normals = np.concatenate([np.eye(d), -np.eye(d)])

    def size(of, sites):
        other = sites[(sites != of).any(axis=1)]
        half = np.concatenate(
            [
                np.column_stack([2 * (other - of), (of**2).sum() - (other**2).sum(axis=1)]),
                np.column_stack([normals, np.full(2 * d, -6.0)]),
            ]
        )
        corners = scipy.spatial.HalfspaceIntersection(half, of).intersections
        return scipy.spatial.ConvexHull(corners).volume

    with_it = np.concatenate([points, [x]])
    taken = np.array([size(p, points) - size(p, with_it) for p in points])
    return taken / taken.sum()


@DIMENSIONS
def test_weights_are_what_is_taken_of_cells(d):
    points = np.concatenate([RNG.random((25, d)), grid(d, 2) * 1.5 - 0.25])
    xi = np.concatenate([RNG.random((6, d)), np.full((1, d), 0.5)])
    weights = NaturalNeighbor(points, np.zeros(len(points))).weights(xi)
    assert weights.shape == (7, len(points))
    for x, row in zip(xi, weights.toarray(), strict=True):
        np.testing.assert_allclose(row, cell_sizes(points, x), atol=1e-9)


@DIMENSIONS
def test_weights_on_a_grid_are_those_of_symmetry(d):
    """In the middle of a cube all corners have the same weight, however its simplices are chosen."""
    weights = NaturalNeighbor(grid(d, 4), np.zeros(4**d)).weights(np.full((1, d), 1.5))
    (row,) = weights.toarray()
    corners = ((grid(d, 4) == 1) | (grid(d, 4) == 2)).all(axis=1)
    np.testing.assert_allclose(row, corners / 2**d, atol=1e-15)


@DIMENSIONS
def test_weights_on_the_hull_are_limits(d):
    points = grid(d, 4)
    f = NaturalNeighbor(points, np.zeros(4**d))
    on_it = RNG.random((50, d)) * 3
    on_it[:, 0] = 0
    at_the_limit, near = f.weights(on_it).toarray(), f.weights(on_it + 1e-7 * np.eye(d)[0]).toarray()
    np.testing.assert_allclose(at_the_limit, near, atol=1e-6)
    np.testing.assert_allclose(at_the_limit @ points, on_it, atol=1e-10)
    assert np.abs(at_the_limit[:, points[:, 0] > 0]).max() < 1e-6  # no site within has a part of it


@DIMENSIONS
def test_gradients_are_those_of_differences(d):
    points = RNG.random((200, d))
    values = np.stack([np.sin(3 * points).sum(axis=1), np.cos(points[:, 0])], axis=1)
    xi = RNG.uniform(0.3, 0.7, (40, d))
    for kind, step in ((Linear, 1e-7), (NaturalNeighbor, 1e-5)):
        f = kind(points, values)
        wanted = np.stack([(f(xi + step * e) - f(xi - step * e)) / (2 * step) for e in np.eye(d)], axis=-1)
        got = f.gradient(xi)
        assert got.shape == (40, 2, d)
        # few points are nearer to where the derivative bends or jumps than the step
        wrong = (np.abs(got - wanted) > 1e-4).any(axis=(1, 2))
        assert wrong.sum() <= 1, kind
    assert np.isnan(NaturalNeighbor(points, values).gradient(points[:3])).all()
    assert np.isnan(Linear(points, values).gradient([[9.0] * d])).all()


@pytest.mark.parametrize("kind", KINDS)
def test_shapes_kinds_and_coordinates(kind):
    points = RNG.random((100, 2))
    values = RNG.random((100, 4)) + 1j * RNG.random((100, 4))
    f = kind(points, values)
    xi = RNG.uniform(0.3, 0.7, (5, 6, 2))
    assert f(xi).shape == (5, 6, 4)
    assert f(xi).dtype == np.complex128
    np.testing.assert_array_equal(f(xi).real, kind(points, values.real)(xi))
    np.testing.assert_array_equal(f(xi), f(xi[..., 0], xi[..., 1]))
    np.testing.assert_array_equal(f(xi), f((xi[..., 0], xi[..., 1])))
    np.testing.assert_array_equal(f(xi[:, 0, 0], 0.5)[2], f([xi[2, 0, 0], 0.5])[0])
    np.testing.assert_array_equal(kind((points[:, 0], points[:, 1]), values)(xi), f(xi))
    assert f([0.5, 0.5]).shape == (1, 4)  # as in SciPy
    assert f(0.5, 0.5).shape == (4,)
    assert f(np.empty((0, 2))).shape == (0, 4)
    assert kind(points, np.arange(100))(xi).dtype == np.float64
    assert kind(points, values > 0)(0.5, 0.5).shape == (4,)
    if kind is not Nearest:
        assert f.gradient(xi).shape == (5, 6, 4, 2)
        np.testing.assert_array_equal(f.gradient(xi).imag, kind(points, values.imag).gradient(xi))
        outside = kind(points, values, fill_value=1 + 2j)([[9, 9], [np.nan, 0]])
        assert (outside == 1 + 2j).all()
    again = pickle.loads(pickle.dumps(f))
    np.testing.assert_array_equal(again(xi), f(xi))
    assert repr(f) == f"<dt3d.interpolate.{kind.__name__}: 100 sites, values of shape (4,)>"


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_refused(kind):
    points, values = RNG.random((30, 2)), RNG.random(30)
    tri = dt3d.Delaunay(points)
    for args, message in [
        ((points, values[:-1]), r"one entry per site, shape \(30, ...\), got shape \(29,\)"),
        ((points, 3.0), r"got shape \(\)"),
        ((points, ["a"] * 30), "values must be real or complex numbers, got dtype <U1"),
        ((points[:, :1], values), r"must have shape \(n, 2\) or \(n, 3\)"),
    ]:
        with pytest.raises(ValueError, match=message):
            kind(*args)
    with pytest.raises(ValueError, match="Rescaling is not supported"):
        kind(tri, values, rescale=True)
    f = kind(tri, values)
    assert f.tri is tri
    with pytest.raises(ValueError, match=r"shape \(..., 2\), or 2 arrays of coordinates; got 3"):
        f(1, 2, 3)
    with pytest.raises(ValueError, match=r"must have shape \(\.\.\., 2\), got \(1, 3\)"):
        f([[1, 2, 3]])
    if kind is not Nearest:
        for fill, message in [("a", "fill_value must be a number"), (1j, "must be real as the values are")]:
            with pytest.raises(ValueError, match=message):
                kind(tri, values, fill_value=fill)
    if kind is not Linear:
        with pytest.raises(ValueError, match="needs a whole triangulation, got a part of one"):
            kind(tri.subset([0, 1]), values)
        with pytest.raises(ValueError, match="needs an exact triangulation"):
            kind(dt3d.Delaunay(RNG.random((30, 3)), robustness="perturb"), values)


def test_a_part_of_a_triangulation_has_holes():
    points = RNG.random((200, 2))
    tri = dt3d.Delaunay(points)
    middles = points[tri.simplices].mean(axis=1)
    part = tri.subset(np.linalg.norm(middles - 0.5, axis=1) > 0.2)
    f = Linear(part, points @ [1, 2])
    assert np.isnan(f([0.5, 0.5]))
    np.testing.assert_allclose(f(middles[part.kept]), middles[part.kept] @ [1, 2])


@DIMENSIONS
def test_many_neighbours(d):
    """All sites on a sphere are neighbours of its center."""
    points = RNG.normal(size=(3000, d))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    f = NaturalNeighbor(points, points)
    np.testing.assert_allclose(f([[0.0] * d, [0.01] * d]), [[0.0] * d, [0.01] * d], atol=1e-9)
    assert np.diff(f.weights([[0.0] * d]).indptr)[0] > 1000


def test_threads_may_share_an_interpolator():
    points = RNG.random((500, 3))
    xi = RNG.uniform(0.2, 0.8, (3000, 3))
    f = NaturalNeighbor(points, points[:, 0])
    wanted, got = f(xi), {}
    threads = [threading.Thread(target=lambda k=k: got.update({k: f(xi)})) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for k in range(4):
        np.testing.assert_array_equal(got[k], wanted)
