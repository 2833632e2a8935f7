"""Exact insertion: against SciPy, the oracle, and itself in other orders."""

import numpy as np
import pytest
import scipy.spatial

import dt3d
from dt3d.insertion import loop, order

from ..exact import as_coordinates, canonical, check_indices, check_neighbors, validate


def grid(n):
    return np.stack(np.meshgrid(*[np.arange(float(n))] * 3, indexing="ij"), -1).reshape(-1, 3)


@pytest.mark.parametrize("n", [10, 300, 20_000])
def test_equals_scipy(n):
    points = np.random.default_rng(n).standard_normal((n, 3))
    tri = dt3d.Delaunay(points, method="insertion")
    want = scipy.spatial.Delaunay(points).simplices
    np.testing.assert_array_equal(canonical(tri.simplices), canonical(want))
    check_indices(tri)
    check_neighbors(tri)


def ring(n, z):
    angle = 2 * np.pi * np.arange(n) / n
    return np.c_[np.cos(angle), np.sin(angle), np.full(n, z)]


def on_sphere(n):
    points = np.random.default_rng(n).standard_normal((n, 3))
    return points / np.linalg.norm(points, axis=1)[:, None]


HARD = {
    "grid": grid(6),
    "far grid": grid(4) + 1e9,
    "tenths": grid(5) * 0.1,
    "sphere": on_sphere(300),
    "rings": np.concatenate([ring(60, z) for z in range(3)]),
    "cone": np.concatenate([ring(100, 0), [[0, 0, 1]]]),
    "plane up to rounding": np.c_[ring(30, 0)[:, :2], ring(30, 0)[:, :2] @ [0.3, 0.7]],
    "an ulp apart": np.concatenate([grid(3) + 1, np.nextafter(grid(3) + 1, np.inf)]),
    "near duplicates": np.concatenate([on_sphere(40), on_sphere(40) * (1 + 1e-15)]),
    "clusters": np.concatenate([on_sphere(50) * 2.0**-40, on_sphere(50)]),
}


@pytest.mark.parametrize("name", HARD)
def test_hard_sets(name):
    validate(dt3d.Delaunay(HARD[name], method="insertion"))


@pytest.mark.parametrize("name", HARD)
def test_the_result_does_not_depend_on_the_order(name):
    points = np.unique(HARD[name], axis=0)
    want = as_coordinates(points, dt3d.Delaunay(points).simplices)
    for seed in range(3):
        shuffled = np.random.default_rng(seed).permutation(points)
        assert as_coordinates(shuffled, dt3d.Delaunay(shuffled, seed=seed).simplices) == want


def test_cells_of_a_grid_split_alike():
    tri = dt3d.Delaunay(grid(7))
    assert len(tri.simplices) == 1296
    corners = tri.points[tri.simplices]
    lowest = np.floor(corners.min(axis=1))
    shapes = {frozenset(map(tuple, (c - low).tolist())) for c, low in zip(corners, lowest, strict=True)}
    assert len(shapes) == 6


def test_memory_grows_where_the_output_is_quadratic(monkeypatch):
    monkeypatch.setattr(loop, "SLOTS_PER_SITE", 0)  # begin with 64
    line = np.arange(40.0)[:, None]
    points = np.concatenate([line * [1, 0, 0], line * [0, 1, 0] + [0, 0, 1]])
    tri = dt3d.Delaunay(points)
    assert len(tri.simplices) == 39 * 39
    validate(tri)


def test_real_sets_with_every_degeneracy(shared_points):
    for name in ("suzanne", "xyz_cube", "angle_block", "zeo_emt", "joint", "pdb_1a8o"):
        validate(dt3d.Delaunay(shared_points(name)))


def test_statistics_and_phases():
    tri = dt3d.Delaunay(np.random.default_rng(0).random((2000, 3)))
    assert isinstance(tri.stats, dt3d.InsertionStatistics)
    # a site destroys about 20 tetrahedra and makes about 27
    assert 20 < tri.stats.created / 2000 < 30
    assert tri.stats.created < tri.stats.tested
    assert list(tri.stats.seconds) == ["order", "insertion", "compaction", "total"]
    assert (tri.iteration == 1).all()


def test_the_order_of_insertion():
    n = 10_000
    sequence = order.insertion_order(n)
    assert sorted(sequence.tolist()) == list(range(n))
    turns = np.flatnonzero(np.diff(sequence) < 0)  # between rounds, each of which ascends
    sizes = np.diff(np.concatenate([[0], turns + 1, [n]]))
    assert (np.abs(sizes[1:] - np.cumsum(sizes)[:-1]) < 6 * np.sqrt(np.cumsum(sizes)[:-1])).all()
    codes = order.morton_codes(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1.0], [1, 1, 1]]))
    assert (np.diff(codes.astype(object)) > 0).all()
    assert codes[-1] == 2**63 - 1
