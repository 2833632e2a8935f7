"""The arithmetic of expansions against rational numbers."""

from fractions import Fraction

import hypothesis.strategies as st
import numpy as np
from hypothesis import given

from dt3d.predicates import expansions, work_array

doubles = st.floats(-1e30, 1e30).map(lambda x: x if abs(x) > 1e-30 else 0.0)


def value(w, at, n):
    return sum((Fraction(x) for x in w[at : at + n].tolist()), Fraction(0))


def is_expansion(w, at, n):
    """Components ascend in magnitude, and none is zero."""
    parts = np.abs(w[at : at + n])
    return (parts > 0).all() and (np.diff(parts) > 0).all()


@given(doubles, doubles)
def test_sums_and_products_of_two(a, b):
    s, r = expansions.two_sum(a, b)
    assert Fraction(s) + Fraction(r) == Fraction(a) + Fraction(b)
    assert s == a + b
    p, r = expansions.two_product(a, b)
    assert Fraction(p) + Fraction(r) == Fraction(a) * Fraction(b)
    assert p == a * b


@given(st.lists(doubles, min_size=4, max_size=4), doubles)
def test_operations(numbers, factor):
    a, b, c, d = numbers
    w = work_array()
    n = expansions.difference(w, 0, a, b)
    m = expansions.difference(w, 10, c, d)
    e, f = Fraction(a) - Fraction(b), Fraction(c) - Fraction(d)
    assert value(w, 0, n) == e
    k = expansions.add(w, 0, n, 10, m, 20)
    assert value(w, 20, k) == e + f
    assert is_expansion(w, 20, k)
    k = expansions.scale(w, 0, n, factor, 20)
    assert value(w, 20, k) == e * Fraction(factor)
    assert is_expansion(w, 20, k)
    k = expansions.multiply(w, 0, n, 10, m, 20)
    assert value(w, 20, k) == e * f
    assert is_expansion(w, 20, k)
    expansions.negate(w, 20, k)
    assert value(w, 20, k) == -e * f
