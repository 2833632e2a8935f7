"""Triangulations that take more sites: after each step the same as from scratch."""

import copy
import pickle
import threading

import numpy as np
import pytest

import dt3d
from dt3d import _living
from dt3d.insertion.growing import Growing

RNG = np.random.default_rng(5)


def in_order(simplices):
    """Rows ascending, and vertices within them; orientation is tested elsewhere."""
    rows = np.sort(simplices, axis=1)
    return rows[np.lexsort(rows.T[::-1])]


def assert_as_from_scratch(tri, points):
    scratch = dt3d.Delaunay(points)
    np.testing.assert_array_equal(tri.points, points)
    np.testing.assert_array_equal(in_order(tri.simplices), in_order(scratch.simplices))
    np.testing.assert_array_equal(in_order(tri.convex_hull), in_order(scratch.convex_hull))
    np.testing.assert_array_equal(tri.duplicates, scratch.duplicates)
    report = tri.verify()
    assert report, str(report)


def steps(rng, d, kind):
    """The first sites, which do not lie on a plane, and those of further steps."""
    counts = [int(rng.integers(d + 2, 200)), *rng.integers(0, 60, 4).tolist()]
    if kind == "uniform":
        sets = [rng.random((k, d)) for k in counts]
    elif kind == "lattice":  # ties, and more duplicates than not
        sets = [rng.integers(0, 4, (k, d)).astype(float) for k in counts]
    elif kind == "outwards":  # each step is beyond the hull of the one before
        sets = [rng.normal(size=(k, d)) * 1.7**i for i, k in enumerate(counts)]
    elif kind == "twins":  # a site, itself, and itself moved by an ulp or two
        sets = [np.repeat(rng.random((k, d)), 3, axis=0)[:k] for k in counts]
        sets = [np.nextafter(p, rng.integers(0, 2, p.shape)) for p in sets]
    else:  # "plane": new sites on a face of the hull
        sets = [rng.random((k, d)) for k in counts]
        for points in sets:
            points[rng.random(len(points)) < 0.5, 0] = 0.0
    corners = np.vstack([np.zeros(d), np.eye(d)])
    return [np.vstack([corners, sets[0]]), *sets[1:]]


@pytest.mark.parametrize("kind", ["uniform", "lattice", "outwards", "twins", "plane"])
@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("seed", range(4))
def test_each_step_is_as_from_scratch(d, kind, seed):
    first, *more = steps(np.random.default_rng(seed), d, kind)
    tri = dt3d.Delaunay(first, incremental=True, seed=seed)
    assert_as_from_scratch(tri, first)
    for points in more:
        so_far = np.vstack([tri.points, points])
        tri.add_points(points)
        assert_as_from_scratch(tri, so_far)


def test_several_steps_at_once_and_one_site_at_a_time():
    points = RNG.random((260, 3))
    tri = dt3d.Delaunay(points[:200], incremental=True)
    for k in range(200, 250):
        tri.add_points(points[k : k + 1])
    tri.add_points(points[250:])
    tri.add_points([])
    tri.add_points(np.empty((0, 3)))
    assert_as_from_scratch(tri, points)


@pytest.mark.parametrize("d", [2, 3])
def test_from_a_simplex_on(d):
    points = np.vstack([np.eye(d + 1, d), RNG.integers(-3, 4, (20, d))])
    tri = dt3d.Delaunay(points[: d + 1], incremental=True)
    for k in range(d + 1, len(points)):
        tri.add_points(points[k : k + 1])
        assert_as_from_scratch(tri, points[: k + 1])


def test_large_sets_by_threads_go_on():
    points = RNG.random((40_000, 3))
    tri = dt3d.Delaunay(points[:30_000], incremental=True, threads=2)
    assert tri.stats.threads <= 2
    tri.add_points(points[30_000:])
    assert_as_from_scratch(tri, points)
    assert tri.stats.created > len(tri.simplices)


def going_on(monkeypatch):
    """How many times a store was made, and how many times sites were added to one."""
    calls = {"made": 0, "added": 0}
    init, add = Growing.__init__, Growing.add

    def count_init(self, *args):
        calls["made"] += 1
        init(self, *args)

    def count_add(self, sites):
        calls["added"] += 1
        add(self, sites)

    monkeypatch.setattr(Growing, "__init__", count_init)
    monkeypatch.setattr(Growing, "add", count_add)
    return calls


@pytest.mark.parametrize(
    ("scale", "calls"),
    [
        (1.0, {"made": 1, "added": 1}),
        (2.0**200, {"made": 1, "added": 1}),
        (1e-280, {"made": 1, "added": 1}),
        (1e300, {"made": 1, "added": 1}),
    ],
)
def test_coordinates_of_any_size_go_on(monkeypatch, scale, calls):
    points = RNG.random((60, 3)) * scale
    points[0] = scale
    seen = going_on(monkeypatch)
    tri = dt3d.Delaunay(points[:50], incremental=True)
    tri.add_points(points[50:])
    tri.simplices  # noqa: B018  made when it is asked for
    assert seen == calls
    assert_as_from_scratch(tri, points)


@pytest.mark.parametrize("k", [1, 5])
@pytest.mark.parametrize("thickness", [1e-30, 2e-307])
def test_sites_far_from_a_thin_set(thickness, k):
    points = np.vstack([RNG.random((50, 3)) * [1, 1, thickness], RNG.random((k, 3))])
    tri = dt3d.Delaunay(points[:50], incremental=True)
    tri.add_points(points[50:])
    assert_as_from_scratch(tri, points)


def test_where_it_cannot_go_on_it_begins_again(monkeypatch):
    points = RNG.random((100, 3))
    larger, finer, many = points[50:60] * 1e6, points[60:64] * 1e-300, points[50:]
    for more in (larger, many):
        seen = going_on(monkeypatch)
        tri = dt3d.Delaunay(points[:50], incremental=True)
        tri.add_points(more)
        assert_as_from_scratch(tri, np.vstack([points[:50], more]))
        assert (seen["made"], seen["added"]) == (2, 0)
    huge = np.vstack([points[:50] * 1e300, finer])  # no power of two brings all of them near 1
    tri = dt3d.Delaunay(huge, incremental=True)
    tri.add_points(points[64:])
    assert_as_from_scratch(tri, np.vstack([huge, points[64:]]))


def test_restart_begins_again(monkeypatch):
    points = RNG.random((60, 3))
    seen = going_on(monkeypatch)
    tri = dt3d.Delaunay(points[:50], incremental=True)
    tri.add_points(points[50:], restart=True)
    assert len(tri.simplices)
    assert seen == {"made": 2, "added": 0}
    assert_as_from_scratch(tri, points)
    with pytest.raises(ValueError, match="restart must be True or False, got 'yes'"):
        tri.add_points(points, restart="yes")


@pytest.mark.parametrize("d", [2, 3])
def test_what_was_given_out_stays(d):
    points = RNG.random((60, d))
    tri = dt3d.Delaunay(points[:50], incremental=True)
    old = {
        name: getattr(tri, name) for name in ("points", "simplices", "neighbors", "convex_hull", "volumes")
    }
    kept = {name: array.copy() for name, array in old.items()}
    tri.add_points(points[50:])
    assert len(tri.volumes) == len(tri.simplices) > len(kept["simplices"])
    for name, array in old.items():
        np.testing.assert_array_equal(array, kept[name])
        assert not getattr(tri, name).flags.writeable
    with pytest.raises(AttributeError, match="cannot be assigned"):
        tri.points = points


@pytest.mark.parametrize("d", [2, 3])
def test_copies_and_pickles_are_finished(d):
    points = RNG.random((60, d))
    tri = dt3d.Delaunay(points[:50], incremental=True)
    tri.add_points(points[50:55])
    for finished in (copy.copy(tri), copy.deepcopy(tri), pickle.loads(pickle.dumps(tri))):
        assert_as_from_scratch(finished, points[:55])
        with pytest.raises(RuntimeError, match="make it with incremental=True"):
            finished.add_points(points[55:])
    tri.add_points(points[55:])
    assert_as_from_scratch(tri, points)


@pytest.mark.parametrize("d", [2, 3])
def test_close_ends_it(d):
    points = RNG.random((60, d))
    tri = dt3d.Delaunay(points[:50], incremental=True)
    tri.add_points(points[50:])
    tri.close()
    tri.close()
    assert_as_from_scratch(tri, points)
    with pytest.raises(RuntimeError, match="sites cannot be added"):
        tri.add_points(points)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([[0.0, np.nan, 1.0]], "points must be finite: 1 rows"),
        ([[0.0, 1.0]], "shape"),
        ([0.0, 1.0, 2.0], "shape"),
        ("abc", "points must be numbers"),
        ([[2**60 + 1, 0, 0]], "float64"),
    ],
)
def test_what_is_refused_changes_nothing(points, message):
    first = RNG.random((20, 3))
    tri = dt3d.Delaunay(first, incremental=True)
    with pytest.raises(ValueError, match=message):
        tri.add_points(points)
    assert_as_from_scratch(tri, first)
    tri.add_points(first + 1e-3)
    assert_as_from_scratch(tri, np.vstack([first, first + 1e-3]))


def test_an_interrupted_step_is_not_half_done(monkeypatch):
    points = RNG.random((60, 3))
    tri = dt3d.Delaunay(points[:50], incremental=True)

    def interrupted(self, sites):
        self._run.store.add_sites(np.zeros(40))
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr(Growing, "add", interrupted)
        with pytest.raises(KeyboardInterrupt):
            tri.add_points(points[50:])
    assert_as_from_scratch(tri, points[:50])
    tri.add_points(points[50:])
    assert_as_from_scratch(tri, points)


def test_too_many_sites(monkeypatch):
    monkeypatch.setattr(_living, "MOST_SITES", 55)
    points = RNG.random((60, 3))
    tri = dt3d.Delaunay(points[:50], incremental=True)
    with pytest.raises(ValueError, match="these are 50 and 10 more"):
        tri.add_points(points[50:])
    tri.add_points(points[50:55])
    assert_as_from_scratch(tri, points[:55])


@pytest.mark.parametrize(
    "options", [{"method": "extrapolation"}, {"robustness": "perturb"}, {"callback": print}]
)
def test_only_insertion_goes_on(options):
    with pytest.raises(ValueError, match="incremental=True goes with insertion"):
        dt3d.Delaunay(RNG.random((20, 3)), incremental=True, **options)


def test_sites_on_a_plane_are_refused_at_first():
    with pytest.raises(dt3d.DegenerateInputError):
        dt3d.Delaunay(RNG.random((20, 3)) * [1, 1, 0], incremental=True)


@pytest.mark.parametrize("d", [2, 3])
def test_threads_may_add_and_look_at_the_same_time(d):
    points = RNG.random((400, d))
    tri = dt3d.Delaunay(points[:200], incremental=True)
    wrong = []

    def add(k):
        for i in range(200 + k, 400, 3):
            tri.add_points(points[i : i + 1])

    def look():
        for _ in range(60):
            simplices = tri.simplices
            if not len(simplices) or simplices.max() >= 400:
                wrong.append(simplices)

    threads = [threading.Thread(target=add, args=(k,)) for k in range(3)] + [threading.Thread(target=look)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong
    assert tri.npoints == 400
    np.testing.assert_array_equal(in_order(tri.points), in_order(points))
    assert_as_from_scratch(tri, tri.points)


def test_no_memory_for_more_sites_changes_nothing(monkeypatch):
    points = RNG.random((60, 3))
    tri = dt3d.Delaunay(points[:20], incremental=True)

    def refuse(*_):
        raise MemoryError

    with monkeypatch.context() as patch:
        patch.setattr(_living.np, "empty", refuse)
        with pytest.raises(MemoryError):
            tri.add_points(points[20:])
    assert_as_from_scratch(tri, points[:20])
