"""The circum-circle method: who waits for whom, and what the head start leaves to the first thread."""

import numpy as np

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.circumcircle import HEAD_START, METHOD, head_start, step, tools
from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.pool import NOBODY, POOL_SITE
from dt3d.threaded2d.steps import FINISHED, WAITING
from dt3d.threaded2d.virtual_time.costs import prepared
from dt3d.threaded2d.work_sharing import ahead_of_all, share

from .families import uniform
from .stepping import assert_delaunay, begun


def run_to_the_end(store, t, threads):
    """One step of each thread in turn, and for each how often it waited."""
    meshes, ended, waits = [store.mesh(k) for k in range(threads)], set(), [0] * threads
    for _ in range(100_000):
        for k in set(range(threads)) - ended:
            outcome = step(meshes[k], k, t)
            waits[k] += outcome == WAITING
            if outcome == FINISHED:
                ended.add(k)
        if len(ended) == threads:
            return waits
    raise AssertionError


def test_one_thread_meets_nobody():
    store, t = begun(uniform(60), "circumcircle", 1)
    assert run_to_the_end(store, t, 1) == [0]
    assert store.state[0, c.INSERTED] == 57
    assert store.state[0, c.GIVEN_UP] == store.state[0, c.TESTS] == 0
    assert_delaunay(store)


def test_a_site_is_in_the_pool_from_its_location_to_its_last_flip():
    store, t = begun(uniform(60), "circumcircle", 2)
    mesh, seen = store.mesh(), []
    while (outcome := step(mesh, 0, t)) != FINISHED:
        published = int(t.pool[0, POOL_SITE])
        assert published == (NOBODY if store.state[0, c.PHASE] == c.BEGIN else store.state[0, c.SITE])
        seen.append(published)
        assert outcome != WAITING
    inserted = [v for v in dict.fromkeys(seen) if v != NOBODY]
    assert len(inserted) == store.state[0, c.INSERTED]
    assert store.state[0, c.TESTS] == 0  # the other thread has published nothing


def test_all_neighbours_are_tested_on_request():
    counts = {}
    for test_all in (False, True):
        options = Options(method="circumcircle", threads=2, order="random", test_all=test_all, interleave=1)
        store, schedule = prepared(uniform(300), options)
        run_to_the_end(store, tools(store, schedule, options), 2)
        assert store.state[:, c.INSERTED].sum() == 297
        counts[test_all] = store.state[:, [c.TESTS, c.FLIPS]].sum(axis=0)
    # three tests more per flip that finds no site of the other thread near
    assert counts[True][0] > counts[False][0] + counts[False][1]


def test_threads_wait_where_circles_meet_and_all_sites_are_inserted():
    store, t = begun(uniform(150), "circumcircle", 4)
    waits = run_to_the_end(store, t, 4)
    assert sum(waits) > 0
    assert store.state[:, c.INSERTED].sum() == 147
    assert (t.pool[:, POOL_SITE] == NOBODY).all()
    if not store.state[:, c.GIVEN_UP].any():
        assert_delaunay(store)


def test_the_first_thread_inserts_the_first_sites_of_all_parts():
    assert head_start(10**6, 4) == HEAD_START // 4
    assert head_start(4000, 4) == 4000 // 32 // 4
    assert head_start(20, 4) == 0
    options = Options(method="circumcircle", threads=2, order="random")
    store, schedule = prepared(uniform(120), options)
    bounds = np.array([0, 60, 117])
    order, bounds = ahead_of_all(schedule.order, bounds, 5)
    schedule = share(order, bounds)
    t = tools(store, schedule, options)
    assert t.alone == 10
    mesh = store.mesh(1)
    assert step(mesh, 1, t) == WAITING
    first = store.mesh(0)
    while store.state[0, c.INSERTED] < 10:
        assert step(first, 0, t) != WAITING
        assert step(mesh, 1, t) == WAITING or store.state[0, c.INSERTED] == 10
    assert step(mesh, 1, t) != WAITING
    assert sorted(np.flatnonzero(schedule.taker == 0)[:10].tolist()) == list(range(10))
    run_to_the_end(store, t, 2)
    assert store.state[:, c.INSERTED].sum() == 117
    assert METHOD.step is step
