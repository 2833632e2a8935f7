"""`threaded2d.verify` passes what is right and names what is broken."""

import numpy as np
import pytest

from dt3d import threaded2d
from dt3d.threaded2d import verify

RANDOM = np.random.default_rng(0).random((50, 2))


def broken(report):
    return [what for what, count in report.invariants if count]


@pytest.fixture(scope="module")
def good():
    return threaded2d.Delaunay(RANDOM, method="sequential")


def test_points_and_triangles_are_enough(good):
    report = verify(RANDOM, good.triangles)
    assert report
    assert str(report).count("holds: ") == len(report.invariants) == 7


def test_orientation_of_other_peoples_meshes_is_a_remark(good):
    report = verify(RANDOM, good.triangles[:, ::-1], neighbors=good.neighbors[:, ::-1])
    m = len(good.triangles)
    assert report
    assert report.remarks == (f"{m} of {m} triangles are negatively oriented, and were turned first",)
    report = verify(RANDOM, good.triangles[:, ::-1], oriented=True)
    assert broken(report) == ["every triangle is positively oriented"]


def test_a_wrong_neighbor(good):
    neighbors = np.array(good.neighbors)
    neighbors[0] = neighbors[0, ::-1]
    assert broken(verify(RANDOM, good.triangles, neighbors=neighbors)) == ["neighbors says which ones"]


def test_a_missing_triangle(good):
    assert not verify(RANDOM, good.triangles[1:])


def test_a_moved_site(good):
    moved = RANDOM.copy()
    moved[7] = 0.5
    assert not verify(moved, good.triangles)


def test_a_mesh_that_winds_twice():
    angle = 2 * np.pi * np.arange(5) / 5
    points = np.concatenate([[[0, 0]], np.column_stack([np.cos(angle), np.sin(angle)])])
    pentagram = [[0, 1 + i, 1 + (i + 2) % 5] for i in range(5)]
    assert broken(verify(points, pentagram)) == ["a point inside the first triangle is in no other one"]
