"""What one thread has: sites to insert, free slots, scratch memory."""

import numpy as np

from dt3d.insertion.mesh import FREE, INFINITE, aligned, next_free, vertices
from dt3d.insertion.store import Store
from dt3d.insertion.worker import State, Worker, scratch_for

BOX = np.array([[0.0, 0, 0], [1, 1, 1]])


def test_its_sites_are_deferred_inserted_or_left():
    worker = Worker(100, BOX)
    assert (worker.state[State.SITES], worker.state[State.LENGTH]) == (100, 100)
    worker.assign(np.arange(10, dtype=np.uint32), 30, 40)
    assert (worker.state[State.FIRST], worker.state[State.LENGTH], worker.inserted) == (30, 40, 0)
    worker.state[State.NEXT], worker.state[State.DEFERRED] = 7, 2
    worker.todo[:2] = 3, 5
    assert worker.inserted == 5
    assert worker.left.tolist() == [3, 5, 7, 8, 9]
    worker.out_of_slots = True
    worker.assign(np.arange(3, dtype=np.uint32), 0, 100)
    assert (worker.left.tolist(), worker.out_of_slots) == ([0, 1, 2], False)


def test_slots_come_in_blocks_and_what_is_left_of_one_is_listed():
    store = Store(aligned(400, np.float64), np.arange(4, dtype=np.int32), 31, 10)
    worker, other = Worker(100, BOX), Worker(100, BOX)
    assert worker.take_slots(store)  # 5 .. 14
    assert worker.take_slots(store)  # 15 .. 24, which adjoins
    assert (worker.state[State.FRESH], worker.state[State.FRESH_END]) == (5, 25)
    worker.state[State.FRESH] = 23
    assert other.take_slots(store)
    assert not worker.take_slots(store)  # 31 .. 30, so that 23 and 24 are given up
    assert worker.unused == worker.state[State.FREE_COUNT] == 2
    first = worker.state[State.FREE]
    assert {int(first), next_free(store.mesh, first)} == {23, 24}
    assert (vertices(store.mesh)[23:25, 0] == FREE).all()
    assert other.unused == 6


def test_scratch_memory_has_views_of_the_rim():
    scratch = scratch_for(32)
    scratch.rim[:] = np.arange(96).reshape(3, 32)
    for row, view in zip(scratch.rim, (scratch.p, scratch.q, scratch.r), strict=True):
        np.testing.assert_array_equal(row, view)
    assert scratch.vertices[0] == INFINITE
    assert np.isnan([scratch.x[0], scratch.y[0], scratch.z[0], scratch.squared[0]]).all()
    assert {len(scratch.cavity), len(scratch.outer), len(scratch.slots)} == {32}
