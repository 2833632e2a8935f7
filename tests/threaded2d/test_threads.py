"""Stopping: Ctrl-C and exceptions end all threads; and atomics count right."""

import os
import signal
import threading
import time

import numba
import numpy as np
import pytest

from dt3d import threaded2d
from dt3d._numba import atomics
from dt3d._numba.threads import run_threads
from dt3d.threaded2d.in_place import star

from .families import uniform


@numba.njit(nogil=True)
def _count(words, rounds, me):
    for _ in range(rounds):
        while not atomics.acquire(words, (0, 0), me):
            pass
        words[1, 0] += 1  # not atomic: the lock has to do it
        atomics.release(words, (0, 0))
        atomics.add(words, (2, 0), 2)


def test_locks_and_additions_of_contending_threads():
    words = atomics.padded(3)
    run_threads([lambda k=k: _count(words, 20_000, k + 1) for k in range(4)], lambda: None)
    assert words[:, 0].tolist() == [0, 80_000, 160_000]


@numba.njit
def _single(words):
    old = atomics.add(words, 0, 2)
    missed = atomics.compare_and_swap(words, 0, 4, 9)
    swapped = atomics.compare_and_swap(words, 0, 5, 7)
    atomics.store_release(words, 1, atomics.load_acquire(words, 0) + 1)
    return old, missed, swapped


def test_atomics_one_by_one():
    words = np.array([3, 0], np.int32)
    assert _single(words) == (3, False, True)
    assert words.tolist() == [7, 8]


def test_only_integers_are_atomic():
    with pytest.raises(numba.TypingError, match="integer arrays"):
        _single(np.zeros(2))


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
