"""The signed distance of a face against what it stands for."""

import hypothesis.extra.numpy as hnp
import hypothesis.strategies as st
import jax
import numpy as np
from hypothesis import given, settings

from dt3d.extrapolation.points import Point
from dt3d.extrapolation.signed_distance import circumsphere, frame, signed_distance

from ..exact import in_sphere, integers, orient

# lattice points in the unit cube: differences and determinants of these are exact in float64
coordinates = st.integers(0, 64).map(lambda k: k / 64)
sites = hnp.arrays(np.float64, (5, 3), elements=coordinates)


def in_double(function, *args):
    with jax.enable_x64(True):
        return jax.tree.map(np.asarray, function(*args))


def points(rows):
    return [Point(*(np.float64(x) for x in row)) for row in rows]


@given(sites)
def test_sign_of_the_height_is_the_orientation(rows):
    a, b, c, d, _ = points(rows)
    exact = integers(rows)
    if not np.any(np.cross(rows[1] - rows[0], rows[2] - rows[0])):
        return
    face = in_double(frame, a, b, c)
    finite = np.isfinite(in_double(signed_distance, face, d))
    # coplanar lattice sites are exactly coplanar; the least other height is far above the error
    assert finite == (orient(*exact[:4]) > 0)


def turned(rows):
    """The sites with the first two changed so that the first four are positive; None if they are flat."""
    sign = orient(*integers(rows)[:4])
    return None if sign == 0 else rows if sign > 0 else rows[[1, 0, 2, 3, 4]]


@given(sites)
@settings(max_examples=80)  # in half of them the fifth site is on the other side
def test_the_least_signed_distance_has_the_empty_sphere(rows):
    rows = turned(rows)
    if rows is None or orient(*integers(rows)[[0, 1, 2, 4]]) <= 0:
        return
    exact = integers(rows)
    a, b, c, d, e = points(rows)
    face = in_double(frame, a, b, c)
    inside = in_sphere(*exact[:4], exact[4])
    distance_d = in_double(signed_distance, face, d)
    distance_e = in_double(signed_distance, face, e)
    if inside > 0:
        assert distance_e < distance_d
    elif inside < 0:
        assert distance_e > distance_d


@given(sites)
def test_the_circumsphere_passes_through_all_four(rows):
    rows = turned(rows)
    if rows is None:
        return
    a, b, c, d, _ = points(rows)
    face = in_double(frame, a, b, c)
    centre, squared = in_double(lambda f, p: circumsphere(f, signed_distance(f, p)), face, d)
    gaps = [np.sum((np.array(centre) - row) ** 2) - squared for row in rows[:4]]
    # |p - o|^2 and r^2 cancel; what is left is rounding of r^2, magnified for faces of small height
    scale = np.linalg.norm(rows[1:4] - rows[0], axis=1).max()
    height = np.linalg.norm(np.cross(rows[1] - rows[0], rows[2] - rows[0])) / scale
    assert np.abs(gaps).max() <= 1e-14 * (1 + squared) * (1 + (scale / height) ** 2)


def test_the_normal_is_a_unit_vector_also_of_thin_faces():
    for height in (1e-3, 1e-6, 1e-9):
        a, b, c = points(np.array([[0.1, 0.2, 0.3], [0.9, 0.7, 0.4], [0.5, 0.45 + height, 0.35]]))
        face = in_double(frame, a, b, c)
        edges = np.array(b) - np.array(a), np.array(c) - np.array(a)
        normal = np.array(face.normal)
        assert abs(np.linalg.norm(normal) - 1) < 1e-15
        for edge in edges:
            assert abs(normal @ edge) < face.height_error
