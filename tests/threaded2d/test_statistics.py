"""What is counted by thread, and what the counts have to do with the triangulation."""

import dataclasses

import pytest

from dt3d import threaded2d
from dt3d.threaded2d import Statistics
from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.driver import triangulate

from .families import uniform


def test_who_inserted_what():
    points = uniform(2000)
    batch = threaded2d.Delaunay(points, method="batch", threads=3)
    assert set(batch.thread.tolist()) == {2}
    assert set(batch.inserted_by.tolist()) == {0, 1}
    assert batch.stats.inserted[:2] == (0, 0)
    assert batch.stats.queue_length == 64
    assert batch.stats.queue_fill > 0
    circle = threaded2d.Delaunay(points, method="circumcircle", threads=4)
    assert circle.stats.accesses >= len(points) - 3


def test_the_circumcircle_method_has_tests_for_each_access():
    # threads that give way at random meet, unless one is done before another begins, as on a busy machine
    options = Options(method="circumcircle", threads=3).contended(2)
    for sites in (2000, 20_000, 200_000):
        stats = triangulate(uniform(sites), options).stats
        if stats.tests > 0:
            break
    assert stats.tests > 0
    assert stats.tests_per_access * stats.accesses == pytest.approx(stats.tests)
    assert stats.corrected == 0 or stats.given_up > 0
    assert threaded2d.Delaunay(uniform(100), method="sequential").stats.tests_per_access == 0


@pytest.mark.parametrize(
    ("method", "threads"),
    [("sequential", 1), ("batch", 3), ("circumcircle", 3), ("pessimistic", 2), ("optimistic", 2)],
)
def test_every_count_by_thread_has_an_entry_for_each(method, threads):
    points = uniform(1000)
    tri = threaded2d.Delaunay(points, method=method, threads=threads)
    stats = tri.stats
    assert (stats.method, stats.threads, stats.order, stats.location) == (method, threads, "brio", "dag")
    for name, value in dataclasses.asdict(stats).items():
        if isinstance(value, tuple):
            assert len(value) == threads, name
            assert min(value) >= 0, name
    assert sum(stats.inserted) == len(points) - 3
    assert set(stats.seconds) == {"input", "order", "insertion", "correction", "extraction", "total"}
    phases = sum(value for name, value in stats.seconds.items() if name != "total")
    assert 0 < phases <= stats.seconds["total"]
    assert sum(stats.location_seconds) > 0
    assert sum(stats.change_seconds) > 0
    if method == "sequential":
        assert stats.waits == stats.retries == (0,)
        assert stats.wait_seconds == (0.0,)
    else:
        assert stats.tests == 0 or method == "circumcircle"
    assert (stats.queue_length > 0) == (method == "batch")


def test_auto_says_what_it_chose():
    stats = threaded2d.Delaunay(uniform(100)).stats
    assert (stats.method, stats.threads, stats.location) == ("sequential", 1, "walk")
    assert (stats.order, stats.subdivision) == ("brio", "curve")
    # in place, location and change are not told apart
    assert stats.location_seconds == stats.change_seconds == (0.0,)


def test_they_stay_as_they_are():
    stats = threaded2d.Delaunay(uniform(100)).stats
    assert isinstance(stats, Statistics)
    with pytest.raises(dataclasses.FrozenInstanceError):
        stats.flips = 0
