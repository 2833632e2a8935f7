"""Sums and products of floats: within the rounding bound of the exact result, whatever the machine.

Machines add in different orders, so the last bits may differ. For any order, the sum of m terms lies within
gamma(m - 1) * (|x[0]| + ... + |x[m-1]|) of the exact one, and a product within gamma(m - 1) of it relatively;
gamma(k) = k u / (1 - k u) and u is half an ulp of 1 (Higham 2002, sections 3.1 and 4.2).
"""

from fractions import Fraction
from itertools import accumulate
from operator import mul

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import scanvec as sv

from . import twins
from .cases import FLOATS, MACHINES, lengths_of_segments, load


def gamma(k: int, dtype: str) -> Fraction:
    u = Fraction(float(np.finfo(dtype).eps)) / 2
    return k * u / (1 - k * u)


def fractions(dtype: str, n: int) -> st.SearchStrategy[np.ndarray]:
    """Floats of dtype in -16 .. 16 with enough bits that sums round, none so small that a sum underflows."""
    whole = 2 ** np.finfo(dtype).nmant
    numbers = st.integers(-whole, whole).map(lambda i: i * 16.0 / whole)
    return st.lists(numbers, min_size=n, max_size=n).map(lambda xs: np.array(xs, dtype))


@given(lengths=lengths_of_segments, data=st.data())
def test_sums(lengths, data):
    n = sum(lengths)
    record = {dtype: data.draw(fractions(dtype, n)) for dtype in FLOATS}
    heads = twins.heads_of(lengths)
    ids = twins.ids_of(lengths)
    for machine in MACHINES[::2]:
        loaded = load(machine, record)
        segments = sv.Segments.from_lengths(machine.vector(lengths, np.int32))
        plain = sv.scan_inclusive(loaded, sv.ADD)
        segmented = sv.scan_inclusive(loaded, sv.ADD, segments)
        totals = sv.reduce(loaded, sv.ADD, segments)
        for dtype in FLOATS:
            assert plain[dtype].dtype == segmented[dtype].dtype == dtype
            exact = [Fraction(float(x)) for x in record[dtype]]
            _check_sums(plain[dtype].to_numpy(), exact, [i == 0 for i in range(n)], dtype)
            _check_sums(segmented[dtype].to_numpy(), exact, heads, dtype)
            # a reduction is the last of these sums
            for j, length in enumerate(lengths):
                last = segmented[dtype].to_numpy()[ids == j][-1:]
                assert totals[dtype].to_numpy()[j] == (last[0] if length else 0)


def _check_sums(got, exact, heads, dtype):
    total = size = Fraction(0)
    terms = 0
    for i, x in enumerate(exact):
        if heads[i]:
            total = size = Fraction(0)
            terms = 0
        total, size, terms = total + x, size + abs(x), terms + 1
        assert abs(Fraction(float(got[i])) - total) <= gamma(terms - 1, dtype) * size


@pytest.mark.parametrize("dtype", FLOATS)
@given(data=st.data())
def test_products(dtype, data):
    # factors in 1/2 .. 2, so few that no product overflows or underflows
    factors = st.integers(-1000, 1000).map(lambda k: 0.5 + k / 750 if k >= 0 else k / 750 - 0.5)
    values = np.array(data.draw(st.lists(factors, max_size=12)), dtype)
    exact = list(accumulate((Fraction(float(x)) for x in values), mul))
    for machine in MACHINES:
        got = sv.scan_inclusive(machine.vector(values), sv.MUL)
        assert got.dtype == dtype
        for i, x in enumerate(got.to_numpy()):
            assert abs(Fraction(float(x)) - exact[i]) <= gamma(i, dtype) * abs(exact[i])


@pytest.mark.parametrize("machine", MACHINES, ids=repr)
def test_a_long_sum_of_floats(machine):
    values = np.random.default_rng(7).normal(size=5000)
    got = sv.reduce(machine.vector(values), sv.ADD)
    exact = sum(map(Fraction, values.tolist()))
    bound = gamma(len(values) - 1, "float64") * sum(map(Fraction, np.abs(values).tolist()))
    assert abs(Fraction(float(got)) - exact) <= bound
