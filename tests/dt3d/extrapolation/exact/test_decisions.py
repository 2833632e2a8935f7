"""Exact decisions: in any batches, and needed."""

import numpy as np
import pytest

import dt3d
import scanvec as sv
from dt3d.extrapolation.exact import decisions
from dt3d.extrapolation.exact.expansion import FILTERED
from dt3d.extrapolation.warrants import NO_SITE

from .modes import MACHINE, SETS, lexicographic


def test_decisions_do_not_depend_on_batches(monkeypatch):
    points = lexicographic(SETS["tenths"])
    want = dt3d.Delaunay(points, machine=MACHINE)
    monkeypatch.setattr("dt3d.extrapolation.tree.boxes.MOST_NODE_REQUESTS", 64)
    got = dt3d.Delaunay(points, machine=MACHINE)
    np.testing.assert_array_equal(got.simplices, want.simplices)
    assert got.stats.exact_decisions == want.stats.exact_decisions > 0


def test_without_exact_decisions_the_result_is_wrong(monkeypatch):
    """Were the filter's first guess taken where it leaves several, faces would contradict each other."""

    def guess(exact, queries):
        nobody = MACHINE.full(len(queries.high), NO_SITE, np.int32)
        corners = [sv.get(exact.buckets.sites, v) for v in queries.query.face]
        result = decisions.search_faces(exact.buckets, queries.query, corners, FILTERED)
        return result.best.site, nobody, result.sites_searched

    monkeypatch.setattr(decisions, "_decide", guess)
    with pytest.raises(dt3d.InternalError, match="contradict others, which exact decisions exclude"):
        dt3d.Delaunay(SETS["tenths"], machine=MACHINE)
