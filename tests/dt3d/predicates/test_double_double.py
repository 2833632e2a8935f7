"""Pairs of doubles against rational numbers."""

from fractions import Fraction

import hypothesis.strategies as st
import numpy as np
from hypothesis import given

from dt3d.predicates import double_double

moderate = st.floats(-1e30, 1e30).map(lambda x: x if abs(x) > 1e-30 else 0.0)


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


def test_a_lattice_is_known_by_its_steps():
    steps = np.ldexp(1.0, -7)
    rows = (((3 * steps, 0.0), (-512 * steps, 0.0)),)
    assert double_double.on_lattice(rows, 512 * steps, 10)
    assert not double_double.on_lattice(rows, 512 * steps, 9)
    assert not double_double.on_lattice((((3 * steps, 1e-30), (0.0, 0.0)),), 3 * steps, 20)
