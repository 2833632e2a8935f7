"""Operations of Blelloch's book: where, flag_merge, op_distribute, splits by segments, extract, insert."""

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import scanvec as sv

from . import twins
from .cases import MACHINES, assert_same, assert_same_bits, lengths_of_segments, load, of_dtype, sizes, words

DISTRIBUTED = [(sv.ADD, "int32"), (sv.ADD, "bool"), (sv.MAX, "float32"), (sv.AND, "uint16"), (sv.OR, "bool"),
               (sv.COPY, "int64")]  # fmt: skip


@given(n=sizes, data=st.data())
def test_where(n, data):
    flags = of_dtype(data.draw(words(n)), "bool")
    pair = [{"a": of_dtype(data.draw(words(n)), "int16"), "b": of_dtype(data.draw(words(n)), "float64")}
            for _ in range(2)]  # fmt: skip
    for machine in MACHINES:
        got = sv.where(machine.vector(flags), *(load(machine, record) for record in pair))
        for key in "ab":
            assert_same(got[key], twins.select(flags, pair[0][key], pair[1][key]))


@pytest.mark.parametrize("machine", MACHINES, ids=repr)
def test_where_takes_scalars(machine):
    flags, v = machine.vector([True, False, True]), machine.vector([4, 5, 6], np.int16)
    assert_same(sv.where(flags, v, 0), np.array([4, 0, 6], np.int16))
    assert_same(sv.where(flags, -1, v), np.array([-1, 5, -1], np.int16))
    assert_same(sv.where(flags, 0, 1), np.array([0, 1, 0]))
    assert_same(sv.where(flags, {"a": v}, 0)["a"], np.array([4, 0, 6], np.int16))
    assert_same(sv.where(flags, 7, (v, v > 5))[0], np.array([7, 5, 7], np.int16))
    with pytest.raises(ValueError, match="vectors have different lengths: 3 and 2"):
        sv.where(flags, machine.iota(2), 0)


@given(n=sizes, data=st.data())
def test_flag_merge(n, data):
    flags = of_dtype(data.draw(words(n)), "bool")
    first = of_dtype(data.draw(words(int((~flags).sum()))), "int32")
    second = of_dtype(data.draw(words(int(flags.sum()))), "int32")
    for machine in MACHINES:
        got = sv.flag_merge(machine.vector(first), machine.vector(second), machine.vector(flags))
        assert_same_bits(got, twins.flag_merge(first, second, flags))


@given(n=sizes, data=st.data())
def test_flag_merge_undoes_a_split(n, data):
    values, flags = of_dtype(data.draw(words(n)), "int64"), of_dtype(data.draw(words(n)), "bool")
    for machine in (MACHINES[0], MACHINES[2]):
        v, f = machine.vector(values), machine.vector(flags)
        assert_same(sv.flag_merge(sv.pack(v, ~f), sv.pack(v, f), f), values)


@pytest.mark.parametrize(("op", "dtype"), DISTRIBUTED, ids=lambda x: getattr(x, "name", x))
@given(lengths=lengths_of_segments, data=st.data())
def test_op_distribute(op, dtype, lengths, data):
    values = of_dtype(data.draw(words(sum(lengths))), dtype)
    ids = twins.ids_of(lengths)
    for machine in (MACHINES[0], MACHINES[1 + DISTRIBUTED.index((op, dtype)) % 4]):
        v = machine.vector(values)
        segments = sv.Segments.from_lengths(machine.vector(lengths, np.int32))
        assert_same(sv.op_distribute(v, op), twins.distribute_array(op, values, 0 * ids))
        assert_same(sv.op_distribute(v, op, segments), twins.distribute_array(op, values, ids))


@given(lengths=lengths_of_segments, data=st.data())
def test_split_by_segments(lengths, data):
    values = of_dtype(data.draw(words(sum(lengths))), "int32")
    flags = of_dtype(data.draw(words(sum(lengths))), "bool")
    want = twins.split(values, flags, lengths)
    for machine in MACHINES:
        segments = sv.Segments.from_lengths(machine.vector(lengths, np.int32))
        assert_same(sv.split(machine.vector(values), machine.vector(flags), segments), want)


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


@pytest.mark.parametrize("machine", [MACHINES[0], MACHINES[3]], ids=repr)
def test_errors(machine):
    v, flags = machine.vector([1, 2, 3]), machine.vector([True, False, True])
    with pytest.raises(IndexError, match="index 3 is out of range for a vector of 3 elements"):
        sv.extract(v, 3)
    with pytest.raises(IndexError, match="index -4 is out of range for a vector of 3 elements"):
        sv.insert(v, -4, 0)
    with pytest.raises(ValueError, match="insert: .* cannot go into a record"):
        sv.insert((v, v), 0, 5)
    with pytest.raises(ValueError, match="1 flags are clear and 2 set, but there are 3 and 3 elements"):
        sv.flag_merge(v, v, flags)
    with pytest.raises(ValueError, match="flag_merge: the two records have different structures"):
        sv.flag_merge(v, (v,), flags)
    with pytest.raises(ValueError, match="where: .* different dtypes; convert with astype"):
        sv.where(flags, v, v.astype(float))
    with pytest.raises(TypeError, match="where: the flags must be a Vector of bool, got int64"):
        sv.where(v, v, v)
    segments = sv.Segments.from_lengths(machine.vector([2]))
    with pytest.raises(ValueError, match="the segments describe 2 elements, the vector has 3"):
        sv.split(v, flags, segments)
