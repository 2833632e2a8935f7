"""Some of the triangles: their border runs round them, holes included."""

from collections import Counter

import numpy as np

from dt3d import OUTSIDE, Subset, threaded2d

POINTS = np.random.default_rng(0).integers(0, 1000, (120, 2)).astype(float)


def _twice_the_area(tri):
    a, b, c = (tri.points[tri.triangles[:, k]] for k in range(3))
    u, v = b - a, c - a
    return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum()


def _part():
    """The triangulation without a disk, and the part."""
    tri = threaded2d.Delaunay(POINTS)
    middles = tri.points[tri.triangles].mean(axis=1)
    return tri, tri.subset(((middles - 500) ** 2).sum(axis=1) > 200**2)


def test_a_part_is_of_triangles():
    tri, part = _part()
    assert type(part) is type(part.subset([0])) is Subset
    assert part.triangles is part.simplices
    np.testing.assert_array_equal(part.triangles, tri.triangles[part.kept])
    assert 0 < len(part.triangles) < len(tri.triangles)
    np.testing.assert_array_equal(part.points, tri.points)


def test_the_border_runs_round_the_part_and_its_hole():
    tri, part = _part()
    (x0, y0), (x1, y1) = (part.points[part.boundary[:, k]].T for k in (0, 1))
    # integers, so that the sums are exact
    assert (x0 * y1 - x1 * y0).sum() == _twice_the_area(part) < _twice_the_area(tri)
    begins, ends = Counter(part.boundary[:, 0].tolist()), Counter(part.boundary[:, 1].tolist())
    assert begins == ends
    assert len(part.boundary) == (part.neighbors == OUTSIDE).sum() > len(tri.convex_hull)


def test_the_hole_is_outside():
    tri, part = _part()
    middles = tri.points[tri.triangles].mean(axis=1)
    found = part.find_simplex(middles)
    want = np.full(len(tri.triangles), OUTSIDE)
    want[part.kept] = np.arange(len(part.kept))
    np.testing.assert_array_equal(found, want)
