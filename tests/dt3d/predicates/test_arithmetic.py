"""What the predicates compute with, against rational numbers: digits, pairs of doubles, the exact stage."""

from fractions import Fraction

import hypothesis.extra.numpy as hnp
import hypothesis.strategies as st
import jax
import numpy as np
from hypothesis import given

from dt3d.predicates import double_double, exact, integers, scaled, work_array
from dt3d.predicates.work import SLACK

from .oracle import DIMENSION, POINTS, sign

finite = st.floats(allow_nan=False, allow_infinity=False)
moderate = st.floats(-1e30, 1e30).map(lambda x: x if abs(x) > 1e-30 else 0.0)


def value(digits):
    """Python integers of digits along the first axis."""
    return sum(x.astype(object) << (integers.BITS * i) for i, x in enumerate(digits))


@given(hnp.arrays(np.float64, (3, 2), elements=finite))
def test_limbs_are_the_points_in_one_unit(points):
    digits = integers.limbs_of(points)
    assert digits.dtype == np.int32
    assert digits.shape[1:] == points.shape
    assert np.abs(digits.astype(int)).max() <= integers.HALF
    got = value(digits).ravel()
    want = [Fraction(x) for x in points.ravel().tolist()]
    units = {w / g for g, w in zip(got, want, strict=True) if g or w}
    assert len(units) <= 1  # and none was divided by zero
    assert len(digits) in integers.LENGTHS
    if len(digits) > 1:  # fewer would not do
        room = integers.LENGTHS[integers.LENGTHS.index(len(digits)) - 1]
        assert max(abs(g) for g in got) >= 1 << (integers.BITS * room - 1)
        assert any(g % 2 for g in got)


def test_how_many_limbs():
    rng = np.random.default_rng(0)
    assert len(integers.limbs_of(rng.integers(-99, 99, (50, 3)) * 2.0**-700)) == 1
    assert len(integers.limbs_of(rng.random((1000, 3)))) == 2
    assert len(integers.limbs_of(rng.standard_normal((1000, 3)))) in (3, 4)
    assert len(integers.limbs_of([[5e-324, 1.7e308]])) == integers.LENGTHS[-1]
    assert integers.limbs_of(np.zeros((4, 3))).shape == (1, 4, 3)


# few lengths, since JAX compiles for each; the longest is multiplied in a loop
numbers = hnp.arrays(
    np.int64, st.tuples(st.sampled_from([1, 3, 12]), st.just(4)), elements=st.integers(-(2**27), 2**27)
)


@given(numbers, numbers)
def test_products_carries_and_signs(a, b):
    with jax.enable_x64(True):
        product = integers.product(a, b)
        carried = integers.carry(3 * product)
        signs = integers.sign(carried)
    assert value(np.asarray(product)).tolist() == (value(a) * value(b)).tolist()
    assert value(np.asarray(carried)).tolist() == (3 * value(a) * value(b)).tolist()
    assert np.abs(np.asarray(carried)[:-1]).max() <= integers.HALF + 2**10
    assert signs.tolist() == [(x > 0) - (x < 0) for x in value(a) * value(b)]


def fraction(pair):
    return Fraction(float(pair[0])) + Fraction(float(pair[1]))


@given(moderate, moderate, moderate, moderate)
def test_pairs_of_doubles(a, b, c, d):
    x, y = double_double.two_sum(a, b), double_double.two_product(c, d)
    assert fraction(x) == Fraction(a) + Fraction(b)
    assert fraction(y) == Fraction(c) * Fraction(d)
    u = Fraction(1, 2**53)
    total, product = fraction(x) + fraction(y), fraction(x) * fraction(y)
    assert abs(fraction(double_double.add(x, y)) - total) <= (3 * u**2 + 13 * u**3) * abs(total)
    assert abs(fraction(double_double.subtract(x, y)) - (fraction(x) - fraction(y))) <= 4 * u**2 * abs(
        fraction(x) - fraction(y)
    )
    assert abs(fraction(double_double.multiply(x, y)) - product) <= 5 * u**2 * abs(product)


@given(hnp.arrays(np.float64, (5, 3), elements=finite | st.integers(-3, 3).map(float)))
def test_the_exact_stage_alone(points):
    for predicate, k in POINTS.items():
        case = np.ascontiguousarray(points[:k, : DIMENSION[predicate]])
        got = getattr(exact, f"{predicate}_exact")(case, *range(k), work_array(case))
        assert got == sign(predicate, case)


@given(hnp.arrays(np.float64, (3, 3), elements=finite))
def test_scaling_loses_nothing(points):
    got = scaled(points)
    greatest = np.abs(points).max()
    if greatest > 0 and np.abs(points[points != 0]).min() >= greatest * 2.0**-1020:
        assert 0.5 <= np.abs(got).max() < 1
    assert (got != 0).sum() == (points != 0).sum()
    ratios = {Fraction(a) / Fraction(b) for a, b in zip(got.ravel(), points.ravel(), strict=True) if b}
    assert len(ratios) <= 1


def test_nothing_is_decided_in_floating_point_that_could_overflow():
    assert work_array(np.array([[1e300, 1.0]]))[SLACK] == np.inf
    assert work_array(np.array([[0.5, -1.0]]))[SLACK] == 2.0**-1000
    assert 2.0**-1000 < work_array(np.array([[0.5, -1e6]]))[SLACK] < 2.0**-890
