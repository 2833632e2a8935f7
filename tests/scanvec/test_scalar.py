"""Scalars into vectors and out of them: extract, insert, full_like."""

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import scanvec as sv

from .cases import (
    MACHINES,
    assert_same,
    of_dtype,
    words,
)


@given(n=st.integers(1, 70), data=st.data())
def test_extract_and_insert(n, data):
    values = of_dtype(data.draw(words(n)), "float64")
    i = data.draw(st.integers(-n, n - 1))
    want = values.copy()
    want[i] = 0.5
    for machine in MACHINES:
        v = machine.vector(values)
        assert_same(np.array([sv.extract(v, i)]), values[[i]])
        assert_same(sv.insert(v, i, 0.5), want)
        assert_same(v, values)
        pair = sv.insert({"x": v, "y": v < 0}, i, {"x": 0.5, "y": True})
        assert sv.extract(pair, i) == {"x": 0.5, "y": True}


def test_what_the_front_end_touches():
    cm = sv.Simulated(4)
    v = cm.vector(np.arange(8))
    sv.extract(v, 3)
    assert not cm.ledger.entries
    # one element, from the first processor to the last
    sv.insert(v, -1, 9)
    assert cm.ledger.entries == [sv.Entry("", "insert", "send", 8, 2, messages=1, busiest=1, bytes=8)]


@pytest.mark.parametrize("machine", MACHINES, ids=repr)
def test_full_like(machine):
    v = machine.vector([1, 2, 3], np.int16)
    assert_same(sv.full_like(v, 7), np.full(3, 7, np.int16))
    assert_same(sv.full_like((v, v > 1), 0)[1], np.zeros(3, bool))
    assert_same(sv.full_like(v, 0.5, np.float32), np.full(3, 0.5, np.float32))


@pytest.mark.parametrize("machine", [MACHINES[0], MACHINES[3]], ids=repr)
def test_errors(machine):
    v = machine.vector([1, 2, 3])
    with pytest.raises(IndexError, match="index 3 is out of range for a vector of 3 elements"):
        sv.extract(v, 3)
    with pytest.raises(IndexError, match="index -4 is out of range for a vector of 3 elements"):
        sv.insert(v, -4, 0)
    with pytest.raises(ValueError, match="insert: .* cannot go into a record"):
        sv.insert((v, v), 0, 5)
