"""Maps under a context, with records and scalars; iota and full, on every machine."""

from typing import NamedTuple

import hypothesis.strategies as st
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given

from .cases import DTYPES, MACHINES, assert_same, assert_same_bits, load, of_dtype, of_dtypes, sizes, words


def same(record):
    return record


@given(n=sizes, data=st.data())
def test_a_context_of_every_dtype(n, data):
    record, other = (of_dtypes(data.draw(words(n))) for _ in range(2))
    where = of_dtype(data.draw(words(n)), "bool")
    for machine in (MACHINES[0], MACHINES[2]):
        got = machine.map(
            same, load(machine, record), where=machine.vector(where), otherwise=load(machine, other)
        )
        for dtype in DTYPES:
            assert_same_bits(got[dtype], np.where(where, record[dtype], other[dtype]))


def product_and_sign(a, b):
    return a * b, a < 0


@given(n=sizes, data=st.data())
def test_a_function_of_two_vectors_on_every_machine(n, data):
    a, b = (of_dtype(data.draw(words(n)), "int16") for _ in range(2))
    where = of_dtype(data.draw(words(n)), "bool")
    with np.errstate(over="ignore"):
        product = a * b
    for machine in MACHINES:
        got = machine.map(product_and_sign, machine.vector(a), machine.vector(b))
        assert_same(got[0], product)
        assert_same(got[1], a < 0)
        # one scalar outside the context, for all that the function returns
        context = machine.vector(where)
        got = machine.map(product_and_sign, machine.vector(a), machine.vector(b), where=context, otherwise=1)
        assert_same(got[0], np.where(where, product, np.int16(1)))
        assert_same(got[1], np.where(where, a < 0, True))


class Point(NamedTuple):
    x: object
    y: object


def halfway(p, q, scale):
    return Point((p.x + q["x"]) * scale, (p.y + q["y"]) * scale)


@pytest.mark.parametrize("machine", MACHINES, ids=repr)
def test_records_in_and_out_and_scalars_for_all(machine):
    x, y = np.array([1.0, 2, 3]), np.array([4.0, 5, 6])
    p, q = Point(machine.vector(x), machine.vector(y)), {"x": machine.vector(y), "y": machine.vector(x)}
    got = machine.map(halfway, p, q, 0.5)
    assert isinstance(got, Point)
    assert_same(got.x, np.array([2.5, 3.5, 4.5]))
    got = machine.map(
        halfway, p, q, np.float64(0.5), where=machine.vector([True, False, True]), otherwise=Point(-1.0, p.y)
    )
    assert_same(got.x, np.array([2.5, -1, 4.5]))
    assert_same(got.y, np.array([2.5, 5, 4.5]))


def seven(_):
    return 7


def branch(a):
    return jnp.where(a > 1, jnp.max(jnp.stack([a, 2 * a])), -a)


@pytest.mark.parametrize("machine", MACHINES, ids=repr)
def test_the_function_sees_one_element(machine):
    v = machine.vector(np.array([1, 2, 3], np.int32))
    assert_same(machine.map(branch, v), np.array([-1, 4, 6], np.int32))
    assert machine.map(seven, v).to_numpy().tolist() == [7, 7, 7]


@pytest.mark.parametrize("machine", MACHINES, ids=repr)
@pytest.mark.parametrize("n", [0, 1, 4097])
def test_iota_and_full(machine, n):
    assert_same(machine.iota(n), np.arange(n, dtype=np.int32))
    assert_same(machine.full(n, 2.5, np.float16), np.full(n, 2.5, np.float16))
