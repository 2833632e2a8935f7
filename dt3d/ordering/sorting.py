"""Sorting by several threads: each sorts a run, then two runs at a time are merged from both ends."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from itertools import pairwise

import numpy as np

from .._numba.kernel_cache import cached_njit
from .._numba.threads import run_short_tasks

WORTH_A_THREAD = 20_000  # words: below that a thread takes longer to start than to sort them


@cached_njit(nogil=True)
def _merge_front(low, high, out):
    """The first len(out) // 2 words of two sorted runs together."""
    i = j = 0
    for k in range(len(out) // 2):
        if j == len(high) or (i < len(low) and low[i] <= high[j]):
            out[k] = low[i]
            i += 1
        else:
            out[k] = high[j]
            j += 1


@cached_njit(nogil=True)
def _merge_back(low, high, out):
    """The others, from the last one on."""
    i, j = len(low) - 1, len(high) - 1
    for k in range(len(out) - 1, len(out) // 2 - 1, -1):
        if j < 0 or (i >= 0 and low[i] > high[j]):
            out[k] = low[i]
            i -= 1
        else:
            out[k] = high[j]
            j -= 1


def sort_runs(runs: int, n: int, fill: Callable[[np.ndarray, int], None]) -> np.ndarray:
    """Words in ascending order, uint64 (n,), made and sorted by at most so many threads.

    ``fill(out, begin)``, which releases the interpreter's lock, writes the words from number ``begin`` on.
    """
    runs = max(1, min(runs, n // WORTH_A_THREAD))
    words, other = np.empty(n, np.uint64), np.empty(n if runs > 1 else 0, np.uint64)
    bounds = [n * k // runs for k in range(runs + 1)]

    def make(begin: int, end: int) -> None:
        fill(words[begin:end], begin)
        words[begin:end].sort()

    run_short_tasks([partial(make, begin, end) for begin, end in pairwise(bounds)])
    while len(bounds) > 2:
        tasks = []
        for begin, middle, end in zip(bounds[:-2:2], bounds[1:-1:2], bounds[2::2], strict=True):
            merged = words[begin:middle], words[middle:end], other[begin:end]
            tasks += [partial(_merge_front, *merged), partial(_merge_back, *merged)]
        if len(bounds) % 2 == 0:  # a run without a partner
            other[bounds[-2] :] = words[bounds[-2] :]
        run_short_tasks(tasks)
        bounds = [*bounds[:-1:2], n]
        words, other = other, words
    return words
