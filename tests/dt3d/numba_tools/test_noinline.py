"""Calls that stay calls, once for all widths of indices."""

import numba
import numpy as np
from numba.extending import intrinsic

from dt3d._numba.noinline import call_noinline


@numba.njit
def _seldom(array, rows, k):
    return array[rows[0]] + array[rows[1]] + array[k]


@intrinsic
def _call_seldom(typingctx, array, rows, k):
    return call_noinline(typingctx, _seldom, (array, rows, k))


@numba.njit
def _often(array, i, j, k):
    return _call_seldom(array, (i, j), k)


def test_it_is_called_and_compiled_once():
    array = np.arange(5.0)
    assert _often(array, 1, 2, 3) == 6
    assert _often(array, np.int32(1), np.int64(2), np.uint16(3)) == 6
    assert len(_seldom.signatures) == 1
    (code,) = list(_often.inspect_llvm().values())[:1]
    assert "noinline" in code
