"""Words that threads share count right."""

import numba
import numpy as np
import pytest

from dt3d._numba import atomics
from dt3d._numba.threads import run_threads


@numba.njit(nogil=True)
def _count(words, rounds, me):
    for _ in range(rounds):
        while not atomics.acquire(words, (0, 0), me):
            pass
        words[1, 0] += 1  # not atomic: the lock has to do it
        atomics.release(words, (0, 0))
        atomics.add(words, (2, 0), 2)


def test_locks_and_additions_of_contending_threads():
    words = atomics.padded(3)
    run_threads([lambda k=k: _count(words, 20_000, k + 1) for k in range(4)], lambda: None)
    assert words[:, 0].tolist() == [0, 80_000, 160_000]


@numba.njit
def _single(words):
    old = atomics.add(words, 0, 2)
    missed = atomics.compare_and_swap(words, 0, 4, 9)
    swapped = atomics.compare_and_swap(words, 0, 5, 7)
    atomics.store_release(words, 1, atomics.load_acquire(words, 0) + 1)
    return old, missed, swapped


def test_atomics_one_by_one():
    words = np.array([3, 0], np.int32)
    assert _single(words) == (3, False, True)
    assert words.tolist() == [7, 8]


def test_only_integers_are_atomic():
    with pytest.raises(numba.TypingError, match="integer arrays"):
        _single(np.zeros(2))


@pytest.mark.parametrize("dtype", [np.int32, np.int64])
@pytest.mark.parametrize(("n", "columns"), [(1, 1), (3, 40), (2, 33), (5, 16)])
def test_no_two_rows_are_in_one_pair_of_cache_lines(n, columns, dtype):
    rows = atomics.rows_apart(n, columns, dtype)
    assert rows.dtype == dtype
    assert len(rows) == n
    assert 0 <= rows.shape[1] - columns < 128 // rows.itemsize
    assert rows.flags.c_contiguous
    assert not rows.any()
    assert rows.ctypes.data % 128 == rows.strides[0] % 128 == 0
