"""Asking for memory changes nothing, wherever it lies."""

import numba
import numpy as np

from dt3d._numba.prefetch import prefetch


@numba.njit
def _ask(array, index):
    prefetch(array, index)
    return array.sum()


def test_rows_and_elements_may_be_out_of_bounds():
    for array in (np.arange(12), np.arange(12.0).reshape(4, 3), np.arange(12, dtype=np.uint32)):
        for index in (0, 3, -1, 1 << 40, np.int32(2)):
            assert _ask(array, index) == 66
