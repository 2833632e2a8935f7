"""A bounded queue of sites and where they were located, for any number of threads at both ends.

D. Vyukov's bounded queue: every cell has a number that says whose turn it is, so that a thread needs one
compare-and-swap, and one that loses the processor in between holds nobody up but at its own cell. The paper
uses a short critical section instead.
"""

from __future__ import annotations

import numba
import numpy as np

from .atomics import compare_and_swap, load, load_acquire, store_release
from .store import HEAD, TAIL

# columns of `cells`
TURN, ITEM_SITE, ITEM_NODE = range(3)


def empty_queue(length: int) -> np.ndarray:
    """Cells of a queue, int64 (length, 3); the ends are words of the store's `shared`, 0 at the beginning."""
    cells = np.zeros((length, 3), np.int64)
    cells[:, TURN] = np.arange(length)
    return cells


@numba.njit(cache=True, forceinline=True)
def put(cells, shared, site, node):
    """Append an element; False where the queue is full."""
    at = load(shared, (TAIL, 0))
    while True:
        cell = at % len(cells)
        turn = load_acquire(cells, (cell, TURN))
        if turn == at:
            if compare_and_swap(shared, (TAIL, 0), at, at + 1):
                cells[cell, ITEM_SITE], cells[cell, ITEM_NODE] = site, node
                store_release(cells, (cell, TURN), at + 1)
                return True
        elif turn < at:
            return False
        at = load(shared, (TAIL, 0))


@numba.njit(cache=True, forceinline=True)
def get(cells, shared):
    """The first element: whether there is one, its site and node."""
    at = load(shared, (HEAD, 0))
    while True:
        cell = at % len(cells)
        turn = load_acquire(cells, (cell, TURN))
        if turn == at + 1:
            if compare_and_swap(shared, (HEAD, 0), at, at + 1):
                site, node = cells[cell, ITEM_SITE], cells[cell, ITEM_NODE]
                store_release(cells, (cell, TURN), at + len(cells))
                return True, site, node
        elif turn <= at:
            return False, np.int64(-1), np.int64(-1)
        at = load(shared, (HEAD, 0))


@numba.njit(cache=True, forceinline=True)
def fill_of(shared):
    """How many elements there are, while others come and go."""
    return max(0, load(shared, (TAIL, 0)) - load(shared, (HEAD, 0)))
