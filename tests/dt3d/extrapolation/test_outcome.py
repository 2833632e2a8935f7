"""Counts add up."""

from dt3d.extrapolation.outcome import Counts, Outcome


def test_counts_and_statistics():
    out = Outcome(per_iteration=[3, 4])
    out.add(Counts(10, 200, 0))
    out.add(Counts(5, 30, 1))
    assert out.counts == Counts(15, 230, 1)
    assert out.tetrahedra == 7
    out.seconds["buckets"] = 0.5
    stats = out.statistics(None, 2.0)
    assert (stats.face_expansions, stats.sites_searched, stats.exact_decisions) == (15, 230, 1)
    assert stats.tetrahedra_per_iteration == (3, 4)
    assert stats.seconds == {"buckets": 0.5, "total": 2.0}
