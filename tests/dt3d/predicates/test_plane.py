"""Signs in the plane as the drawing has them, and ties."""

import numpy as np

from dt3d.predicates import plane, work_array

from .oracle import inside_perturbed
from .simplices import simplices

DRAWN = np.array([[0, 0], [1, 0], [0, 1], [0.5, 0.5], [1, 1], [2, 2]])


def test_signs_are_those_of_the_drawing():
    w = work_array(DRAWN)
    assert plane.orient2d(DRAWN, 0, 1, 2, w) == 1
    assert plane.orient2d(DRAWN, 1, 0, 2, w) == -1
    assert plane.orient2d(DRAWN, 0, 3, 4, w) == 0
    assert [plane.in_circle(DRAWN, 0, 1, 2, d, w) for d in (3, 4, 5)] == [1, 0, -1]


def test_indices_of_any_width_have_one_sign():
    w = work_array(DRAWN)
    assert plane.in_circle(DRAWN, np.int32(0), np.int64(1), np.uint32(2), np.int32(4), w) == 0
    assert plane.orient2d(DRAWN, np.int32(0), np.int64(3), np.uint32(4), w) == 0


def test_ties_go_as_infinitesimal_heights_do():
    points, rows = simplices(2, 3, 800)
    w = work_array(points)
    got = [plane.inside(points, tuple(row[:-1].tolist()), int(row[-1]), w) for row in rows]
    assert got == [inside_perturbed(points[row], row) for row in rows]
    assert 0.2 < np.mean(got) < 0.8
