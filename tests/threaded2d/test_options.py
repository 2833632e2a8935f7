"""The options of single methods: which go with what, and what the paper's preset makes of them."""

import numpy as np
import pytest

from dt3d import threaded2d
from dt3d.threaded2d.options import KOHOUT2004, METHODS_OF, PlaneOptions, with_preset

from .families import canonical, uniform

GOOD = np.random.default_rng(0).random((20, 2))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"preset": "kohout2003"}, "preset must be 'kohout2004', got 'kohout2003'"),
        ({"preset": "kohout2004", "subdivision": "curve"}, "goes with order='brio', got order='random'"),
        ({"method": "batch", "interleave": 0}, "interleave must be an integer of at least 1, got 0"),
        ({"method": "batch", "interleave": 65}, "at most 64 searches per thread, got 65"),
        ({"method": "optimistic", "interleave": 8}, "interleave=8 goes with method='sequential' or 'batch'"),
        ({"interleave": 8}, "goes with method=.* got 'auto'"),
        ({"method": "sequential", "interleave": 8, "location": "walk"}, "goes with location='dag'"),
        ({"method": "batch", "queued": "parent", "location": "walk"}, "a node of the history"),
        ({"method": "batch", "queued": "node"}, "queued must be 'leaf' or 'parent', got 'node'"),
        ({"method": "circumcircle", "queued": "parent"}, "queued='parent' goes with method='batch'"),
        ({"method": "batch", "tested": "all"}, "tested='all' goes with method='circumcircle', got 'batch'"),
        ({"method": "circumcircle", "tested": "some"}, "tested must be 'outer' or 'all'"),
        ({"method": "circumcircle", "helping": True}, "helping=True goes with method='batch'"),
        ({"method": "batch", "helping": 1}, "helping must be True or False, got 1"),
        ({"method": "batch", "head_start": True}, "head_start=True goes with method='circumcircle'"),
        ({"parts": "equal"}, "parts must be 'shared' or 'fixed', got 'equal'"),
    ],
)
def test_errors_of_options(options, message):
    with pytest.raises(ValueError, match=message):
        threaded2d.Delaunay(GOOD, **options)


def test_an_unknown_option_is_named():
    with pytest.raises(TypeError, match="no option 'interleaved'; did you mean 'interleave'"):
        threaded2d.Delaunay(GOOD, interleaved=8)
    with pytest.raises(TypeError, match="no option 'colour'; there are also queue_length, preset"):
        threaded2d.Delaunay(GOOD, colour="red")


def test_what_is_given_counts_more_than_the_preset():
    assert with_preset({}) == {}
    assert with_preset({"interleave": None}) == {}
    assert with_preset({"preset": "kohout2004"}) == KOHOUT2004 | {"preset": "kohout2004"}
    mixed = with_preset({"preset": "kohout2004", "interleave": 4, "queued": None})
    assert mixed == KOHOUT2004 | {"preset": "kohout2004", "interleave": 4}
    assert set(METHODS_OF) | set(KOHOUT2004) <= set(PlaneOptions.__annotations__)


@pytest.mark.parametrize(
    "method", ["auto", "sequential", "batch", "circumcircle", "pessimistic", "optimistic"]
)
def test_the_preset_finds_the_same_triangles_in_the_paper_s_way(method):
    points = uniform(500)
    want = canonical(threaded2d.Delaunay(points).triangles)
    tri = threaded2d.Delaunay(points, method=method, preset="kohout2004")
    s = tri.stats
    np.testing.assert_array_equal(canonical(tri.triangles), want)
    assert (s.order, s.location, s.interleave, s.parts, s.helping) == ("random", "dag", 1, "fixed", False)
    assert (s.queued, s.tested) == ("parent", "all")
    assert sum(s.visited_by) == s.visited > 0


def test_helping_and_fixed_parts_are_options():
    points = uniform(3000)
    want = canonical(threaded2d.Delaunay(points).triangles)
    tri = threaded2d.Delaunay(points, method="batch", threads=3, queue_length=4, helping=True)
    np.testing.assert_array_equal(canonical(tri.triangles), want)
    assert tri.stats.helping
    tri = threaded2d.Delaunay(points, method="circumcircle", threads=2, parts="fixed", head_start=False)
    # half of the sites each; the three of the first triangle count as of the first thread
    assert np.bincount(tri.inserted_by).tolist() == [1500, 1500]
    assert sum(tri.stats.inserted) == 2997
