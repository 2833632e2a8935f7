"""Scans, plain and segmented, against the serial twin on every machine."""

import hypothesis.strategies as st
import jax.numpy as jnp
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
    lengths_of_segments,
    load,
    of_dtype,
    of_dtypes,
    sizes,
    words,
)

FORMS = {
    sv.scan: {"inclusive": False, "backward": False},
    sv.scan_inclusive: {"inclusive": True, "backward": False},
    sv.backscan: {"inclusive": False, "backward": True},
    sv.backscan_inclusive: {"inclusive": True, "backward": True},
}
each_form = pytest.mark.parametrize("form", FORMS, ids=lambda form: form.__name__)


# x -> a x + b, composed from left to right: a reader's own operator on records that does not commute
def _compose(f: tuple, g: tuple) -> tuple:
    return g[0] * f[0], g[0] * f[1] + g[1]


AFFINE = sv.Monoid("affine", _compose, lambda dtypes: (1, 0), "i")


@each_form
@given(lengths=lengths_of_segments, data=st.data())
def test_every_form_by_segments_with_an_operator_that_does_not_commute(form, lengths, data):
    n = sum(lengths)
    a, b = (of_dtype(data.draw(words(n)), "int32") for _ in range(2))
    with np.errstate(over="ignore"):
        rows = list(zip(a, b, strict=True))
        want = twins.scan(rows, _compose, (1, 0), twins.heads_of(lengths), **FORMS[form])
    for machine in MACHINES:
        segments = sv.Segments.from_lengths(machine.vector(lengths, np.int32))
        got = form(load(machine, (a, b)), AFFINE, segments)
        for column in (0, 1):
            assert_same(got[column], np.array([row[column] for row in want], np.int32))


NUMBERS = ("bool", *INTEGERS)  # of which results are exact; test_float_sums.py has the others


# All dtypes go through one kernel, as a record, which takes a second to compile. So the device scans whole
# vectors here and one of the other machines segments; of one dtype, all machines have every form.
@pytest.mark.parametrize(
    ("op", "form", "form_by_segments", "dtypes", "simulated"),
    [
        (sv.ADD, sv.scan, sv.backscan_inclusive, NUMBERS, MACHINES[2]),
        (sv.MUL, sv.backscan, sv.scan_inclusive, NUMBERS, MACHINES[3]),
        (sv.MIN, sv.scan_inclusive, sv.backscan, DTYPES, MACHINES[4]),
        (sv.MAX, sv.backscan_inclusive, sv.scan, DTYPES, MACHINES[2]),
        (sv.AND, sv.scan, sv.backscan_inclusive, NUMBERS, MACHINES[1]),
        (sv.OR, sv.backscan_inclusive, sv.scan, NUMBERS, MACHINES[3]),
        (sv.COPY, sv.backscan, sv.scan_inclusive, DTYPES, MACHINES[2]),
    ],
    ids=["add", "mul", "min", "max", "and", "or", "copy"],
)
@given(lengths=lengths_of_segments, data=st.data())
def test_every_operator_and_dtype(op, form, form_by_segments, dtypes, simulated, lengths, data):
    record = of_dtypes(data.draw(words(sum(lengths))), dtypes)
    heads = twins.heads_of(lengths)
    segments = sv.Segments.from_lengths(simulated.vector(lengths, np.int32))
    whole = form(load(MACHINES[0], record), op)
    parts = form_by_segments(load(simulated, record), op, segments)
    for dtype, values in record.items():
        assert_same(whole[dtype], twins.scan_array(op, values, **FORMS[form]))
        assert_same(parts[dtype], twins.scan_array(op, values, heads, **FORMS[form_by_segments]))


@each_form
@given(raw=words(sizes))
def test_the_whole_vector_on_every_machine(form, raw):
    values = of_dtype(raw, "int32")
    want = twins.scan_array(sv.ADD, values, **FORMS[form])
    for machine in MACHINES:
        assert_same(form(machine.vector(values), sv.ADD), want)


@pytest.mark.parametrize("machine", MACHINES, ids=repr)
@pytest.mark.parametrize("n", [4096, 5000, 16385])
def test_vectors_longer_than_the_smallest_block(machine, n):
    values = np.random.default_rng(n).integers(-(2**31), 2**31, n, dtype=np.int32)
    assert_same(sv.scan_inclusive(machine.vector(values), sv.ADD), np.cumsum(values, dtype=np.int32))


@given(lengths=lengths_of_segments, data=st.data())
def test_copy_scan_moves_every_bit(lengths, data):
    values = data.draw(words(sum(lengths))).view(np.float64)  # NaNs with payloads and subnormals too
    want = [values[i] for i in twins.scan(range(len(values)), lambda a, b: a, 0, twins.heads_of(lengths),
                                          inclusive=True, backward=False)]  # fmt: skip
    for machine in MACHINES:
        segments = sv.Segments.from_lengths(machine.vector(lengths, np.int32))
        got = sv.copy_scan(machine.vector(values), segments).to_numpy()
        assert got.tobytes() == np.array(want, np.float64).tobytes()


@given(lengths=lengths_of_segments, data=st.data())
def test_enumerate_counts_the_flags_before(lengths, data):
    flags = of_dtype(data.draw(words(sum(lengths))), "bool")
    form = FORMS[sv.scan]
    plain = twins.scan_array(sv.ADD, flags, **form)
    segmented = twins.scan_array(sv.ADD, flags, twins.heads_of(lengths), **form)
    for machine in MACHINES:
        segments = sv.Segments.from_lengths(machine.vector(lengths, np.int32))
        assert_same(sv.enumerate(machine.vector(flags)), plain)
        assert_same(sv.enumerate(machine.vector(flags), segments), segmented)


def test_a_user_defined_operator_from_the_documentation():
    longest = sv.Monoid("longest", lambda a, b: jnp.where(b > a, b, a), lambda dtype: 0)
    for machine in MACHINES:
        got = sv.scan(machine.vector(np.array([3, 1, 4, 1, 5], np.int16)), longest)
        assert_same(got, np.array([0, 3, 3, 4, 4], np.int16))


DISTRIBUTED = [(sv.ADD, "int32"), (sv.ADD, "bool"), (sv.MAX, "float32"), (sv.AND, "uint16"), (sv.OR, "bool"),
               (sv.COPY, "int64")]  # fmt: skip


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
