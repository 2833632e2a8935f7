"""Sorting and sets against Python's stable sort: every dtype, ties, records, NaN and signed zeros."""

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings

import scanvec as sv

from . import twins
from .cases import (
    DTYPES,
    MACHINES,
    assert_same,
    assert_same_bits,
    lengths_of_segments,
    of_dtype,
    sizes,
    words,
)

# Ties everywhere, and few bits in which keys differ: a split costs more than an example.
small_keys = sizes.flatmap(lambda n: st.lists(st.integers(-9, 9), min_size=n, max_size=n))


@pytest.mark.parametrize("dtype", DTYPES)
@settings(max_examples=5)
@given(raw=words(st.integers(0, 20)))
def test_every_dtype(dtype, raw):
    keys = of_dtype(raw, dtype)
    order = twins.sorted_order([keys])
    # by turns on the simulated machines
    for machine in (MACHINES[0], MACHINES[1 + DTYPES.index(dtype) % 4]):
        got = sv.sort(machine.vector(keys))
        assert_same_bits(got, keys[order])
        assert_same(got, np.sort(keys))


@given(keys=small_keys)
def test_rank_and_payload_are_stable(keys):
    keys = np.array(keys, np.int8)
    order = np.array(twins.sorted_order([keys]), np.int32)
    ranks = np.empty_like(order)
    ranks[order] = np.arange(len(order))
    for machine in MACHINES:
        v = machine.vector(keys)
        assert_same(sv.rank(v), ranks)
        ordered, payload = sv.sort(v, machine.iota(len(keys)))
        assert_same(ordered, keys[order])
        assert_same(payload, order)


@settings(max_examples=10)
@given(first=small_keys, data=st.data())
def test_records_compare_their_first_vector_first(first, data):
    first = np.array(first, np.int8)
    second = of_dtype(data.draw(words(len(first))), "bool")
    order = twins.sorted_order([first, second])
    for machine in MACHINES[:3]:
        got = sv.sort((machine.vector(first), machine.vector(second)))
        assert_same(got[0], first[order])
        assert_same(got[1], second[order])


@pytest.mark.parametrize("dtype", ["float16", "float32", "float64"])
@pytest.mark.parametrize("machine", [MACHINES[0], MACHINES[2]], ids=repr)
def test_special_floats(machine, dtype):
    info = np.finfo(dtype)
    nan = np.array([np.nan, -np.nan], dtype)  # of either sign
    least = np.nextafter(np.array(0, dtype), np.array(1, dtype))  # subnormal
    keys = [nan[1], 0.0, -least, np.inf, -0.0, info.max, nan[0], least, info.min, -np.inf, info.tiny, 0.0]
    keys = np.array(keys, dtype)
    got = sv.sort(machine.vector(keys))
    assert_same_bits(got, keys[twins.sorted_order([keys])])  # the zeros keep their order, as do the NaNs
    assert_same(sv.unique(machine.vector(keys)), keys[[9, 8, 2, 1, 7, 10, 5, 3, 0]])


@given(lengths=lengths_of_segments, data=st.data())
@settings(max_examples=10)
def test_segmented_sort(lengths, data):
    keys = of_dtype(data.draw(words(sum(lengths))) % 16, "uint8")
    order = twins.sorted_order([twins.ids_of(lengths), keys])
    for machine in MACHINES[::2]:
        segments = sv.Segments.from_lengths(machine.vector(lengths, np.int32))
        v = machine.vector(keys)
        assert_same(sv.segmented_sort(v, segments), keys[order])
        ordered, payload = sv.segmented_sort(v, segments, machine.iota(len(keys)))
        assert_same(ordered, keys[order])
        assert_same(payload, np.array(order, np.int32))


@given(first=small_keys, second=small_keys)
@settings(max_examples=10)
def test_unique_and_union(first, second):
    first, second = np.array(first, np.int8), np.array(second, np.int8)
    for machine in MACHINES:
        a, b = machine.vector(first), machine.vector(second)
        assert_same(sv.unique(a), np.unique(first))
        assert_same(sv.union(a, b), np.union1d(first, second))


def test_unique_rows_of_a_record():
    x, y = np.array([2, 1, 2, 1, 2], np.int16), np.array([0.5, 0.5, -0.5, 0.5, 0.5])
    for machine in (MACHINES[0], MACHINES[3]):
        rows = sv.unique({"x": machine.vector(x), "y": machine.vector(y)})
        assert_same(rows["x"], np.array([1, 2, 2], np.int16))
        assert_same(rows["y"], np.array([0.5, -0.5, 0.5]))


def test_a_sort_longer_than_the_smallest_block():
    keys = np.random.default_rng(5).integers(0, 16, 5000, dtype=np.uint8)
    for machine in (MACHINES[0], MACHINES[4]):
        assert_same(sv.sort(machine.vector(keys)), np.sort(keys))
