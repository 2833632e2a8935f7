"""Moving by indices, get, send, scatter and permute, against their serial twins."""

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given

import scanvec as sv

from . import twins
from .cases import (
    DTYPES,
    INTEGERS,
    MACHINES,
    assert_same,
    assert_same_bits,
    load,
    of_dtype,
    of_dtypes,
    sizes,
    words,
)

EXACT = ("bool", *INTEGERS)


COMBINERS = [(sv.ADD, INTEGERS), (sv.MUL, INTEGERS), (sv.MIN, DTYPES), (sv.MAX, DTYPES), (sv.AND, EXACT),
             (sv.OR, EXACT), (sv.COPY, DTYPES)]  # fmt: skip


permutations = sizes.flatmap(lambda n: st.permutations(range(n)))


@st.composite
def moves(draw, most=70):
    """How many elements on either side, an index for each on the moving side, and its context."""
    n = draw(st.integers(0, most))
    m = draw(st.integers(0, most)) if n else 0
    index = draw(st.lists(st.integers(0, max(n - 1, 0)), min_size=m, max_size=m))
    where = draw(st.lists(st.booleans(), min_size=m, max_size=m))
    return n, index, where


@given(move=moves(), data=st.data())
def test_get_of_every_dtype(move, data):
    n, index, where = move
    raw = data.draw(words(n))
    record = {dtype: raw.astype(f"uint{8 * np.dtype(dtype).itemsize}").view(dtype) for dtype in DTYPES[1:]}
    record["bool"] = of_dtype(raw, "bool")
    for machine in (MACHINES[0], MACHINES[2]):
        i, context = machine.vector(index, np.int32), machine.vector(where, bool)
        got = sv.get(load(machine, record), i, where=context, otherwise=0)
        for dtype, values in record.items():
            assert_same_bits(got[dtype], twins.get(values, index, where, 0))


@given(move=moves(), data=st.data())
def test_get_on_every_machine(move, data):
    n, index, where = move
    values = of_dtype(data.draw(words(n)), "int64")
    everywhere = [True] * len(index)
    for machine in MACHINES:
        v, i = machine.vector(values), machine.vector(index, np.int32)
        assert_same(sv.get(v, i), twins.get(values, index, everywhere, 0))
        got = sv.get(v, i, where=machine.vector(where, bool), otherwise=-5)
        assert_same(got, twins.get(values, index, where, -5))


@pytest.mark.parametrize("dtype", INTEGERS)
def test_indices_of_every_integer_dtype(dtype):
    values = np.arange(200, 328)
    index = np.array([127, 0, 5, 5, 126], dtype)
    for machine in (MACHINES[0], MACHINES[3]):
        got = sv.get(machine.vector(values), machine.vector(index))
        assert_same(got, values[index])
        zeros = machine.vector(np.zeros(128, np.int64))
        assert_same(sv.send(got, machine.vector(index), sv.MAX, into=zeros).to_numpy()[index], values[index])


def test_the_context_hides_indices_that_are_out_of_range():
    for machine in MACHINES:
        index = machine.vector(np.array([-1, 1, 99, 2**40]))
        where = machine.vector(np.array([False, True, False, False]))
        v, into = machine.vector(np.arange(4.0)), machine.vector(np.zeros(3))
        assert_same(sv.get(v, index, where=where, otherwise=np.nan), np.array([np.nan, 1, np.nan, np.nan]))
        assert_same(sv.send(v, index, sv.ADD, into=into, where=where), np.array([0.0, 1, 0]))
        nobody = machine.full(4, False, bool)
        assert_same(sv.get(machine.vector(np.zeros(0)), index, where=nobody, otherwise=7), np.full(4, 7.0))


@pytest.mark.parametrize(("op", "dtypes"), COMBINERS, ids=lambda x: getattr(x, "name", ""))
@given(move=moves(), data=st.data())
def test_send_of_every_dtype(op, dtypes, move, data):
    # the sides change places: what get reads from, send writes into
    n, index, where = move
    into = of_dtypes(data.draw(words(n)), dtypes)
    record = of_dtypes(data.draw(words(len(index))), dtypes)
    machine = MACHINES[COMBINERS.index((op, dtypes)) % 5]  # by turns, for the time that it takes to compile
    i, context = machine.vector(index, np.int32), machine.vector(where, bool)
    got = sv.send(load(machine, record), i, op, into=load(machine, into), where=context)
    for dtype in dtypes:
        assert_same(got[dtype], twins.send(op, record[dtype], index, into[dtype], where))


@pytest.mark.parametrize("op", [sv.ADD, sv.MIN, sv.OR, sv.COPY], ids=lambda op: op.name)
@given(move=moves(), data=st.data())
def test_send_on_every_machine(op, move, data):
    n, index, _ = move
    into = of_dtype(data.draw(words(n)), "int32")
    values = of_dtype(data.draw(words(len(index))), "int32")
    want = twins.send(op, values, index, into, [True] * len(index))
    for machine in MACHINES:
        got = sv.send(machine.vector(values), machine.vector(index, np.int32), op, into=machine.vector(into))
        assert_same(got, want)


def test_what_is_sent_into_does_not_change():
    for machine in MACHINES:
        into = machine.vector(np.arange(3))
        sv.send(machine.vector(np.array([9])), machine.vector(np.array([1])), sv.COPY, into=into)
        assert_same(into, np.arange(3))


def test_vectors_longer_than_the_smallest_block():
    rng = np.random.default_rng(3)
    values, index = rng.integers(0, 100, 5000), rng.integers(0, 17000, 5000)
    want = np.bincount(index, weights=values, minlength=17000).astype(np.int64)
    for machine in MACHINES:
        i = machine.vector(index)
        got = sv.send(machine.vector(values), i, sv.ADD, into=machine.vector(np.zeros(17000, np.int64)))
        assert_same(got, want)
        assert_same(sv.get(got, i), want[index])


@given(order=permutations, data=st.data())
def test_permute_every_dtype(order, data):
    record = of_dtypes(data.draw(words(len(order))))
    for machine in (MACHINES[0], MACHINES[4]):
        got = sv.permute(load(machine, record), machine.vector(order, np.int32))
        for dtype in DTYPES:
            want = np.empty_like(record[dtype])
            want[list(order)] = record[dtype]
            assert_same_bits(got[dtype], want)


@given(order=permutations, data=st.data())
def test_scatter_into_a_longer_or_shorter_vector_under_a_context(order, data):
    # every second place is written, by the elements that the context holds
    values = of_dtype(data.draw(words(len(order))), "int32")
    flags = of_dtype(data.draw(words(len(order))), "bool")
    into = np.arange(1000, 1000 + 2 * len(order), dtype=np.int32)
    want = twins.send(sv.COPY, values, [2 * j for j in order], into, flags)
    for machine in MACHINES:
        index = machine.vector(order, np.int32) * 2
        where = machine.vector(flags)
        got = sv.scatter(machine.vector(values), index, into=machine.vector(into), where=where)
        assert_same(got, want)
        # and back, from the longer vector into the shorter one
        i = machine.iota(len(got))
        back = sv.scatter(got, i // 2, into=machine.vector(values), where=i % 2 == 0)
        assert_same(back, want[::2])
