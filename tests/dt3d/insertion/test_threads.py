"""One answer from any number of threads, in any interleaving; and threads end when something goes wrong."""

import threading
import time

import numpy as np
import pytest

import dt3d
from dt3d.insertion import driver, team

from ..families import grid, on_sphere, tetrahedra


def with_copies(n):
    sites = np.random.default_rng(n).random((n, 3))
    return np.concatenate([sites, sites[::2], sites[::3]])


SETS = {
    "uniform": np.random.default_rng(7).random((1500, 3)),
    "grid": grid(9),
    "sphere": on_sphere(400),
    "duplicates": with_copies(800),
    "slab": np.random.default_rng(8).random((1500, 3)) * [1, 1, 1e-3],
}


def sets(*names):
    return pytest.mark.parametrize("name", names)


@pytest.fixture
def eight_cores(monkeypatch):
    """As many threads as are asked for, where there are fewer cores."""
    monkeypatch.setattr(driver, "available_cores", lambda: 8)


@pytest.fixture
def yielding(monkeypatch, eight_cores):
    """Pieces, stretches and blocks so small that threads meet often, and random pauses between stretches."""
    monkeypatch.setattr(team, "LEAST_SITES_PER_THREAD", 20)
    monkeypatch.setattr(team, "SITES_PER_CALL", 7)
    monkeypatch.setattr("dt3d._numba.threads.SECONDS_BETWEEN_LOOKS", 0.001)
    monkeypatch.setattr(driver, "LARGEST_BLOCK", 64)
    real = team.insert
    pauses = np.random.default_rng()

    def insert(*arguments):
        if pauses.random() < 0.1:
            time.sleep(pauses.random() * 1e-3)
        return real(*arguments)

    monkeypatch.setattr(team, "insert", insert)


def assert_one_answer(points, runs):
    want = dt3d.Delaunay(points, threads=1)
    assert want.stats.deferred == 0
    deferred = 0
    for run in range(runs):
        tri = dt3d.Delaunay(points, threads=2 + run % 7, seed=run)
        np.testing.assert_array_equal(tetrahedra(tri), tetrahedra(want))
        np.testing.assert_array_equal(tri.duplicates, want.duplicates)
        assert tri.stats.threads == 2 + run % 7
        deferred += tri.stats.deferred
    assert deferred > 0
    assert tri.verify(), tri.verify()
    assert threading.active_count() == 1


@sets(*SETS)
def test_one_answer(name, yielding):
    assert_one_answer(SETS[name], 7)


@pytest.mark.slow
@sets("uniform", "grid", "sphere", "duplicates")
def test_one_answer_300_times(name, yielding):
    assert_one_answer(SETS[name], 75)


def test_one_answer_at_full_speed(eight_cores):
    points = np.random.default_rng(1).random((60_000, 3))
    want = dt3d.Delaunay(points, threads=1)
    for threads in (2, 3, 8):
        tri = dt3d.Delaunay(points, threads=threads)
        np.testing.assert_array_equal(tetrahedra(tri), tetrahedra(want))
        assert 0 < tri.stats.deferred < 60_000


def test_no_more_threads_than_cores(monkeypatch):
    monkeypatch.setattr(driver, "available_cores", lambda: 2)
    for asked, got in ((1, 1), (2, 2), (8, 2), (None, 1)):
        assert dt3d.Delaunay(SETS["uniform"], threads=asked).stats.threads == got


def test_memory_grows_between_passes(yielding, monkeypatch):
    monkeypatch.setattr(driver, "SLOTS_PER_SITE", 1)
    points = SETS["uniform"]
    tri = dt3d.Delaunay(points, threads=3)
    np.testing.assert_array_equal(tetrahedra(tri), tetrahedra(dt3d.Delaunay(points, threads=1)))


@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError])
def test_what_a_callback_raises_ends_all_threads(error, yielding, monkeypatch):
    monkeypatch.setattr(driver, "SITES_PER_REPORT", 100)

    def stop(progress):
        raise error

    with pytest.raises(error):
        dt3d.Delaunay(SETS["uniform"], threads=4, callback=stop)
    assert threading.active_count() == 1


def test_what_one_thread_raises_ends_the_others(yielding, monkeypatch):
    real = team.insert
    calls = []

    def insert(*arguments):
        calls.append(threading.current_thread())
        if len(calls) == 60:
            raise MemoryError
        return real(*arguments)

    monkeypatch.setattr(team, "insert", insert)
    with pytest.raises(MemoryError):
        dt3d.Delaunay(SETS["uniform"], threads=4)
    assert calls[59] is not threading.main_thread()
    assert threading.active_count() == 1


def test_progress_of_threads(yielding, monkeypatch):
    monkeypatch.setattr(driver, "SITES_PER_REPORT", 100)
    seen = []
    dt3d.Delaunay(SETS["uniform"], threads=4, callback=seen.append)
    assert [p.iteration for p in seen] == list(range(1, len(seen) + 1))
    left = [p.remaining for p in seen]
    assert left == sorted(left, reverse=True)
    assert left[-1] == 0
    assert len(seen) > 3


@pytest.mark.parametrize("threads", [0, -1, 1.5, "2", True])
def test_numbers_of_threads_that_are_none(threads):
    with pytest.raises(ValueError, match="threads must be a positive integer"):
        dt3d.Delaunay(np.eye(3), threads=threads)


def test_threads_go_with_insertion():
    points = np.random.default_rng(0).random((20, 3))
    with pytest.raises(ValueError, match="threads=2 goes with method='insertion'"):
        dt3d.Delaunay(points, method="extrapolation", threads=2)
    assert dt3d.Delaunay(points).stats.threads == 1  # more do not pay
