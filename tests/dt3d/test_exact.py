"""The oracle itself: it must see what is wrong."""

import numpy as np
import pytest

from .exact import in_sphere, integers, orient, validate

SIMPLEX = integers(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]))


def test_signs():
    assert orient(*SIMPLEX) == 1
    inside, outside, on = integers(np.array([[0.25, 0.25, 0.25], [2, 2, 2], [1, 1, 1.0]]))
    corners = SIMPLEX * 4  # `integers` scaled the three by 4, for the quarter
    assert in_sphere(*corners, inside) > 0
    assert in_sphere(*corners, outside) < 0
    assert in_sphere(*corners, on) == 0


def test_it_passes_what_is_right(cube):
    validate(cube)


@pytest.mark.parametrize("harm", ["turn", "drop", "neighbor", "move", "hull"])
def test_it_fails_what_is_wrong(cube, harm):
    if harm == "turn":
        cube.simplices[0] = cube.simplices[0][[1, 0, 2, 3]]
    elif harm == "drop":
        cube.duplicates = cube.duplicates[:0]
    elif harm == "neighbor":
        cube.neighbors[0, 0] = (cube.neighbors[0, 0] + 1) % 6
    elif harm == "move":
        cube.points[7] = cube.points[8] + 0.25  # one corner far inside
    else:
        cube.convex_hull[0] = cube.convex_hull[0][[1, 0, 2]]
    with pytest.raises((AssertionError, KeyError)):
        validate(cube)
