"""Stopping: Ctrl-C and exceptions end all threads; and atomics count right."""

import os
import signal
import threading
import time

import numpy as np
import pytest

from dt3d import threaded2d
from dt3d._numba.threads import run_threads
from dt3d.threaded2d.correction import correct
from dt3d.threaded2d.in_place import star
from dt3d.threaded2d.mesh import ROOTS

from .families import uniform
from .runs import inserted


def test_an_exception_in_one_thread_stops_the_others(monkeypatch):
    began = threading.Event()
    method = star.METHOD

    def failing(*args):
        if args[1] == 1:
            began.wait()
            msg = "thread 1 fails"
            raise RuntimeError(msg)
        began.set()
        return method.run(*args)

    monkeypatch.setattr(star, "METHOD", method._replace(run=failing))
    before = threading.active_count()
    with pytest.raises(RuntimeError, match="thread 1 fails"):
        threaded2d.Delaunay(uniform(200_000), method="optimistic", threads=2, location="walk")
    assert threading.active_count() == before


@pytest.mark.parametrize(
    "method", ["auto", "batch", "circumcircle", "pessimistic", "optimistic", "sequential"]
)
def test_an_interrupt_stops_all_threads_within_a_second(method):
    threaded2d.Delaunay(uniform(100), method=method)  # compiled before the clock runs
    store, _ = inserted(uniform(100))
    correct(store, np.arange(ROOTS, dtype=np.int32))  # and what is seldom needed
    points = uniform(400_000)
    before = threading.active_count()
    sent = []

    def interrupt():
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.25, interrupt)
    timer.start()
    try:
        threaded2d.Delaunay(points, method=method, order="brio" if method == "auto" else "random")
        timer.join()  # the machine was faster
    except KeyboardInterrupt:
        assert time.perf_counter() - sent[0] < 1
    while threading.active_count() > before and time.perf_counter() - sent[0] < 1:
        time.sleep(0.001)  # the threads have ended, but for what Python does after them
    assert threading.active_count() == before


@pytest.mark.parametrize("method", ["auto", "batch", "circumcircle", "pessimistic", "optimistic"])
def test_a_thread_that_cannot_start_is_a_memory_error_and_the_next_call_works(method, monkeypatch):
    start, started = threading.Thread.start, []

    def refuse(thread):
        started.append(thread)
        if len(started) % 3 == 0:
            msg = "can't start new thread"  # what Python says where there is no memory for a stack
            raise RuntimeError(msg)
        start(thread)

    before = threading.active_count()
    points = uniform(60_000)
    with monkeypatch.context() as patch:
        patch.setattr(threading.Thread, "start", refuse)
        with pytest.raises(MemoryError, match="refused another thread.*fewer with threads=1"):
            threaded2d.Delaunay(points, method=method, threads=4)
    assert threading.active_count() == before
    assert len(threaded2d.Delaunay(points, method=method, threads=2).triangles) > len(points)
    assert threaded2d.Delaunay(points, method="auto", threads=1).stats.threads == 1  # the advice


def test_other_failures_of_a_start_stay_what_they_are(monkeypatch):
    def refuse(thread):
        msg = "threads can only be started once"
        raise RuntimeError(msg)

    monkeypatch.setattr(threading.Thread, "start", refuse)
    with pytest.raises(RuntimeError, match="only be started once"):
        run_threads([lambda: None], lambda: None)
