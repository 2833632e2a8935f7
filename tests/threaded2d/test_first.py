"""The first triangle, and what is then left to insert."""

import numpy as np
import pytest

from dt3d import DegenerateInputError
from dt3d.threaded2d.first import first_triangle

from .families import uniform

LINE = np.column_stack([np.arange(6.0), 2 * np.arange(6.0)])


def test_the_first_two_and_the_first_that_is_beside_their_line():
    points = np.vstack([LINE, [[3.0, 0.0], [0.0, 5.0]]])
    for order, want in (
        ([0, 1, 2, 3, 7, 4, 5, 6], {0, 1, 7}),
        ([5, 0, 6, 1, 2, 3, 4, 7], {5, 0, 6}),
        ([6, 7, 0, 1, 2, 3, 4, 5], {6, 7, 0}),
    ):
        bounds = np.array([0, 3, 3, 8])
        vertices, left, begins = first_triangle(points, np.array(order), bounds)
        assert set(vertices.tolist()) == want
        (ax, ay), (bx, by), (cx, cy) = points[vertices]
        assert (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) > 0
        assert left.tolist() == [v for v in order if v not in want]
        # parts keep their sites
        for k in range(3):
            part = [v for v in order[bounds[k] : bounds[k + 1]] if v not in want]
            assert left[begins[k] : begins[k + 1]].tolist() == part


@pytest.mark.parametrize(("sites", "dimension"), [([0], 0), ([0, 1], 1), (range(6), 1)])
def test_sites_that_span_no_area(sites, dimension):
    order = np.array(list(sites))
    with pytest.raises(DegenerateInputError) as caught:
        first_triangle(LINE, order, np.array([0, len(order)]))
    assert caught.value.dimension == dimension


def test_of_three_sites_nothing_is_left():
    vertices, left, bounds = first_triangle(uniform(3), np.arange(3), np.array([0, 1, 3]))
    assert sorted(vertices.tolist()) == [0, 1, 2]
    assert not len(left)
    assert bounds.tolist() == [0, 0, 0]
