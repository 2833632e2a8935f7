"""A bounded queue of sites and where they were located, for any number of threads at both ends.

D. Vyukov's bounded queue: every cell has a number that says whose turn it is, so that a thread needs one
compare-and-swap for all elements that it puts or takes, and one that loses the processor in between delays
others at its own cells only. The paper uses a short critical section instead.
"""

from __future__ import annotations

import numpy as np

from .._numba.atomics import compare_and_swap, load, load_acquire, store_release
from .._numba.kernel_cache import cached_njit
from . import columns as c

# columns of `cells`, and the first two of located sites
ITEM_SITE, ITEM_NODE, TURN = range(3)


def empty_queue(length: int) -> np.ndarray:
    """Cells of a queue, int64 (length, 4); its ends are words of `Mesh.shared`, 0 at the beginning."""
    cells = np.zeros((length, 4), np.int64)
    cells[:, TURN] = np.arange(length)
    return cells


@cached_njit(forceinline=True)
def _reserve(cells, shared, end, ahead, wanted):
    """Up to ``wanted`` cells at one end of the queue, HEAD or TAIL: the place of the first, and how many.

    A cell is ready when its number is ``ahead`` of its place. Each turn but the first is one in which other
    threads have moved this end, which they do as often as there are elements.
    """
    at = load(shared, (end, 0))
    while True:
        count = 0
        while count < wanted and load_acquire(cells, ((at + count) % len(cells), TURN)) == at + count + ahead:
            count += 1
        if count > 0 and compare_and_swap(shared, (end, 0), at, at + count):
            return at, count
        now = load(shared, (end, 0))
        if count == 0 and now == at:
            return at, 0
        at = now


@cached_njit(forceinline=True)
def put(cells, shared, items, first, count):
    """Append items[first : first + count], rows (site, node), or as many as there is room for.

    Returns how many.
    """
    at, room = _reserve(cells, shared, c.TAIL, 0, count)
    for i in range(room):
        cell = (at + i) % len(cells)
        cells[cell, ITEM_SITE] = items[first + i, ITEM_SITE]
        cells[cell, ITEM_NODE] = items[first + i, ITEM_NODE]
        store_release(cells, (cell, TURN), at + i + 1)
    return room


@cached_njit(forceinline=True)
def get(cells, shared, items, first, count):
    """Take up to ``count`` elements, into items[first], items[first + 1], ...; how many there were."""
    at, found = _reserve(cells, shared, c.HEAD, 1, count)
    for i in range(found):
        cell = (at + i) % len(cells)
        items[first + i, ITEM_SITE] = cells[cell, ITEM_SITE]
        items[first + i, ITEM_NODE] = cells[cell, ITEM_NODE]
        store_release(cells, (cell, TURN), at + i + len(cells))
    return found


@cached_njit(forceinline=True)
def fill_of(shared):
    """How many elements there are, while others come and go."""
    return max(0, load(shared, (c.TAIL, 0)) - load(shared, (c.HEAD, 0)))
