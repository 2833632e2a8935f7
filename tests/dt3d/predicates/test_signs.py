"""Exact predicates against Python integers, and against published hard cases where they are at hand."""

import hypothesis.extra.numpy as hnp
import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

from dt3d import predicates

from ..exact import in_sphere, integers, orient

# few values, so that coplanar and cospherical cases are common
lattice = hnp.arrays(np.float64, (5, 3), elements=st.integers(-3, 3).map(float))
in_range = st.floats(-(2.0**180), 2.0**180).map(lambda x: x if abs(x) > 2.0**-130 else 0.0)
floats = hnp.arrays(np.float64, (5, 3), elements=in_range)


def check(points):
    exact = integers(points)
    assert predicates.orient3d(*points[:4]) == np.sign(orient(*exact[:4]))
    assert predicates.in_sphere(*points) == np.sign(in_sphere(*exact))


@given(lattice)
def test_lattice(points):
    check(points)


@given(floats)
def test_any_floats_in_range(points):
    check(points)


@given(lattice, st.integers(0, 4), st.integers(0, 2), st.integers(-2, 2))
def test_an_ulp_beside_a_lattice(points, i, axis, ulps):
    moved = points + 16.0
    for _ in range(abs(ulps)):
        moved[i, axis] = np.nextafter(moved[i, axis], np.inf * ulps)
    check(moved)


def test_many_nearly_cospherical_at_once():
    rng = np.random.default_rng(0)
    points = rng.standard_normal((500, 5, 3))
    points /= np.linalg.norm(points, axis=2, keepdims=True)
    got = predicates.in_sphere(*points.transpose(1, 0, 2))
    want = [int(np.sign(in_sphere(*integers(p)))) for p in points]
    assert got.tolist() == want
    assert len(set(want)) == 2


@pytest.mark.parametrize(
    ("function", "name", "count"),
    [(predicates.orient3d, "pred_orient3d_a", 4), (predicates.in_sphere, "pred_insphere_a", 5)],
)
def test_hard_cases(function, name, count, shared_cases):
    cases, sign = shared_cases(name)
    scaled = np.ldexp(cases, -60)  # exact; up to 8e34 as they come
    # their determinants have rows p_i - p_last, which for both predicates is the opposite sign
    np.testing.assert_array_equal(function(*(scaled[:, i] for i in range(count))), -sign)


def test_errors():
    a = np.zeros(3)
    with pytest.raises(ValueError, match=r"shape \(..., 3\), got \(2,\)"):
        predicates.orient3d(a[:2], a[:2], a[:2], a[:2])
    with pytest.raises(ValueError, match=r"between 2\^-137 and 2\^190 .* scale by a power of two"):
        predicates.orient3d(a, a, a, a + 1e-300)
    with pytest.raises(ValueError, match="scale by a power of two"):
        predicates.in_sphere(a, a, a, a, a + np.nan)
