"""Rings about edges, written in parts that have too little room at first."""

from itertools import pairwise

import numpy as np
import pytest

import dt3d
from dt3d.voronoi import rings
from dt3d.voronoi.merging import vertices_of_simplices


def sets():
    points = np.random.default_rng(0).random((4000, 3))
    yield "uniform", points
    yield "lattice", np.stack(np.meshgrid(*[np.arange(15.0)] * 3, indexing="ij"), -1).reshape(-1, 3)


@pytest.mark.parametrize(("name", "points"), list(sets()))
def test_parts_find_their_own_ridges(name, points):
    tri = dt3d.Delaunay(points)
    vertex, _ = vertices_of_simplices(tri.points, tri.simplices, tri.neighbors)
    mesh = rings.Mesh(tri.simplices, tri.neighbors, vertex)
    m = len(tri.simplices)
    whole = rings.ridges_in_space(tri.points, tri.simplices, tri.neighbors, vertex, threads=1)
    cuts = [0, m // 10, m // 3, m]
    parts = [rings._ridges_of(mesh, tri.points, (begin, end), 8 * m) for begin, end in pairwise(cuts)]
    joined = rings._joined(parts)
    for one, other in zip(whole, joined, strict=True):
        assert (one == other).all()
    vor = dt3d.Voronoi(tri)
    assert (vor.ridge_indices == whole.indices).all()


@pytest.mark.parametrize("places", [0, 1, 2, 7, 100, 5000])
def test_too_little_room_is_seen(places):
    tri = dt3d.Delaunay(np.random.default_rng(1).random((500, 3)))
    vertex, _ = vertices_of_simplices(tri.points, tri.simplices, tri.neighbors)
    mesh = rings.Mesh(tri.simplices, tri.neighbors, vertex)
    m = len(tri.simplices)
    assert rings._ridges_of(mesh, tri.points, (0, m), places) is None
    # as many places as vertices are enough
    vor = dt3d.Voronoi(tri)
    exact = rings._ridges_of(mesh, tri.points, (0, m), len(vor.ridge_indices))
    assert (exact.indices == vor.ridge_indices).all()


def test_a_share_that_is_too_small_is_written_again(monkeypatch):
    monkeypatch.setattr(rings, "LARGER_SHARE", 1)
    points = np.random.default_rng(2).random((4000, 3))
    tri = dt3d.Delaunay(points)
    order = np.argsort(-tri.simplices.min(axis=1), kind="stable")  # any other order of tetrahedra
    number = np.empty(len(order), np.int32)
    number[order] = np.arange(len(order), dtype=np.int32)
    neighbors = np.where(tri.neighbors == -1, -1, number[tri.neighbors])[order].astype(np.int32)
    simplices = tri.simplices[order]
    vertex, _ = vertices_of_simplices(tri.points, simplices, neighbors)
    ridges = rings.ridges_in_space(tri.points, simplices, neighbors, vertex)
    pairs = set(map(tuple, ridges.sites.tolist()))
    assert pairs == set(map(tuple, dt3d.Voronoi(tri).ridge_points.tolist()))
