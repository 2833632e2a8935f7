"""How vectors lie in blocks."""

import numpy as np
import pytest

from scanvec._machine import blocks


@pytest.mark.parametrize("n", [0, 1, 4, 5, 31, 33])
@pytest.mark.parametrize("processors", [1, 3, 32])
def test_there_and_back(n, processors):
    array = np.arange(1, n + 1)
    block = blocks.to_blocks(array, processors)
    vp = blocks.vp_ratio(n, processors)
    assert block.shape == (processors, blocks.row_length(n, processors))
    assert all(block[i // vp, i % vp] == array[i] for i in range(n))
    assert np.count_nonzero(block) == n
    assert np.array_equal(blocks.from_blocks(block, n), array)


def test_lengths_of_rows_are_few():
    assert [blocks.round_up(n, 3) for n in (0, 3, 4, 12, 13)] == [3, 3, 12, 12, 48]
    assert len({blocks.row_length(n, 32) for n in range(1, 10**5, 99)}) == 2


def test_indices():
    assert np.array_equal(blocks.indices((2, 3), 2), [[0, 1, 2], [2, 3, 4]])
