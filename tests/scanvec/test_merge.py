"""Two records into one by flags, where and flag_merge, against their serial twins."""

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import scanvec as sv

from . import twins
from .cases import (
    MACHINES,
    assert_same,
    assert_same_bits,
    load,
    of_dtype,
    sizes,
    words,
)


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


@pytest.mark.parametrize("machine", [MACHINES[0], MACHINES[3]], ids=repr)
def test_errors(machine):
    v, flags = machine.vector([1, 2, 3]), machine.vector([True, False, True])
    with pytest.raises(ValueError, match="1 flags are clear and 2 set, but there are 3 and 3 elements"):
        sv.flag_merge(v, v, flags)
    with pytest.raises(ValueError, match="flag_merge: the two records have different structures"):
        sv.flag_merge(v, (v,), flags)
    with pytest.raises(ValueError, match="where: .* different dtypes; convert with astype"):
        sv.where(flags, v, v.astype(float))
    with pytest.raises(TypeError, match="where: the flags must be a Vector of bool, got int64"):
        sv.where(v, v, v)
