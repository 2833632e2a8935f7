"""The first tetrahedron is positive, and of sites that span no volume there is none; whatever the scale."""

from fractions import Fraction

import numpy as np
import pytest

from dt3d import DegenerateInputError
from dt3d._first_tetrahedron import first_tetrahedron

SCALES = [2.0**e for e in (-1060, -700, -300, -40, 0, 40, 900)]


def determinant(points, corners):
    a, b, c, d = ([Fraction(x) for x in points[i].tolist()] for i in corners)
    u, v, w = ([p - q for p, q in zip(other, a, strict=True)] for other in (b, c, d))
    return sum(u[i] * (v[(i + 1) % 3] * w[(i + 2) % 3] - v[(i + 2) % 3] * w[(i + 1) % 3]) for i in range(3))


def moved(points, shift, scale):
    """Points near another place, distinct there."""
    return np.unique(points * scale + shift, axis=0)


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("shift", [0.0, 1.0])
def test_it_is_positive_at_all_scales(scale, shift):
    rng = np.random.default_rng(0)
    grid = np.stack(np.meshgrid(*[np.arange(3.0)] * 3), -1).reshape(-1, 3)
    for points in (rng.random((30, 3)), grid, rng.random((9, 3)) * [1, 1e-12, 1e-25], rng.random((4, 3))):
        sites = moved(points, shift, scale)
        try:
            corners = first_tetrahedron(sites, 0)
        except DegenerateInputError:
            # of the grid, and of what is moved away by more than it is large
            flat = [
                determinant(sites, [0, i, j, k])
                for k in range(len(sites))
                for j in range(k)
                for i in range(j)
            ]
            assert not any(flat)
        else:
            assert 0 in corners
            assert determinant(sites, corners) > 0


@pytest.mark.parametrize("scale", SCALES)
def test_what_is_on_a_line_or_plane_has_none(scale):
    t = np.arange(1.0, 12.0)
    line = np.column_stack([t, 3 * t, 7 * t]) * scale
    plane = np.column_stack([t, t**2, t + 2 * t**2]) * scale
    for flat in (line, plane):
        assert np.isfinite(flat).all()
        with pytest.raises(DegenerateInputError):
            first_tetrahedron(flat, 3)


def test_a_site_off_a_plane_by_the_smallest_number_is_found():
    plane = np.array([[1.0, 0, 0], [0, 1, 0], [1, 1, 0], [0.25, 0.5, 0], [0.5, 0.25, 5e-324]])
    corners = first_tetrahedron(plane, 1)
    assert 4 in corners
    assert determinant(plane, corners) > 0
