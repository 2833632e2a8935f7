"""Operators: identities and associativity, on every dtype that they take."""

import numpy as np
import pytest

import scanvec as sv
from scanvec._running import computing

from .cases import DTYPES

OPERATORS = (sv.ADD, sv.MUL, sv.MIN, sv.MAX, sv.AND, sv.OR)


@pytest.mark.parametrize("op", OPERATORS, ids=str)
@pytest.mark.parametrize("dtype", DTYPES)
def test_the_identity_is_one(op, dtype):
    dtype = np.dtype(dtype)
    if dtype.kind not in op.kinds:
        with pytest.raises(TypeError, match=f"{op.name} is not defined for {dtype} elements; convert"):
            op.check(dtype, "scan")
        return
    values = np.array([0, 1, 7, 100]).astype(dtype)
    identity = np.asarray(op.identity(dtype)).astype(dtype)
    with computing():
        sides = op.fn(identity, values), op.fn(values, identity)
    for side in sides:
        np.testing.assert_array_equal(np.asarray(side).astype(dtype), values)


def test_argmin_takes_the_left_of_equals():
    a, b = (np.float32(1), np.int32(7)), (np.float32(1), np.int32(8))
    assert int(sv.ARGMIN.fn(a, b)[1]) == 7
    assert int(sv.ARGMIN.fn(b, a)[1]) == 8


def test_names():
    assert repr(sv.MAX) == "scanvec.MAX"
