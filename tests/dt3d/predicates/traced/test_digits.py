"""Integers in digits along the first axis, against Python's."""

from fractions import Fraction

import hypothesis.extra.numpy as hnp
import hypothesis.strategies as st
import jax
import numpy as np
from hypothesis import given

from dt3d.predicates.layout import DIGIT_BITS, HALF_DIGIT
from dt3d.predicates.traced import digits

finite = st.floats(allow_nan=False, allow_infinity=False)


def value(limbs):
    """Python integers of digits along the first axis."""
    return sum(x.astype(object) << (DIGIT_BITS * i) for i, x in enumerate(limbs))


@given(hnp.arrays(np.float64, (3, 2), elements=finite))
def test_limbs_are_the_points_in_one_unit(points):
    limbs = digits.limbs_of(points)
    assert limbs.dtype == np.int32
    assert limbs.shape[1:] == points.shape
    assert np.abs(limbs.astype(int)).max() <= HALF_DIGIT
    got = value(limbs).ravel()
    want = [Fraction(x) for x in points.ravel().tolist()]
    units = {w / g for g, w in zip(got, want, strict=True) if g or w}
    assert len(units) <= 1  # and none was divided by zero
    assert len(limbs) in digits.LENGTHS
    if len(limbs) > 1:  # fewer would not do
        room = digits.LENGTHS[digits.LENGTHS.index(len(limbs)) - 1]
        assert max(abs(g) for g in got) >= 1 << (DIGIT_BITS * room - 1)
        assert any(g % 2 for g in got)


def test_how_many_limbs():
    rng = np.random.default_rng(0)
    assert len(digits.limbs_of(rng.integers(-99, 99, (50, 3)) * 2.0**-700)) == 1
    assert len(digits.limbs_of(rng.random((1000, 3)))) == 2
    assert len(digits.limbs_of(rng.standard_normal((1000, 3)))) in (3, 4)
    assert len(digits.limbs_of([[5e-324, 1.7e308]])) == digits.LENGTHS[-1]
    assert digits.limbs_of(np.zeros((4, 3))).shape == (1, 4, 3)


# few lengths, since JAX compiles for each; the longest is multiplied in a loop
numbers = hnp.arrays(
    np.int64, st.tuples(st.sampled_from([1, 3, 12]), st.just(4)), elements=st.integers(-(2**27), 2**27)
)


@given(numbers, numbers)
def test_products_carries_and_signs(a, b):
    with jax.enable_x64(True):
        product = digits.product(a, b)
        carried = digits.carry(3 * product)
        signs = digits.sign(carried)
    assert value(np.asarray(product)).tolist() == (value(a) * value(b)).tolist()
    assert value(np.asarray(carried)).tolist() == (3 * value(a) * value(b)).tolist()
    assert np.abs(np.asarray(carried)[:-1]).max() <= HALF_DIGIT + 2**10
    assert signs.tolist() == [(x > 0) - (x < 0) for x in value(a) * value(b)]
