"""The queue: order, bounds, and threads at both ends."""

import numba
import numpy as np

from dt3d._numba.atomics import padded
from dt3d._numba.threads import run_threads
from dt3d.threaded2d.columns import SHARED_ROWS
from dt3d.threaded2d.queue import ITEM_NODE, ITEM_SITE, empty_queue, fill_of, get, put


@numba.njit
def _put(cells, shared, items, first, count):
    return put(cells, shared, items, first, count)


@numba.njit
def _get(cells, shared, items, first, count):
    return get(cells, shared, items, first, count)


@numba.njit
def _fill(shared):
    return fill_of(shared)


def test_elements_leave_the_queue_in_the_order_in_which_they_came():
    rng = np.random.default_rng(0)
    cells, shared = empty_queue(5), padded(SHARED_ROWS)
    items = np.column_stack([np.arange(300), 1000 + np.arange(300)])
    came, went = 0, 0
    out = np.empty((8, 2), np.int64)
    while went < len(items):
        wanted = int(rng.integers(1, 8))
        count = _put(cells, shared, items, came, min(wanted, len(items) - came))
        assert count == min(wanted, len(items) - came, 5 - (came - went))  # as many as there is room for
        came += count
        assert _fill(shared) == came - went
        wanted = int(rng.integers(1, 8))
        count = _get(cells, shared, out, 1, wanted)
        assert count == min(wanted, came - went)
        np.testing.assert_array_equal(out[1 : 1 + count], items[went : went + count])
        went += count


@numba.njit(nogil=True)
def _produce(cells, shared, items):
    at = 0
    while at < len(items):
        at += put(cells, shared, items, at, min(3, len(items) - at))


@numba.njit(nogil=True)
def _consume(cells, shared, items):
    at = 0
    while at < len(items):
        at += get(cells, shared, items, at, min(4, len(items) - at))


def test_threads_at_both_ends_lose_nothing():
    n = 3000
    cells, shared = empty_queue(16), padded(SHARED_ROWS)
    came = [np.column_stack([np.arange(n) + n * k, np.full(n, k)]) for k in range(2)]
    went = [np.empty((n, 2), np.int64) for _ in range(2)]
    run_threads(
        [lambda k=k: _produce(cells, shared, came[k]) for k in range(2)]
        + [lambda k=k: _consume(cells, shared, went[k]) for k in range(2)],
        lambda: None,
    )
    everything = np.concatenate(went)
    np.testing.assert_array_equal(everything[np.argsort(everything[:, ITEM_SITE])], np.concatenate(came))
    for items in went:
        for k in range(2):  # of one producer, in order
            assert (np.diff(items[items[:, ITEM_NODE] == k, ITEM_SITE]) > 0).all()
