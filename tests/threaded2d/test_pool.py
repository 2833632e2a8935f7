"""The pool of the circum-circle method: which threads count as waiting, and for which others."""

import numba

from dt3d.threaded2d import columns as c
from dt3d.threaded2d import pool
from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.virtual_time.costs import prepared

from .families import uniform

blocker_of, wait_for, still_waits, publish, retire = (
    numba.njit(f.py_func)
    for f in (pool.blocker_of, pool.wait_for, pool.still_waits, pool.publish, pool.retire)
)


def _three_threads():
    """A store whose first triangle every site is in conflict with or a vertex of, and an empty pool."""
    store, _ = prepared(uniform(20), Options(method="circumcircle", threads=3, order="random"))
    return store, pool.empty_pool(3)


def _blocker(store, entries, me):
    vertices = store.nodes[0, :3]
    for i in range(3):
        publish(entries, i, int(vertices[i]))
    return blocker_of(store.mesh(me), me, entries, (0,), 1)


def test_one_that_waits_for_this_insertion_is_left_out_and_flagged():
    store, entries = _three_threads()
    assert _blocker(store, entries, 0) == (1, 0)
    assert wait_for(store.shared, entries, 1, 2, 0)
    assert wait_for(store.shared, entries, 2, 0, 0)
    assert not wait_for(store.shared, entries, 0, 1, 0)  # that would be for ever
    store.state[2, c.PHASE] = c.LEGALISE
    assert _blocker(store, entries, 0)[0] == pool.NOBODY
    assert entries[:, pool.EXCEPTIONAL].tolist() == [0, 1, 1]
    assert store.state[0, c.EXCEPTIONS] == 2
    assert store.state[0, c.STAR_MARKED] == 1


def test_one_that_has_not_noticed_the_end_of_its_wait_does_not_count_as_waiting():
    store, entries = _three_threads()
    assert wait_for(store.shared, entries, 1, 2, 0)
    assert wait_for(store.shared, entries, 2, 0, 0)
    retire(entries, 0)
    # thread 0 is at its next insertion; 2, and so 1, may go on at any moment
    assert _blocker(store, entries, 0) == (1, 0)
    assert entries[:, pool.EXCEPTIONAL].tolist() == [0, 0, 0]
    assert wait_for(store.shared, entries, 0, 1, 0)
    assert still_waits(entries, 1)
    assert not still_waits(entries, 2)
