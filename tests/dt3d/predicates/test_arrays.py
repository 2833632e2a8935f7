"""The predicates on arrays, of both backends, against Python integers and against published hard cases."""

import hypothesis.extra.numpy as hnp
import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings

from dt3d import predicates

from .oracle import DIMENSION, POINTS, sign

PREDICATES = list(POINTS)
GREATEST = np.finfo(np.float64).max
SUBNORMAL = 5e-324

finite = st.floats(allow_nan=False, allow_infinity=False)
# few values, so that collinear, coplanar, cocircular and cospherical cases are common
steps = st.integers(-3, 3).map(float)
magnitudes = [1.0, 1e-300, 1e300, GREATEST, SUBNORMAL]
extremes = st.sampled_from([0.0, *magnitudes, *(-x for x in magnitudes)])


def cases(elements, count=1):
    """Five points of space; a predicate takes the first ones and their first coordinates."""
    return hnp.arrays(np.float64, (count, 5, 3), elements=elements)


def check(points, backends=("numba",)):
    for predicate in PREDICATES:
        taken = points[:, : POINTS[predicate], : DIMENSION[predicate]]
        want = [sign(predicate, case) for case in taken]
        for backend in backends:
            got = getattr(predicates, predicate)(*taken.transpose(1, 0, 2), backend=backend)
            assert got.dtype == np.int8
            assert got.tolist() == want, (predicate, backend)


@given(cases(steps))
def test_lattice(points):
    check(points, ["numba", "jax"])


@given(cases(finite) | cases(extremes) | cases(finite | extremes))
def test_any_finite_floats(points):
    check(points)


# JAX compiles for a number of digits, so all come with a case that needs the most
@settings(max_examples=20)
@given(cases(finite, 7) | cases(extremes, 7))
def test_any_finite_floats_in_jax(points):
    spread = np.array([[[GREATEST, SUBNORMAL, 0.0]] * 5])
    check(np.concatenate([points, spread]), ["jax"])


@given(cases(steps), st.integers(-1074, 1020))
def test_lattices_of_any_scale(points, exponent):
    check(np.ldexp(points, exponent), ["numba", "jax"])


@given(
    cases(steps), st.integers(0, 4), st.integers(0, 2), st.integers(-2, 2), st.sampled_from([0.0, 16.0, 1e6])
)
def test_an_ulp_beside_a_lattice(points, i, axis, ulps, offset):
    moved = points + offset
    for _ in range(abs(ulps)):
        moved[0, i, axis] = np.nextafter(moved[0, i, axis], np.inf * ulps)
    check(moved)


@given(cases(steps), cases(steps), st.integers(0, 1000))
def test_a_lattice_beside_a_much_finer_one(points, finer, exponent):
    check(points + np.ldexp(finer, -exponent) * (points == 0))


@st.composite
def boxes(draw):
    """Corners of a box, cospherical, with edges of up to 52 bits; sometimes one is off by a step."""
    bits = draw(st.integers(1, 52))
    low = draw(hnp.arrays(np.int64, 3, elements=st.integers(-(2**bits), 2**bits)))
    size = draw(hnp.arrays(np.int64, 3, elements=st.integers(1, 2**bits)))
    corners = draw(st.permutations(range(8)))[:5]
    points = low + size * (np.array(corners)[:, None] >> np.arange(3) & 1)
    points[draw(st.integers(0, 4)), draw(st.integers(0, 2))] += draw(st.integers(-1, 1))
    return np.ldexp(points.astype(float), draw(st.integers(-60, 0)))[None]


@given(boxes())
def test_boxes(points):
    check(points)


def test_many_nearly_cospherical_at_once():
    rng = np.random.default_rng(0)
    points = rng.standard_normal((500, 5, 3))
    points /= np.linalg.norm(points, axis=2, keepdims=True)
    check(points)


@pytest.mark.parametrize("backend", ["numba", "jax"])
@pytest.mark.parametrize(
    ("predicate", "file", "convention"),
    [
        ("orient2d", "pred_orient2d_a", 1),
        ("in_circle", "pred_incircle_a", 1),
        # their determinants have rows p_i - p_last, which in space is the opposite sign
        ("orient3d", "pred_orient3d_a", -1),
        ("in_sphere", "pred_insphere_a", -1),
    ],
)
def test_hard_cases(predicate, file, convention, backend, shared_cases):
    cases, want = shared_cases(file)
    got = getattr(predicates, predicate)(*cases.transpose(1, 0, 2), backend=backend)
    np.testing.assert_array_equal(got, convention * want)


@pytest.mark.parametrize("backend", ["numba", "jax"])
def test_shapes_broadcast(backend):
    x, y, z = np.eye(3)
    heights = np.linspace(-1, 1, 6).reshape(2, 3, 1) * z
    got = predicates.orient3d(np.zeros(3), x, y, heights, backend=backend)
    np.testing.assert_array_equal(got, np.sign(heights[..., 2]))
    none = predicates.orient3d(np.zeros((0, 3)), x, y, z, backend=backend)
    assert none.shape == (0,)
    one = predicates.orient2d([0, 0], [1, 0], [0, 1], backend=backend)
    assert one.shape == ()
    assert one == 1


def test_errors():
    a = np.zeros(3)
    with pytest.raises(ValueError, match=r"shape \(..., 3\), got \(2,\)"):
        predicates.orient3d(a[:2], a[:2], a[:2], a[:2])
    with pytest.raises(ValueError, match=r"shape \(..., 2\), got \(3,\)"):
        predicates.in_circle(a, a, a, a)
    for bad in (np.nan, np.inf):
        with pytest.raises(ValueError, match="must be finite, got NaN or infinity"):
            predicates.in_sphere(a, a, a, a, a + bad)
    with pytest.raises(ValueError, match="backend must be one of 'numba', 'jax', got 'cuda'"):
        predicates.orient3d(a, a, a, a, backend="cuda")
    with pytest.raises(AttributeError, match=r"'dt3d.predicates' has no attribute 'orient4d'"):
        predicates.orient4d  # noqa: B018
