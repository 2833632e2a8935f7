"""Vectors: there and back in every dtype, the operators, and that jax's flags stay as they are."""

import operator
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given

import scanvec as sv

from .cases import DTYPES, MACHINES, assert_same, assert_same_bits, of_dtypes, sizes, words

both_machines = pytest.mark.parametrize("machine", [MACHINES[0], MACHINES[2]], ids=repr)


@given(raw=words(sizes))
def test_there_and_back(raw):
    for values in of_dtypes(raw).values():
        for machine in MACHINES:
            v = machine.vector(values)
            assert (len(v), v.shape, v.dtype) == (len(values), values.shape, values.dtype)
            assert_same_bits(v, values)


@both_machines
def test_other_byte_orders_and_strides(machine):
    assert_same(machine.vector(np.arange(6, dtype=">i4")[::2]), np.array([0, 2, 4], np.int32))


@both_machines
@pytest.mark.parametrize("dtype", DTYPES)
def test_items(machine, dtype):
    values = np.array([0, 1, 1, 0, 1], dtype)
    v = machine.vector(values)
    for i in range(-5, 5):
        x = machine.item(v, i)
        assert x == values[i]
        assert x.dtype == dtype


@both_machines
@pytest.mark.parametrize(
    "op",
    [operator.add, operator.sub, operator.mul, operator.floordiv, operator.mod, operator.pow, operator.and_,
     operator.or_, operator.xor, operator.lshift, operator.rshift,
     operator.eq, operator.ne, operator.lt, operator.le, operator.gt, operator.ge],
    ids=lambda op: op.__name__,
)  # fmt: skip
def test_binary_operators(machine, op):
    a, b = np.array([7, 12, 3], np.int32), np.array([2, 3, 3], np.int32)
    v, w = machine.vector(a), machine.vector(b)
    assert_same(op(v, w), op(a, b))
    assert_same(op(v, 3), op(a, 3))
    assert_same(op(5, v), op(5, a))
    assert_same(op(v, np.int32(3)), op(a, np.int32(3)))
    assert_same(op(np.int32(5), v), op(np.int32(5), a))  # numpy's scalars leave it to the vector


@both_machines
def test_division(machine):
    a = np.arange(1, 1000) / 7
    v = machine.vector(a)
    assert_same(v / machine.vector(a[::-1]), a / a[::-1])
    # XLA multiplies by the reciprocal of a scalar: one rounding more, each of half an ulp, as numpy's own
    eps = np.finfo(float).eps
    np.testing.assert_allclose(v / 3, a / 3, rtol=2 * eps, atol=0)
    assert_same(2.0 / v, 2.0 / a)


@both_machines
def test_unary_operators(machine):
    a = np.array([3, -4, 0], np.int16)
    v = machine.vector(a)
    assert_same(-v, -a)
    assert_same(abs(v), abs(a))
    assert_same(~v, ~a)
    assert_same(~machine.vector([True, False]), np.array([False, True]))


@both_machines
@pytest.mark.parametrize("dtype", DTYPES)
def test_astype(machine, dtype):
    values = np.array([0, 1, 2.75, 100])
    assert_same(machine.vector(values).astype(dtype), values.astype(dtype))
    wrapped = np.array([-1, 300, 2**40 + 5])
    if np.dtype(dtype).kind != "f":
        assert_same(machine.vector(wrapped).astype(dtype), wrapped.astype(dtype))


@both_machines
def test_conversion_by_numpy(machine):
    v = machine.vector([1, 2])
    assert_same(np.asarray(v), np.array([1, 2]))
    assert_same(np.asarray(v, np.float32), np.array([1, 2], np.float32))
    assert repr(v) == f"Vector([1 2], dtype=int64, {machine!r})"


@both_machines
def test_dtypes_of_64_bits_need_no_flag(machine):
    third = np.array([1, 2, 1 / 3])
    v = machine.vector(third)
    assert_same(v * v + 0.1, third * third + 0.1)
    assert_same(sv.scan_inclusive(v, sv.MAX), np.array([1, 2, 2.0]))
    big = machine.vector(np.array([2**53 + 1, 2**62]))
    assert_same(big - 1, np.array([2**53, 2**62 - 1]))
    assert_same(sv.scan(big, sv.ADD), np.array([0, 2**53 + 1]))


def test_the_x64_flag_of_jax_stays_as_it_is():
    program = (
        "import jax, scanvec as sv, jax.numpy as jnp\n"
        "v = sv.Simulated(processors=2).vector([0.5, 1 / 3])\n"
        "assert (v + v).dtype == sv.scan(v, sv.ADD).dtype == 'float64'\n"
        "assert not jax.config.jax_enable_x64\n"
        "assert jnp.asarray([0.5]).dtype == 'float32'\n"
    )
    subprocess.run([sys.executable, "-c", program], check=True)
