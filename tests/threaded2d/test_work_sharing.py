"""Sharing sites: chunks of a thread's own part, then of others'."""

import numpy as np

from dt3d.threaded2d.columns import CHUNK_END, NEXT, PART, STATE_COLUMNS
from dt3d.threaded2d.work_sharing import CHUNK, ahead_of_all, next_chunk, share


def test_a_thread_that_has_done_its_part_takes_of_the_others():
    n = 5 * CHUNK
    schedule = share(np.arange(2 * n), np.array([0, n, 2 * n]))
    state = np.zeros((2, STATE_COLUMNS), np.int64)
    state[:, PART] = 0, 1
    assert next_chunk(state, schedule, 1)
    taken = [(n, n + CHUNK)]
    while next_chunk(state, schedule, 0):
        taken.append((int(state[0, NEXT]), int(state[0, CHUNK_END])))
    assert sorted(begin for begin, _ in taken) == list(range(0, 2 * n, CHUNK))
    assert all(end - begin == CHUNK for begin, end in taken)
    assert not next_chunk(state, schedule, 1)
    assert (schedule.taker == np.where(np.arange(2 * n) // CHUNK == 5, 1, 0)).all()


def test_fixed_parts_stay_with_their_threads():
    n = 5 * CHUNK
    schedule = share(np.arange(2 * n), np.array([0, n, 2 * n]), fixed=True)
    state = np.zeros((2, STATE_COLUMNS), np.int64)
    state[:, PART] = 0, 1
    while next_chunk(state, schedule, 0):
        pass
    assert (schedule.taker == np.repeat([0, -1], n)).all()
    assert next_chunk(state, schedule, 1)


def test_the_first_sites_of_all_parts_go_ahead():
    order, bounds = ahead_of_all(np.arange(10) * 10, np.array([0, 5, 6, 10]), 2)
    assert order.tolist() == [0, 10, 50, 60, 70, 20, 30, 40, 80, 90]
    assert bounds.tolist() == [5, 8, 8, 10]
    order, bounds = ahead_of_all(np.arange(6), np.array([0, 3, 6]), 0)
    assert order.tolist() == list(range(6))
    assert bounds.tolist() == [0, 3, 6]


def test_small_parts_stay_with_their_threads():
    bounds = np.array([0, CHUNK - 1, 2 * CHUNK - 2])
    schedule = share(np.arange(bounds[-1]), bounds)
    state = np.zeros((2, STATE_COLUMNS), np.int64)
    state[:, PART] = 0, 1
    assert next_chunk(state, schedule, 0)
    assert not next_chunk(state, schedule, 0)
    assert next_chunk(state, schedule, 1)
    assert (schedule.taker == np.repeat([0, 1], CHUNK - 1)).all()
