"""Threads run to their end, or all stop."""

import threading

import pytest

from dt3d._numba import threads
from dt3d._numba.threads import run_short_tasks, run_threads


def test_results_come_in_the_order_of_the_tasks():
    barrier = threading.Barrier(3)
    tasks = [lambda k=k: (barrier.wait(), k)[1] for k in range(3)]
    assert run_threads(tasks, lambda: None) == [0, 1, 2]


def test_what_one_raises_stops_the_others():
    stopped = threading.Event()

    def failing():
        msg = "here"
        raise ValueError(msg)

    with pytest.raises(ValueError, match="here"):
        run_threads([stopped.wait, failing], stopped.set)


def test_what_the_watch_raises_stops_all(monkeypatch):
    monkeypatch.setattr(threads, "SECONDS_BETWEEN_LOOKS", 0.001)
    stopped = threading.Event()
    looks = []

    def watch():
        looks.append(None)
        if len(looks) == 3:
            msg = "enough"
            raise RuntimeError(msg)

    with pytest.raises(RuntimeError, match="enough"):
        run_threads([stopped.wait, stopped.wait], stopped.set, watch)
    assert stopped.is_set()


def test_one_short_task_runs_in_the_calling_thread():
    ran = []
    run_short_tasks([lambda: ran.append(threading.current_thread())])
    assert ran == [threading.current_thread()]
    run_short_tasks([lambda: ran.append(threading.current_thread())] * 2)
    assert len(set(ran)) >= 2
