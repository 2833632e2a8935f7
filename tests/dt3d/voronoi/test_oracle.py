"""Diagrams of a few sites, most of them degenerate, beside the oracle in rational numbers."""

from fractions import Fraction
from itertools import pairwise, product

import numpy as np
import pytest

import dt3d

from .oracle import Oracle, cross, dot, minus


def integers(n, least, d, seed):
    sites = np.random.default_rng(seed).integers(0, least, (n, d))
    return np.unique(sites, axis=0).astype(float)


def lattice(*sides):
    return np.array(list(product(*map(range, sides))), float)


CIRCLE = [(5, 0), (4, 3), (3, 4), (0, 5), (-3, 4), (-4, 3), (-5, 0), (0, -5), (3, -4)]
SETS = {
    "plane, least": np.array([[0, 0], [1, 0], [0, 1.0]]),
    "plane, lattice": lattice(3, 4),
    "plane, circle": np.array(CIRCLE, float),
    "plane, circle and centre": np.array([*CIRCLE, (0, 0)], float),
    "plane, a line and a point": np.array([[x, 0] for x in range(5)] + [[1.5, 3]], float),
    "plane, integers": integers(12, 5, 2, 0),
    "plane, random": np.random.default_rng(1).random((10, 2)),
    "plane, far away": np.random.default_rng(2).random((8, 2)) + 1e6,
    "least": np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]),
    "cube": lattice(2, 2, 2),
    "cube and centre": np.concatenate([lattice(2, 2, 2), [[0.5] * 3]]),
    "lattice": lattice(3, 2, 2),
    "octahedron": np.concatenate([np.eye(3), -np.eye(3)]),
    "octahedron and centre": np.concatenate([np.eye(3), -np.eye(3), np.zeros((1, 3))]),
    "plane and apex": np.concatenate([np.c_[lattice(3, 3), np.zeros(9)], [[1, 1, 2]]]),
    "prism": np.array([[x, y, z] for x, y in CIRCLE[:5] for z in (0, 2)], float),
    "circle and two": np.array([[x, y, 0] for x, y in CIRCLE[:6]] + [[1, 1, 4], [1, 0, -3]], float),
    "integers": integers(11, 3, 3, 3),
    "more integers": integers(11, 4, 3, 4),
    "random": np.random.default_rng(5).random((9, 3)),
    "far away": np.random.default_rng(6).random((8, 3)) + 1e6,
}


@pytest.fixture(scope="module", params=SETS)
def both(request):
    points = SETS[request.param]
    return dt3d.Voronoi(points), Oracle(points)


def names(vor, oracle):
    """The exact place of each vertex, which is next to it, and infinity."""
    exact = list(oracle.vertices)
    places = np.array(exact, float)
    scale = np.abs(vor.points).max() + np.abs(places).max()
    nearest = [int(np.argmin(np.abs(places - v).max(axis=1))) for v in vor.vertices]
    assert sorted(nearest) == list(range(len(exact)))
    assert np.abs(places[nearest] - vor.vertices).max() <= 4e-16 * scale
    return {i: exact[k] for i, k in enumerate(nearest)} | {-1: -1}


def test_vertices_are_the_centres_of_empty_spheres(both):
    vor, oracle = both
    place = names(vor, oracle)
    tri = vor.triangulation
    assert vor.vertex_of_simplex.shape == (len(tri.simplices),)
    for simplex, v in zip(tri.simplices, vor.vertex_of_simplex, strict=True):
        assert oracle.vertices[place[v]] >= set(simplex.tolist())


def test_ridges_are_those_with_an_area(both):
    vor, oracle = both
    place = names(vor, oracle)
    expected = oracle.ridges()
    found = {}
    for sites, ends in zip(vor.ridge_points.tolist(), vor.ridge_vertices, strict=True):
        assert -1 not in ends[1:]
        assert len(set(ends)) == len(ends)
        pair = min(sites), max(sites)
        assert pair not in found
        found[pair] = {place[v] for v in ends if v != -1}, -1 in ends
    assert found == expected


def test_ridges_go_around(both):
    vor, oracle = both
    place = names(vor, oracle)
    for (p, q), ends in zip(vor.ridge_points.tolist(), vor.ridge_vertices, strict=True):
        axis = minus(oracle.sites[q], oracle.sites[p])
        corners = [place[v] for v in ends if v != -1]
        if vor.ndim == 2:
            if len(corners) == 2:
                way = minus(corners[1], corners[0])
                assert axis[0] * way[1] - axis[1] * way[0] > 0
            continue
        # an open ridge is an arc: its first and last edges meet nowhere
        turns = range(len(corners)) if ends[0] != -1 else range(1, len(corners) - 1)
        for i in turns:
            back, ahead = corners[i - 1], corners[(i + 1) % len(corners)]
            assert dot(axis, cross(minus(corners[i], back), minus(ahead, corners[i]))) > 0
        if ends[0] == -1 and len(corners) > 1:
            rays = oracle.region(p, q)[1]
            for ray in rays:
                # each ray turns at one of the ends
                first = dot(axis, cross(tuple(-x for x in ray), minus(corners[1], corners[0])))
                last = dot(axis, cross(minus(corners[-1], corners[-2]), ray))
                assert first > 0 or last > 0


def test_regions_are_those_of_the_sites(both):
    vor, oracle = both
    place = names(vor, oracle)
    assert vor.regions[0] == []
    assert vor.point_region.dtype == np.int64
    assert sorted(vor.point_region) == list(range(1, len(vor.points) + 1))
    for k, r in enumerate(vor.point_region):
        ends, rays = oracle.region(k)
        region = vor.regions[r]
        assert {place[v] for v in region} == set(ends) | ({-1} if rays else set())
        assert len(set(region)) == len(region)
        assert -1 not in region[1:]
        if vor.ndim == 3:
            assert region == sorted(region)
        elif not rays:
            corners = [place[v] for v in region]
            for i in range(len(corners)):
                one = minus(corners[i - 1], corners[i - 2])
                two = minus(corners[i], corners[i - 1])
                assert one[0] * two[1] - one[1] * two[0] > 0
        else:
            ends = [place[v] for v in region[1:]]
            for i in range(2, len(ends)):
                one, two = minus(ends[i - 1], ends[i - 2]), minus(ends[i], ends[i - 1])
                assert one[0] * two[1] - one[1] * two[0] > 0


def test_arrays_have_what_lists_have(both):
    vor, _ = both
    for rows, indptr, indices in (
        (vor.ridge_vertices, vor.ridge_indptr, vor.ridge_indices),
        (vor.regions, vor.region_indptr, vor.region_indices),
    ):
        assert [indices[a:b].tolist() for a, b in pairwise(indptr)] == rows
        assert indptr[0] == 0
        assert indptr[-1] == len(indices)
        assert (indptr.dtype, indices.dtype) == (np.int64, np.int32)
    assert vor.ridge_points.dtype == np.int32
    assert vor.ridge_dict == {
        tuple(sites): ends for sites, ends in zip(vor.ridge_points.tolist(), vor.ridge_vertices, strict=True)
    }


def exact_volume(oracle, k):
    """The volume of a bounded region: pyramids to its ridges, each a fan of triangles; a Fraction."""
    total, site = Fraction(0), oracle.sites[k]
    for pair, (ends, _) in oracle.ridges().items():
        if k not in pair:
            continue
        if oracle.d == 2:
            one, two = (minus(e, site) for e in ends)
            total += abs(one[0] * two[1] - one[1] * two[0]) / 2
            continue
        axis = minus(*(oracle.sites[i] for i in pair))
        ends = sorted_around(list(ends), axis)
        one = minus(ends[0], site)
        for b, c in pairwise(ends[1:]):
            total += abs(dot(one, cross(minus(b, site), minus(c, site)))) / 6
    return total


def sorted_around(ends, axis):
    """The corners of a convex polygon, in order: each next one has all others on one side."""
    order = [ends[0]]
    while len(order) < len(ends):
        here = order[-1]
        left = [e for e in ends if e not in order]
        order.append(
            next(
                e for e in left
                if all(dot(axis, cross(minus(e, here), minus(f, here))) >= 0 for f in ends if f != e)
            )
        )  # fmt: skip
    return order


def test_volumes_and_areas(both):
    vor, oracle = both
    unbounded = np.array([bool(oracle.region(k)[1]) for k in range(len(vor.points))])
    assert (np.isinf(vor.volumes) == unbounded).all()
    assert (np.isinf(vor.areas) == [-1 in ends for ends in vor.ridge_vertices]).all()
    assert (vor.areas > 0).all()
    offset = np.abs(vor.points).max() / np.ptp(vor.points, axis=0).max()
    for k in np.flatnonzero(~unbounded):
        assert vor.volumes[k] == pytest.approx(float(exact_volume(oracle, k)), rel=1e-13 * offset)
