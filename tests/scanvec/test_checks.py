"""What is checked before a step, by itself; `test_errors` has the texts as programs meet them."""

import numpy as np
import pytest

import scanvec as sv
from scanvec import _checks

M = sv.Device()


def test_scalars_among_the_arguments():
    v = M.iota(3)
    assert [x is v for x in _checks.vectors_and_scalars(({"a": v}, 2, np.float32(1)))] == [True]
    with pytest.raises(TypeError, match="got an array of shape"):
        _checks.vectors_and_scalars((v, np.arange(3)))


@pytest.mark.parametrize("n", [-1, 2**31])
def test_lengths(n):
    with pytest.raises(ValueError, match=f"2.31 - 1 elements, got {n}"):
        _checks.check_size(n)
    _checks.check_size(_checks.LARGEST_VECTOR)


def test_the_position_that_is_wanted_most_is_named():
    index, where = M.vector([3, 1, 1, 3, 1]), M.vector([True, True, False, True, True])
    with pytest.raises(ValueError, match="permute: 2 elements are sent to position 1;"):
        _checks.not_distinct("permute", index, where, 2)
    with pytest.raises(ValueError, match="scatter: 3 elements are sent to position 1;"):
        _checks.not_distinct("scatter", index, None, 3)
