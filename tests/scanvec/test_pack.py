"""Vectors of other lengths: pack, split, append, distribute."""

from typing import NamedTuple

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import scanvec as sv

from . import twins
from .cases import (
    MACHINES,
    assert_same,
    lengths_of_segments,
    of_dtype,
    sizes,
    words,
)


@given(n=sizes, data=st.data())
def test_pack_and_pack_index(n, data):
    raw, flags = data.draw(words(n)), of_dtype(data.draw(words(n)), "bool")
    values = of_dtype(raw, "int32")
    for machine in MACHINES:
        where = machine.vector(flags)
        assert_same(sv.pack(machine.vector(values), where), values[flags])
        assert_same(sv.pack_index(where), np.flatnonzero(flags).astype(np.int32))


@given(n=sizes, data=st.data())
def test_split(n, data):
    values, flags = of_dtype(data.draw(words(n)), "int32"), of_dtype(data.draw(words(n)), "bool")
    want = np.concatenate([values[~flags], values[flags]])
    for machine in MACHINES:
        assert_same(sv.split(machine.vector(values), machine.vector(flags)), want)


@given(lengths=lengths_of_segments, data=st.data())
def test_split_by_segments(lengths, data):
    values = of_dtype(data.draw(words(sum(lengths))), "int32")
    flags = of_dtype(data.draw(words(sum(lengths))), "bool")
    want = twins.split(values, flags, lengths)
    for machine in MACHINES:
        segments = sv.Segments.from_lengths(machine.vector(lengths, np.int32))
        assert_same(sv.split(machine.vector(values), machine.vector(flags), segments), want)


@given(n=sizes, m=sizes, data=st.data())
def test_append(n, m, data):
    first, second = of_dtype(data.draw(words(n)), "int32"), of_dtype(data.draw(words(m)), "int32")
    for machine in MACHINES:
        got = sv.append(machine.vector(first), machine.vector(second))
        assert_same(got, np.concatenate([first, second]))


@given(counts=st.lists(st.integers(0, 6), max_size=12), data=st.data())
def test_distribute(counts, data):
    values = of_dtype(data.draw(words(len(counts))), "int64")
    for machine in MACHINES:
        copies, segments = sv.distribute(machine.vector(values), machine.vector(counts, np.int8))
        assert_same(copies, np.repeat(values, counts))
        assert_same(segments.ids, twins.ids_of(counts))
        assert_same(segments.lengths, np.array(counts, np.int32))


@pytest.mark.parametrize("machine", [MACHINES[0], MACHINES[3]], ids=repr)
def test_a_split_by_segments_of_another_length(machine):
    v, segments = machine.vector([1, 2, 3]), sv.Segments.from_lengths(machine.vector([2]))
    with pytest.raises(ValueError, match="the segments describe 2 elements, the vector has 3"):
        sv.split(v, v > 1, segments)


class Particle(NamedTuple):
    mass: sv.Vector
    spin: dict


@pytest.mark.parametrize("machine", [MACHINES[0], MACHINES[3]], ids=repr)
def test_records_keep_their_structure(machine):
    record = Particle(machine.vector([1.5, 2.5, 3.5]), {"up": machine.vector([True, False, True])})
    flags = machine.vector([False, True, True])
    backward = machine.vector([2, 1, 0])
    copies, _ = sv.distribute(record, machine.vector([1, 0, 2]))
    for got, order in [
        (sv.permute(record, backward), [2, 1, 0]),
        (sv.get(record, backward), [2, 1, 0]),
        (sv.pack(record, flags), [1, 2]),
        (sv.split(record, flags), [0, 1, 2]),
        (sv.append(record, record), [0, 1, 2, 0, 1, 2]),
        (sv.copy_scan(record), [0, 0, 0]),
        (copies, [0, 2, 2]),
        (sv.send(record, backward, sv.COPY, into=record), [2, 1, 0]),
    ]:
        assert isinstance(got, Particle)
        assert_same(got.mass, np.array([1.5, 2.5, 3.5])[order])
        assert_same(got.spin["up"], np.array([True, False, True])[order])
