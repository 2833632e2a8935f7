"""Signs in space as the drawing has them, and ties."""

import numba
import numpy as np

from dt3d.predicates import space, work_array

from .oracle import inside_perturbed
from .simplices import simplices

DRAWN = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0.5], [1, 1, 1], [2, 2, 2]])


def test_signs_are_those_of_the_drawing():
    w = work_array(DRAWN)
    assert space.orient3d(DRAWN, 0, 1, 2, 3, w) == 1
    assert space.orient3d(DRAWN, 1, 0, 2, 3, w) == -1
    assert space.orient3d(DRAWN, 0, 4, 5, 6, w) == 0
    assert [space.in_sphere(DRAWN, 0, 1, 2, 3, e, w) for e in (4, 5, 6)] == [1, 0, -1]


@numba.njit
def _with_each(points, v, site, w):
    return [space.orientation_with(points, v, k, site, w) for k in range(4)]


def test_a_site_in_the_place_of_each_vertex():
    assert _with_each(DRAWN, (0, 1, 2, 3), 4, work_array(DRAWN)) == [-1, 1, 1, 1]


def test_ties_go_as_infinitesimal_heights_do():
    points, rows = simplices(3, 3, 800)
    w = work_array(points)
    got = [space.inside(points, tuple(row[:-1].tolist()), int(row[-1]), w) for row in rows]
    assert got == [inside_perturbed(points[row], row) for row in rows]
    assert 0.2 < np.mean(got) < 0.8
