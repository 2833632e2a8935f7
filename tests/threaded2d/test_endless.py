"""No endless loop: broken structures, and threads that never come on, end in an InternalError."""

import threading
import time
from types import FunctionType

import numba
import numpy as np
import pytest

from dt3d import InternalError
from dt3d._numba.threads import run_threads
from dt3d.threaded2d import columns as c
from dt3d.threaded2d import correction, dag, flips, illegal_edges, optimistic, pool
from dt3d.threaded2d.columns import edge, triangle
from dt3d.threaded2d.configuration import Options, configured
from dt3d.threaded2d.driver import Run, triangulate
from dt3d.threaded2d.in_place import cavity
from dt3d.threaded2d.location import walk_history
from dt3d.threaded2d.mesh import MOST_LOOKS, ROOTS, Store
from dt3d.threaded2d.steps import STOPPED
from dt3d.threaded2d.virtual_time import scheduler
from dt3d.threaded2d.virtual_time.costs import Costs, prepared

from .families import EVERY_SET, uniform
from .runs import half_inserted

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
    store.shared[c.MOST_LOOKS, 0] = 0
    return Run(options, store, sites)


def _raises_and_leaves_no_thread(run, match):
    before = threading.active_count()
    with pytest.raises(InternalError, match=f"{match}.*please report it"):
        run()
    assert threading.active_count() == before


def _going_round(run):
    if run.options.in_place:
        # over each edge of the first triangle lies the first triangle, come into over its next edge
        run.store.nodes[0, c.NEIGHBOR : c.NEIGHBOR + 3] = 1, 2, 0
    else:
        run.store.nodes[:ROOTS, c.CHILD] = 0  # the children of all roots are the first two roots


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
        store.nodes[:ROOTS, c.LOCK] = 99
    elif method == "pessimistic":
        store.shared[c.CRITICAL, 0] = 99
        tasks = [0]
    elif name == "batch dag without specialised":
        pass
    elif name == "batch dag without searching":
        tasks = [2]
    elif name == "circumcircle dag head start":
        store.state[1:, c.PHASE] = c.HEAD_START
        run.tools, tasks = run.tools._replace(alone=1), [1, 2]
    else:
        # a vertex of everything, of a thread that does nothing
        run.tools.pool[2, pool.POOL_SITE] = store.nodes[0, 0]
        if name.endswith("critical"):
            store.shared[c.CRITICAL, 0] = 99
    return run, [run.task(k) for k in tasks]


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
    _raises_and_leaves_no_thread(lambda: run_threads(tasks, run.store.stop), "wait for each other")


@pytest.mark.parametrize("name", STUCK)
def test_what_another_thread_raises_ends_every_wait(name):
    run, tasks = _stuck(name)
    run.store.shared[c.MOST_LOOKS, 0] = MOST_LOOKS

    def failing():
        time.sleep(0.05)
        msg = "another one fails"
        raise ArithmeticError(msg)

    before = threading.active_count()
    with pytest.raises(ArithmeticError, match="another one fails"):
        run_threads([*tasks, failing], run.store.stop)
    assert threading.active_count() == before


@pytest.mark.parametrize("name", STUCK)
def test_the_stop_flag_ends_every_wait(name):
    run, tasks = _stuck(name)
    run.store.stop()
    assert set(run_threads(tasks, run.store.stop)) == {STOPPED}


@numba.njit
def _walked(mesh, start, sites):
    return [walk_history(mesh, start, q)[0] for q in sites]


@numba.njit
def _located(mesh, sites):
    return [dag.locate(mesh, q)[0] for q in sites]


def test_a_walk_that_goes_round_in_circles_goes_on_in_the_history():
    store, others = half_inserted(uniform(300))
    want = _located(store.mesh(), others)
    leaves = np.flatnonzero(store.nodes[:, c.CHILD] < 0)
    # every edge leads to the same two triangles
    store.nodes[leaves, c.NEIGHBOR : c.NEIGHBOR + 3] = edge(int(leaves[0]), 0)
    store.nodes[leaves[0], c.NEIGHBOR : c.NEIGHBOR + 3] = edge(int(leaves[1]), 0)
    assert _walked(store.mesh(), leaves[0], others) == want


def _with(function, **names):
    """A compiled function with other globals."""
    source = function.py_func
    return numba.njit(FunctionType(source.__code__, source.__globals__ | names, source.__name__))


@numba.njit
def _always(mesh, f):
    return True


@numba.njit
def _always_edge(mesh, t, k):
    return True


@numba.njit
def _always_in_conflict(mesh, t, q):
    return True


def test_a_legalisation_that_does_not_end():
    store, others = half_inserted(uniform(300))
    insert = _with(flips.insert, illegal=_always)
    t = _located(store.mesh(), others[:1])[0]
    used = store.used
    with pytest.raises(InternalError, match="legalisation.*please report"):
        insert(store.mesh(), 0, t, others[0], 0)
    assert store.used - used < store.reserve


@pytest.mark.slow
def test_a_correction_that_does_not_end(monkeypatch):
    store, _ = half_inserted(uniform(40))
    monkeypatch.setattr(correction, "flip_illegal", _with(correction.flip_illegal, is_illegal=_always_edge))
    before = threading.active_count()
    with pytest.raises(InternalError, match="correction.*please report"):
        correction.correct(store, np.arange(ROOTS, dtype=np.int32))
    assert threading.active_count() == before


def test_conflicts_without_an_end_stay_within_their_arrays():
    store, others = half_inserted(uniform(300))
    lock_cavity = _with(cavity.lock_cavity, in_conflict=_always_in_conflict)
    whole = [np.full((1, a.shape[1] + 1), -7, np.int32) for a in cavity.empty_scratch(len(store.points), 1)]
    scratch = cavity.Scratch(*(a[:, :-1] for a in whole))
    for lock in (0, 1):
        t = int(np.flatnonzero(store.nodes[:, c.CHILD] < 0)[0])
        with pytest.raises(InternalError, match="have no end.*please report"):
            lock_cavity(store.mesh(), 0, t, others[0], lock, scratch)
    assert [a[0, -1] for a in whole] == [-7, -7, -7]


def test_stars_that_do_not_close():
    store, _ = half_inserted(uniform(300))
    nodes = store.nodes
    f = int(np.flatnonzero((nodes[:, c.CHILD] < 0) & (nodes[:, 0] >= 0))[-1])
    q = int(nodes[f, 0])
    following = triangle(int(nodes[f, c.NEIGHBOR + 1]))
    nodes[following, c.NEIGHBOR : c.NEIGHBOR + 3] = edge(following, 0)
    unlock, mark = numba.njit(optimistic.unlock_star.py_func), numba.njit(illegal_edges.mark_star.py_func)
    with pytest.raises(InternalError, match="does not close"):
        unlock(nodes, f)
    marks = illegal_edges.no_marks(1)
    with pytest.raises(InternalError, match="does not close"):
        mark(store.mesh(), 0, marks, f, q)
    nodes[f, c.CHILD] = 2 * f  # it descends from itself
    with pytest.raises(InternalError, match="lost a site"):
        mark(store.mesh(), 0, marks, f, q)
    nodes[f, c.CHILD] = 1  # the roots do not have it
    with pytest.raises(InternalError, match="lost a site"):
        mark(store.mesh(), 0, marks, f, q)


@pytest.mark.parametrize("method", ["sequential", "batch", "circumcircle", "optimistic", "pessimistic"])
def test_virtual_time_ends_too(method, monkeypatch):
    def broken(points, options):
        store, sites = prepared(points, options)
        store.nodes[:ROOTS, c.CHILD] = 0
        return store, sites

    monkeypatch.setattr(scheduler, "prepared", broken)
    options = Options(method=method, threads=3, order="random")
    with pytest.raises(InternalError, match="round in circles"):
        scheduler.simulate(uniform(100), options, 2, Costs(6e-8, 4e-8, 2e-8))


def test_virtual_time_of_a_lock_that_is_not_given_back(monkeypatch):
    def locked(points, options):
        store, sites = prepared(points, options)
        store.nodes[:ROOTS, c.LOCK] = 99
        store.shared[c.MOST_LOOKS, 0] = 0
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
        assert (run.store.state[:, c.LOOKED] == 0).all()
    assert len(runs) == len(KINDS) - 2
