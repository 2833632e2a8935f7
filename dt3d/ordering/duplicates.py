"""Which sites are copies of others; the first of equal sites is the one of least index."""

from __future__ import annotations

import numpy as np

from .._input import first_copies
from .._numba.kernel_cache import cached_njit
from .lexicographic import equal


def copies_among(sites: np.ndarray, crowded: np.ndarray) -> np.ndarray:
    """Return pairs (a later copy, the first), int32 (k, 2), among some sites, by the index of the copy."""
    crowded = np.sort(crowded)
    _, pairs = first_copies(sites[crowded])
    copies: np.ndarray = crowded[pairs].astype(np.int32)
    return copies


@cached_njit(nogil=True)
def copied(rows, begin, end):
    """Whether a row from begin to end - 1 equals the one before it."""
    for i in range(max(begin, 1), end):
        j = 4 * i
        if rows[j] == rows[j - 4] and rows[j + 1] == rows[j - 3] and rows[j + 2] == rows[j - 2]:
            return True
    return False


@cached_njit(nogil=True)
def separate_copies(sites, order):
    """Move the first of equal sites to the front of ``order``, in which equal sites are together, by index.

    Returns their number, and pairs (a later copy, the first one), int32 (k, 2), by the index of the copy.
    """
    n = len(order)
    distinct = 0
    copies = 0
    for i in range(n):
        if i == 0 or not equal(sites, order[i], order[i - 1]):
            distinct += 1
    pairs = np.empty((n - distinct, 2), np.int32)
    distinct = 0
    previous = -1
    for i in range(n):
        site = order[i]
        if i > 0 and equal(sites, site, previous):
            pairs[copies, 0], pairs[copies, 1] = site, order[distinct - 1]
            copies += 1
        else:
            order[distinct] = site
            distinct += 1
        previous = site
    return distinct, pairs[np.argsort(pairs[:, 0])]
