"""Arrays without an owner are the same arrays."""

from typing import NamedTuple

import numba
import numpy as np
import pytest

from dt3d._numba.unowned import unowned


class Two(NamedTuple):
    first: np.ndarray
    number: int
    second: np.ndarray


@numba.njit
def _write(two):
    two = unowned(two)
    two.first[0] = two.number
    return two.second[-1]


@numba.njit
def _view(array):
    return unowned(array).sum()


def test_what_is_written_is_in_the_owners_array():
    first, second = np.zeros(3), np.arange(4)
    assert _write(Two(first, 7, second)) == 3
    assert first.tolist() == [7, 0, 0]
    assert _view(second) == 6


def test_only_arrays_have_owners():
    with pytest.raises(numba.TypingError, match="only arrays and tuples of them have owners"):
        _view(3)
