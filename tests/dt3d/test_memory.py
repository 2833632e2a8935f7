"""Memory that is not there: an error that says what was needed, and the next call works."""

import threading

import numpy as np
import pytest

import dt3d


@pytest.fixture
def no_thread(monkeypatch):
    """A system that refuses threads, as under a small `ulimit -v`."""

    def refuse(self):
        msg = "can't start new thread"
        raise RuntimeError(msg)

    monkeypatch.setattr(threading.Thread, "start", refuse)


def test_a_thread_that_the_system_refuses_is_a_memory_error(no_thread, monkeypatch):
    monkeypatch.setattr("dt3d.insertion.loop.available_cores", lambda: 2)
    points = np.random.default_rng(0).random((8000, 3))
    with pytest.raises(MemoryError, match="refused another thread.*threads=1"):
        dt3d.Delaunay(points, threads=2)
    dt3d.Delaunay(points, threads=1)  # as the message advises


def test_a_thread_refused_to_location_is_a_memory_error(no_thread, monkeypatch):
    monkeypatch.setattr("dt3d.location.os.cpu_count", lambda: 2)
    points = np.random.default_rng(0).random((100, 3))
    tri = dt3d.Delaunay(points)
    many = np.random.default_rng(1).random((20_000, 3))
    within = (many >= points.min(axis=0)).all(axis=1) & (many <= points.max(axis=0)).all(axis=1)
    many = many[within][:8192]
    with pytest.raises(MemoryError, match="refused another thread.*fewer than 8192 points"):
        tri.find_simplex(many)
    assert (tri.find_simplex(many[1:]) >= -1).all()  # as the message advises
