"""What the methods are made of, by itself: the queue, location of several sites at a time, sharing sites."""

import numba
import numpy as np
import pytest

from dt3d._numba.atomics import padded
from dt3d._numba.threads import run_threads
from dt3d.predicates import work_array
from dt3d.threaded2d import dag, sequential
from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.lookahead import interleaved
from dt3d.threaded2d.mesh import END, NEXT, PART, SHARED_ROWS, STATE_COLUMNS
from dt3d.threaded2d.queue import ITEM_NODE, ITEM_SITE, empty_queue, fill_of, get, put
from dt3d.threaded2d.steps import DONE
from dt3d.threaded2d.virtual_time.costs import prepared
from dt3d.threaded2d.work_sharing import PIECE, ahead_of_all, share, take

from .families import EVERY_SET


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


@numba.njit
def _through_lanes(points, nodes, hands, sites, w):
    """The leaves of the sites by way of the interleaved."""
    found = np.full(len(points), -1)
    begun = 0
    while True:
        for i in range(len(hands)):
            if hands[i, interleaved.LANE_SITE] == interleaved.EMPTY and begun < len(sites):
                interleaved.start(points, nodes, hands, i, sites[begun], w)
                begun += 1
        i, _ = interleaved.advance(points, nodes, hands, w)
        if i == interleaved.EMPTY:
            return found
        found[hands[i, interleaved.LANE_SITE]] = hands[i, interleaved.LANE_NODE]
        hands[i, interleaved.LANE_SITE] = interleaved.EMPTY


@numba.njit
def _one_by_one(points, nodes, sites, w):
    found = np.full(len(points), -1)
    for q in sites:
        found[q], _ = dag.locate(points, nodes, q, w)
    return found


@pytest.mark.parametrize("name", EVERY_SET)
def test_lanes_lead_to_the_leaf_that_a_location_finds(name):
    store, sites = prepared(EVERY_SET[name](300), Options(method="sequential", order="random"))
    half = len(sites.order) // 2
    some, others = share(sites.order[:half], np.array([0, half])), sites.order[half:]
    w = work_array(store.points)
    assert sequential.run(store.points, store.nodes, store.shared, store.state, some, 0, False, w) == DONE
    hands = interleaved.empty_lanes(1)[0]
    found = _through_lanes(store.points, store.nodes, hands, others, w)
    np.testing.assert_array_equal(found, _one_by_one(store.points, store.nodes, others, w))


def test_a_thread_that_has_done_its_part_takes_of_the_others():
    n = 5 * PIECE
    sites = share(np.arange(2 * n), np.array([0, n, 2 * n]))
    state = np.zeros((2, STATE_COLUMNS), np.int64)
    state[:, PART] = 0, 1
    assert take(state, sites, 1)
    taken = [(n, n + PIECE)]
    while take(state, sites, 0):
        taken.append((int(state[0, NEXT]), int(state[0, END])))
    assert sorted(begin for begin, _ in taken) == list(range(0, 2 * n, PIECE))
    assert all(end - begin == PIECE for begin, end in taken)
    assert not take(state, sites, 1)
    assert (sites.taker == np.where(np.arange(2 * n) // PIECE == 5, 1, 0)).all()


def test_the_first_sites_of_all_parts_go_ahead():
    order, bounds = ahead_of_all(np.arange(10) * 10, np.array([0, 5, 6, 10]), 2)
    assert order.tolist() == [0, 10, 50, 60, 70, 20, 30, 40, 80, 90]
    assert bounds.tolist() == [5, 8, 8, 10]
    order, bounds = ahead_of_all(np.arange(6), np.array([0, 3, 6]), 0)
    assert order.tolist() == list(range(6))
    assert bounds.tolist() == [0, 3, 6]


def test_small_parts_stay_with_their_threads():
    bounds = np.array([0, PIECE - 1, 2 * PIECE - 2])
    sites = share(np.arange(bounds[-1]), bounds)
    state = np.zeros((2, STATE_COLUMNS), np.int64)
    state[:, PART] = 0, 1
    assert take(state, sites, 0)
    assert not take(state, sites, 0)
    assert take(state, sites, 1)
    assert (sites.taker == np.repeat([0, 1], PIECE - 1)).all()
