"""What is run where an option is left open."""

import pytest

from dt3d.threaded2d import configuration
from dt3d.threaded2d.configuration import WORTH_THREADS, Options, configured, queue_for, searching_threads


@pytest.mark.parametrize(
    ("n", "length"), [(10, 64), (4999, 64), (5000, 256), (10_000, 512), (99_999, 512), (100_000, 1024)]
)
def test_the_queue_s_length_is_the_best_of_table_1(n, length):
    assert queue_for(n) == length
    assert configured(n, method="batch").queue_length == length
    assert configured(n, method="batch", queue_length=7).queue_length == 7


def test_more_searching_threads_for_more_sites_and_never_fewer():
    sizes = [100, 5000, 50_000, 100_001, 1_500_001]
    for processors in (1, 2, 4, 8):
        counts = [searching_threads(n, processors) for n in sizes]
        assert counts == sorted(counts)
        assert counts[-1] == (5 if processors >= 4 else 3)


@pytest.mark.parametrize("cores", [1, 2, 6, 500])
def test_the_default_has_a_thread_for_each_core_where_that_pays(cores, monkeypatch):
    monkeypatch.setattr(configuration, "available_cores", lambda: cores)
    most = min(cores, 64)
    small, large = configured(WORTH_THREADS), configured(WORTH_THREADS + 1)
    assert (small.threads, small.method) == (1, "sequential")
    assert (large.threads, large.method) == (most, "optimistic" if cores > 1 else "sequential")
    for options in (small, large):
        assert options.in_place
        assert (options.order, options.subdivision) == ("brio", "curve")
    assert configured(10, threads=3).threads == 3
    for method in ("circumcircle", "pessimistic", "optimistic"):
        assert configured(10, method=method).threads == most
    assert configured(10, method="sequential").threads == 1
    batch = configured(100_000, method="batch")
    assert batch.threads == searching_threads(100_000, most) + 1
    assert batch.parts == batch.threads - 1


def test_without_a_history_are_the_walking_methods_that_change_in_place():
    in_place = {
        (method, location)
        for method in ("sequential", "batch", "circumcircle", "pessimistic", "optimistic")
        for location in ("dag", "walk")
        if Options(method=method, location=location).in_place
    }
    assert in_place == {("sequential", "walk"), ("optimistic", "walk")}


@pytest.mark.parametrize(
    ("processors", "counts"), [(1, [2, 2, 3, 3, 3]), (2, [2, 2, 3, 3, 3]), (4, [2, 3, 3, 4, 5])]
)
def test_searching_threads_are_those_of_section_4_2(processors, counts):
    sizes = [1000, 5000, 100_000, 100_001, 1_500_001]
    assert [searching_threads(n, processors) for n in sizes] == counts


@pytest.mark.parametrize("cores", [1, 2, 4, 6])
def test_the_preset_is_the_paper_s_own_way(cores, monkeypatch):
    monkeypatch.setattr(configuration, "available_cores", lambda: cores)
    chosen = configured(10_000, preset="kohout2004")
    assert chosen.method == ("batch" if cores <= 4 else "circumcircle")
    for method in ("sequential", "batch", "circumcircle", "pessimistic", "optimistic"):
        o = configured(10_000, method=method, preset="kohout2004")
        assert (o.method, o.order, o.location, o.subdivision) == (method, "random", "dag", "random")
        assert (o.searches, o.fixed_parts, o.queue_parents, o.test_all) == (1, True, True, True)
        assert (o.head_start, o.helping) == (False, False)
        own = configured(10_000, method=method, order="random")
        assert own.searches == (8 if method in ("batch", "circumcircle") else 1)
        assert not any((own.fixed_parts, own.queue_parents, own.test_all, own.helping))
    assert configured(100, method="batch", preset="kohout2004", interleave=4, order="brio").searches == 4
    assert configured(100, method="batch", preset="kohout2004", order="brio").order == "brio"
    walking = configured(100, method="batch", preset="kohout2004", location="walk")
    assert not walking.queue_parents


def test_contention_is_for_tests():
    options = configured(100, method="batch", threads=3)
    assert (options.yield_every, options.helping) == (0, False)
    contended = options.contended(2, helping=True)
    assert (contended.yield_every, contended.helping, contended.threads) == (2, True, 3)
