"""Callbacks, interruption, and sets that the paper's method cannot finish."""

import itertools

import numpy as np
import pytest

import dt3d
import scanvec as sv
from dt3d.extrapolation import consistency, expansion, loop
from dt3d.extrapolation.exact import decisions

from .exact import check_neighbors


def on_sphere(n):
    points = np.random.default_rng(n).standard_normal((n, 3))
    return points / np.linalg.norm(points, axis=1)[:, None]


def test_progress_is_reported_after_every_iteration():
    seen = []
    points = np.random.default_rng(0).random((100, 3))
    tri = dt3d.Delaunay(points, method="extrapolation", callback=seen.append)
    assert [p.iteration for p in seen] == list(range(1, tri.stats.iterations + 1))
    assert [p.tetrahedra for p in seen] == np.cumsum(tri.stats.tetrahedra_per_iteration).tolist()
    assert seen[-1].remaining == 0
    assert all(p.remaining > 0 for p in seen[:-1])
    assert all(a.seconds < b.seconds for a, b in itertools.pairwise(seen))


def test_the_old_name_of_what_remains_warns():
    progress = dt3d.Progress(1, 5, 3, 0.1)
    with pytest.warns(DeprecationWarning, match="now Progress.remaining"):
        assert progress.open_faces == progress.remaining


@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError])
def test_what_a_callback_raises_ends_the_run_within_an_iteration(error):
    seen = []

    def stop(progress):
        seen.append(progress)
        raise error

    with pytest.raises(error):
        dt3d.Delaunay(np.random.default_rng(0).random((100, 3)), method="extrapolation", callback=stop)
    assert len(seen) == 1


def test_a_set_that_cannot_be_finished_ends_with_an_error_that_counts():
    with pytest.raises(dt3d.InconsistencyError, match=r"\d+ inconsistencies among \d+ tetrahedra") as caught:
        dt3d.Delaunay(on_sphere(2000), robustness="perturb", dtype="float32")
    assert caught.value.inconsistencies > consistency.GIVE_UP_COUNT
    assert "float64" in str(caught.value)


def test_a_few_inconsistencies_are_counted_and_warned_of():
    with pytest.warns(dt3d.InconsistencyWarning, match=r"has \d+ inconsistencies"):
        tri = dt3d.Delaunay(on_sphere(300), robustness="perturb", dtype="float32")
    assert tri.stats.inconsistencies > 0


def test_the_same_spheres_are_finished_in_double_precision():
    tri = dt3d.Delaunay(on_sphere(300), robustness="perturb")
    assert tri.stats.inconsistencies == 0
    check_neighbors(tri)
    assert len(tri.convex_hull) == 2 * 300 - 4  # Euler: all sites are on the hull


def test_a_run_in_circles_ends(monkeypatch):
    """Were open faces never purged, the number of tetrahedra would pass what n sites can have."""
    monkeypatch.setattr(consistency, "GIVE_UP_COUNT", 10**9)
    again = []

    def all_outward(dead, new):
        again.append(1)
        assert len(again) < 1000
        return again_faces[0]

    again_faces = []
    real = expansion.both_sides

    def remember(facets):
        again_faces.append(real(facets))
        return again_faces[0]

    monkeypatch.setattr(expansion, "both_sides", remember)
    monkeypatch.setattr(loop, "open_faces", all_outward)
    monkeypatch.setattr(loop, "insert_dead_faces", lambda dead, new, first: (dead, new, 0))
    with pytest.raises(dt3d.InconsistencyError):
        dt3d.Delaunay(np.random.default_rng(0).random((30, 3)), robustness="perturb", machine=sv.Device())


def test_insertion_reports_every_stretch_and_stops(monkeypatch):
    monkeypatch.setattr("dt3d.insertion.driver.SITES_PER_REPORT", 40)
    monkeypatch.setattr("dt3d.insertion.team.SITES_PER_CALL", 10)
    points = np.random.default_rng(0).random((100, 3))
    seen = []
    dt3d.Delaunay(points, method="insertion", callback=seen.append)
    assert [p.iteration for p in seen] == [1, 2, 3]
    for progress, least in zip(seen, (50, 10, -1), strict=True):
        assert least < progress.remaining <= least + 10  # forty more, and what is left of ten

    def stop(progress):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        dt3d.Delaunay(points, method="insertion", callback=stop)


def test_sites_too_near_for_a_first_facet_end_with_an_error_that_says_so():
    points = np.random.default_rng(0).random((60, 3))
    points[:20] *= 1e-170  # squared areas of triangles with two of these underflow
    with pytest.raises(dt3d.InconsistencyError, match=r"sites are in no tetrahedron|inconsistencies|flat"):
        dt3d.Delaunay(points, robustness="perturb")


def test_thousands_on_one_sphere_are_warned_of(monkeypatch):
    monkeypatch.setattr(decisions, "CROWD", 8)
    with pytest.warns(dt3d.QuadraticSearchWarning, match="nearly cospherical .* method='insertion'"):
        dt3d.Delaunay(on_sphere(100), method="extrapolation")
