"""Reductions, whole and by segment, against the serial twin; and ARGMIN, which reduces a record."""

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import scanvec as sv

from . import twins
from .cases import MACHINES, assert_same, lengths_of_segments, load, of_dtype, words

CASES = [(sv.ADD, "int32"), (sv.ADD, "bool"), (sv.MUL, "uint8"), (sv.MIN, "float32"), (sv.MAX, "int64"),
         (sv.AND, "uint16"), (sv.OR, "bool"), (sv.COPY, "float64")]  # fmt: skip


@pytest.mark.parametrize(("op", "dtype"), CASES, ids=lambda x: getattr(x, "name", x))
@given(lengths=lengths_of_segments, data=st.data())
def test_reduce(op, dtype, lengths, data):
    values = of_dtype(data.draw(words(sum(lengths))), dtype)
    whole = twins.reduce_array(op, values)
    ids = twins.ids_of(lengths)
    parts = [twins.reduce_array(op, values[ids == j]) for j in range(len(lengths))]
    for machine in (MACHINES[0], MACHINES[1 + CASES.index((op, dtype)) % 4]):
        v = machine.vector(values)
        segments = sv.Segments.from_lengths(machine.vector(lengths, np.int32))
        assert_same(np.asarray([sv.reduce(v, op)]), np.array([whole]))
        assert_same(sv.reduce(v, op, segments), np.array(parts, np.asarray(whole).dtype))


@pytest.mark.parametrize("machine", MACHINES, ids=repr)
@pytest.mark.parametrize("key", ["bool", "int8", "uint64", "float32"])
def test_reduce_of_nothing_is_the_identity(machine, key):
    empty = machine.vector(np.zeros(0, key))
    nothing = sv.Segments.from_lengths(machine.vector(np.zeros(3, np.int32)))
    greatest = twins.OPERATORS[sv.MIN][1](np.dtype(key))
    assert sv.reduce(empty, sv.MIN) == greatest
    assert_same(sv.reduce(empty, sv.MIN, nothing), np.array([greatest] * 3))
    pair = sv.reduce((empty, empty), sv.ARGMIN)
    assert pair == (greatest, np.dtype(key).type(0))


@given(lengths=lengths_of_segments, data=st.data())
def test_argmin_takes_the_leftmost_of_the_least(lengths, data):
    n = sum(lengths)
    # few values, so that there are ties; NaN is least, as it is to minimum, and inf ties with the identity
    drawn = st.lists(st.sampled_from([np.nan, -1, 0, 1, np.inf]), min_size=n, max_size=n)
    keys = np.array(data.draw(drawn), np.float32)
    payload = np.arange(100, 100 + n, dtype=np.int32)
    order = [(not np.isnan(k), 0 if np.isnan(k) else k, i) for i, k in enumerate(keys)]
    heads = twins.heads_of(lengths)
    whole = twins.scan(order, min, None, inclusive=True, backward=False)
    parts = twins.scan(order, min, None, heads, inclusive=False, backward=False)
    # from the right, the first that is met is the rightmost of the least
    mirrored = [(*row[:2], -row[2]) for row in order]
    backward = twins.scan(mirrored, min, None, heads, inclusive=True, backward=True)
    for machine in (MACHINES[0], MACHINES[2]):
        segments = sv.Segments.from_lengths(machine.vector(lengths, np.int32))
        pair = load(machine, (keys, payload))
        assert_same(sv.scan_inclusive(pair, sv.ARGMIN)[1], payload[[row[2] for row in whole]])
        assert_same(
            sv.backscan_inclusive(pair, sv.ARGMIN, segments)[1], payload[[-row[2] for row in backward]]
        )
        got = sv.scan(pair, sv.ARGMIN, segments)
        want = [(np.inf, 0) if row is None else (keys[row[2]], payload[row[2]]) for row in parts]
        assert_same(got[0], np.array([row[0] for row in want], np.float32))
        assert_same(got[1], np.array([row[1] for row in want], np.int32))


@pytest.mark.parametrize("key", ["bool", "int64", "uint8", "float16", "float64"])
def test_argmin_of_keys_that_equal_the_identity(key):
    greatest = twins.OPERATORS[sv.MIN][1](np.dtype(key))
    for machine in (MACHINES[0], MACHINES[2]):
        keys = machine.vector(np.array([greatest] * 5))
        payload = {"row": machine.vector(np.arange(7, 12, dtype=np.int16))}
        assert sv.reduce((keys, payload), sv.ARGMIN) == (greatest, {"row": 7})
