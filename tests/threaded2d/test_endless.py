"""No endless loop: broken structures, and threads that never come on, end in an InternalError."""

import threading
import time
from types import FunctionType

import numba
import numpy as np
import pytest

from dt3d import InternalError
from dt3d._numba.threads import run_threads
from dt3d.predicates import work_array
from dt3d.threaded2d import correction, dag, flips, illegal_edges, optimistic, pool, sequential
from dt3d.threaded2d.configuration import Options, configured
from dt3d.threaded2d.driver import Run, triangulate
from dt3d.threaded2d.in_place import cavity, walk
from dt3d.threaded2d.mesh import (
    CHILD,
    CRITICAL,
    LOCK,
    LOOKED,
    MOST_LOOKS,
    NEIGHBOR,
    PATIENCE,
    ROOTS,
    STOP,
    Store,
)
from dt3d.threaded2d.steps import DONE, STOPPED
from dt3d.threaded2d.virtual_time import scheduler
from dt3d.threaded2d.virtual_time.costs import Costs, prepared
from dt3d.threaded2d.work_sharing import share

from .families import EVERY_SET, uniform

KINDS = [
    ("sequential", 1, "dag"),
    ("sequential", 1, "walk"),
    ("batch", 3, "dag"),
    ("batch", 3, "walk"),
    ("circumcircle", 3, "dag"),
    ("circumcircle", 3, "walk"),
    ("pessimistic", 2, "dag"),
    ("pessimistic", 2, "walk"),
    ("optimistic", 2, "dag"),
    ("optimistic", 2, "walk"),
]


def _run(method, threads, location, n=400):
    """A run that has not begun, of threads that lose patience within a second."""
    options = Options(method=method, threads=threads, location=location)
    store, sites = prepared(uniform(n), options)
    if options.in_place:
        store = Store(store.points, store.nodes[0, :3], threads, ROOTS + 2 * len(store.points))
    store.shared[MOST_LOOKS, 0] = 0
    return Run(options, store, sites)


def _raises_and_leaves_no_thread(run, match):
    before = threading.active_count()
    with pytest.raises(InternalError, match=f"{match}.*please report it"):
        run()
    assert threading.active_count() == before


def _going_round(run):
    if run.options.in_place:
        # over each edge of the first triangle lies the first triangle, come into over its next edge
        run.store.nodes[0, NEIGHBOR : NEIGHBOR + 3] = 1, 2, 0
    else:
        run.store.nodes[:ROOTS, CHILD] = 0  # the children of all roots are the first two roots


@pytest.mark.parametrize(("method", "threads", "location"), KINDS)
def test_a_structure_that_goes_round_in_circles(method, threads, location):
    run = _run(method, threads, location)
    _going_round(run)
    _raises_and_leaves_no_thread(run.to_the_end, "round in circles|have no end|wait for each other")


def _stuck(name):
    """A run, and the tasks of those of its threads that wait for ever."""
    method, _, location = name.partition(" ")
    run = _run(method, 1 if name == "pessimistic dag" else 3, location.split()[0])
    store, tasks = run.store, [0, 1]
    if method == "optimistic":
        store.nodes[:ROOTS, LOCK] = 99
    elif method == "pessimistic":
        store.shared[CRITICAL, 0] = 99
        tasks = [0]
    elif name == "batch dag without specialised":
        pass
    elif name == "batch dag without searching":
        tasks = [2]
    elif name == "circumcircle dag head start":
        run.alone, tasks = 1, [1, 2]
    else:
        # a vertex of everything, of a thread that does nothing
        run.pool[2, pool.POOL_SITE] = store.nodes[0, 0]
        run.alone = 0
        if name.endswith("critical"):
            store.shared[CRITICAL, 0] = 99
    return run, [run._timed(k) for k in tasks]


STUCK = [
    "optimistic dag",
    "optimistic walk",
    "pessimistic dag",
    "batch dag without specialised",
    "batch dag without searching",
    "circumcircle dag",
    "circumcircle dag critical",
    "circumcircle dag head start",
]


IMPATIENT = ("optimistic walk", "batch dag without searching", "circumcircle dag")


@pytest.mark.parametrize(
    "name", [name if name in IMPATIENT else pytest.param(name, marks=pytest.mark.slow) for name in STUCK]
)
def test_a_wait_that_nobody_ends(name):
    run, tasks = _stuck(name)
    _raises_and_leaves_no_thread(lambda: run_threads(tasks, run.stop), "wait for each other")


@pytest.mark.parametrize("name", STUCK)
def test_what_another_thread_raises_ends_every_wait(name):
    run, tasks = _stuck(name)
    run.store.shared[MOST_LOOKS, 0] = PATIENCE

    def failing():
        time.sleep(0.05)
        msg = "another one fails"
        raise ArithmeticError(msg)

    before = threading.active_count()
    with pytest.raises(ArithmeticError, match="another one fails"):
        run_threads([*tasks, failing], run.stop)
    assert threading.active_count() == before


@pytest.mark.parametrize("name", STUCK)
def test_the_stop_flag_ends_every_wait(name):
    run, tasks = _stuck(name)
    run.store.shared[STOP, 0] = 1
    assert set(run_threads(tasks, run.stop)) == {STOPPED}


@numba.njit
def _walked(points, nodes, start, sites, w):
    return [walk.walk_history(points, nodes, start, q, w)[0] for q in sites]


@numba.njit
def _located(points, nodes, sites, w):
    return [dag.locate(points, nodes, q, w)[0] for q in sites]


def _half(n=300):
    """A store with half of its sites, and the other sites."""
    store, sites = prepared(uniform(n), Options(method="sequential", order="random"))
    half = len(sites.order) // 2
    w = work_array(store.points)
    some = share(sites.order[:half], np.array([0, half]))
    assert sequential.run(store.points, store.nodes, store.shared, store.state, some, 0, False, w) == DONE
    return store, sites.order[half:], w


def test_a_walk_that_goes_round_in_circles_goes_on_in_the_history():
    store, others, w = _half()
    want = _located(store.points, store.nodes, others, w)
    leaves = np.flatnonzero(store.nodes[:, CHILD] < 0)
    # every edge leads to the same two triangles
    store.nodes[leaves, NEIGHBOR : NEIGHBOR + 3] = 4 * leaves[0]
    store.nodes[leaves[0], NEIGHBOR : NEIGHBOR + 3] = 4 * leaves[1]
    assert _walked(store.points, store.nodes, leaves[0], others, w) == want


def _with(function, **names):
    """A compiled function with other globals."""
    source = function.py_func
    return numba.njit(FunctionType(source.__code__, source.__globals__ | names, source.__name__))


@numba.njit
def _always(points, nodes, f, w):
    return True


@numba.njit
def _always_edge(points, nodes, t, k, w):
    return True


def test_a_legalisation_that_does_not_end():
    store, others, w = _half()
    insert = _with(flips.insert, illegal=_always)
    t = _located(store.points, store.nodes, others[:1], w)[0]
    used = int(store.shared[0, 0])
    with pytest.raises(InternalError, match="legalisation.*please report"):
        insert(store.points, store.nodes, store.shared, store.state, 0, t, others[0], 0, w)
    assert store.shared[0, 0] - used < store.reserve


@pytest.mark.slow
def test_a_correction_that_does_not_end(monkeypatch):
    store, _, w = _half(40)
    monkeypatch.setattr(correction, "_flip_illegal", _with(correction._flip_illegal, _illegal=_always_edge))
    before = threading.active_count()
    with pytest.raises(InternalError, match="correction.*please report"):
        correction.correct(store, np.arange(ROOTS, dtype=np.int32), w, lambda: None)
    assert threading.active_count() == before


def test_conflicts_without_an_end_stay_within_their_arrays():
    store, others, w = _half()
    claim = _with(cavity.claim, in_conflict=numba.njit(lambda points, nodes, t, q, w: True))
    length = 4 * len(store.points) + 64
    held, found, rim = (np.full(k * length + 1, -7, np.int32) for k in (1, 1, 3))
    for lock in (0, 1):
        t = int(np.flatnonzero(store.nodes[:, CHILD] < 0)[0])
        with pytest.raises(InternalError, match="have no end.*please report"):
            claim(store.points, store.nodes, t, others[0], lock, held[:-1], found[:-1], rim[:-1], w)
    assert held[-1] == found[-1] == rim[-1] == -7


def test_stars_that_do_not_close():
    store, _, _ = _half()
    nodes = store.nodes
    f = int(np.flatnonzero((nodes[:, CHILD] < 0) & (nodes[:, 0] >= 0))[-1])
    q = int(nodes[f, 0])
    following = nodes[f, NEIGHBOR + 1] >> 2
    nodes[following, NEIGHBOR : NEIGHBOR + 3] = 4 * following
    unlock, note = numba.njit(optimistic._unlock_star.py_func), numba.njit(illegal_edges.note_star.py_func)
    with pytest.raises(InternalError, match="does not close"):
        unlock(nodes, f)
    notes = illegal_edges.empty_notes(1)[0]
    with pytest.raises(InternalError, match="does not close"):
        note(nodes, store.shared, store.state, notes, 0, f, q)
    nodes[f, CHILD] = 2 * f  # it descends from itself
    with pytest.raises(InternalError, match="lost a site"):
        note(nodes, store.shared, store.state, notes, 0, f, q)
    nodes[f, CHILD] = 1  # the roots do not have it
    with pytest.raises(InternalError, match="lost a site"):
        note(nodes, store.shared, store.state, notes, 0, f, q)


@pytest.mark.parametrize("method", ["sequential", "batch", "circumcircle", "optimistic", "pessimistic"])
def test_virtual_time_ends_too(method, monkeypatch):
    def broken(points, options):
        store, sites = prepared(points, options)
        store.nodes[:ROOTS, CHILD] = 0
        return store, sites

    monkeypatch.setattr(scheduler, "prepared", broken)
    options = Options(method=method, threads=3, order="random")
    with pytest.raises(InternalError, match="round in circles"):
        scheduler.simulate(uniform(100), options, 2, Costs(6e-8, 4e-8, 2e-8))


def test_virtual_time_of_a_lock_that_is_not_given_back(monkeypatch):
    def locked(points, options):
        store, sites = prepared(points, options)
        store.nodes[:ROOTS, LOCK] = 99
        store.shared[MOST_LOOKS, 0] = 0
        return store, sites

    monkeypatch.setattr(scheduler, "prepared", locked)
    options = Options(method="optimistic", threads=3, order="random")
    with pytest.raises(InternalError, match="wait for each other"):
        scheduler.simulate(uniform(100), options, 2, Costs(6e-8, 4e-8, 2e-8))


@pytest.mark.parametrize("name", EVERY_SET)
def test_contended_runs_do_not_come_near(name, monkeypatch):
    """Whenever a thread has looked whether others come on, one had: on hard sets, under contention."""
    runs = []
    begin = Run.__init__

    def watched(self, *args):
        begin(self, *args)
        runs.append(self)

    monkeypatch.setattr(Run, "__init__", watched)
    points = EVERY_SET[name](200)
    for method, threads, location in KINDS[2:]:
        options = configured(len(points), method=method, threads=threads, location=location, queue_length=2)
        triangulate(points, options.contended(2))
    for run in runs:
        assert (run.store.state[:, LOOKED] == 0).all()
    assert len(runs) == len(KINDS) - 2
