"""Functions that are called by their addresses, which an array holds."""

import numba
import numpy as np
import pytest
from numba.core import types
from numba.extending import intrinsic

from dt3d import InternalError
from dt3d._numba.by_address import address_of, call_at

PLACE = 3
KINDS = (types.UniTuple(types.float64, 2), types.int64)


@numba.njit
def weighted(pair, k):
    return pair[0] + k * pair[1]


@numba.njit
def other(pair, k):
    return -1.0


@intrinsic
def call_it(typingctx, holder, pair, k):
    return call_at(holder, PLACE, types.float64, KINDS)


@numba.njit
def kernel(holder, x, k):
    return call_it(holder, (x, 2.0 * x), k)


def test_what_is_called_is_what_the_address_is_of():
    holder = np.zeros(5)
    for function, expected in ((weighted, 1.5 + 7 * 3.0), (other, -1.0)):
        holder.view(np.int64)[PLACE] = address_of(function, KINDS)
        assert kernel(holder, 1.5, 7) == expected
        assert kernel(holder, 1.5, np.uint8(7)) == expected  # arguments are cast
    assert address_of(weighted, KINDS) == address_of(weighted, KINDS) != address_of(other, KINDS)


def test_a_missing_address_is_an_error():
    with pytest.raises(InternalError, match=f"there is no address at {PLACE}"):
        kernel(np.zeros(5), 1.5, 7)
