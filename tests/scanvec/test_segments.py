"""The three descriptions of segments agree, with empty and one-element segments."""

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import scanvec as sv

from . import twins
from .cases import INTEGERS, MACHINES, assert_same, lengths_of_segments, of_dtype, sizes, words


def assert_describes(segments: sv.Segments, lengths: list[int]) -> None:
    """All attributes are those of segments with these lengths."""
    starts = [sum(lengths[:j]) for j in range(len(lengths))]
    offsets = [i for length in lengths for i in range(length)]
    assert segments.count == len(lengths)
    assert_same(segments.lengths, np.array(lengths, np.int32))
    assert_same(segments.starts, np.array(starts, np.int32))
    assert_same(segments.heads, twins.heads_of(lengths))
    assert_same(segments.ids, twins.ids_of(lengths))
    assert_same(segments.offsets, np.array(offsets, np.int32))


@given(lengths=lengths_of_segments)
def test_from_lengths(lengths):
    for machine in MACHINES:
        segments = sv.Segments.from_lengths(machine.vector(lengths, np.int32))
        assert segments.machine is machine
        assert_describes(segments, lengths)


@pytest.mark.parametrize("dtype", INTEGERS)
def test_lengths_of_every_integer_dtype(dtype):
    lengths = np.array([100, 0, 127, 1], dtype)
    assert_describes(sv.Segments.from_lengths(MACHINES[2].vector(lengths)), lengths.astype(int).tolist())


@given(n=sizes, data=st.data())
def test_from_flags(n, data):
    flags = of_dtype(data.draw(words(n)), "bool")
    heads = flags | (np.arange(n) == 0)  # the first element begins a segment in any case
    lengths = np.diff([*np.flatnonzero(heads), n]).tolist() if n else []
    for machine in MACHINES:
        assert_describes(sv.Segments.from_flags(machine.vector(flags)), lengths)


@pytest.mark.parametrize("dtype", ["int32", "bool", "float64"])
@given(n=sizes, data=st.data())
def test_from_ids(dtype, n, data):
    ids = of_dtype(data.draw(words(n)) % 3, dtype)
    lengths, before = [], None
    for x in ids:
        if x != before:
            lengths.append(0)
        lengths[-1] += 1
        before = x
    for machine in MACHINES[1::2]:
        assert_describes(sv.Segments.from_ids(machine.vector(ids)), lengths)


def test_segments_that_are_all_empty():
    for machine in MACHINES:
        assert_describes(sv.Segments.from_lengths(machine.vector([0, 0, 0])), [0, 0, 0])


@pytest.mark.parametrize("dtype", ["int64", "uint64"])
def test_a_total_that_is_too_great_is_seen(dtype):
    # 2^62 four times is 0 in 64 bits
    lengths = MACHINES[3].vector(np.array([2**62] * 4, dtype))
    with pytest.raises(ValueError, match="hold 8589934592 elements or more; a vector takes at most"):
        sv.Segments.from_lengths(lengths)
    with pytest.raises(ValueError, match="hold 2147483648 elements or more"):
        sv.Segments.from_lengths(MACHINES[3].vector(np.array([2**31 - 1, 1], dtype)))
