"""The filter, exact decisions and checked first facets, against integers."""

import numpy as np
import pytest

import dt3d
import scanvec as sv
from dt3d._input import exactly_scaled
from dt3d.extrapolation import loop
from dt3d.extrapolation.buckets import bucket
from dt3d.extrapolation.exact import decisions
from dt3d.extrapolation.exact.expansion import FILTERED, open_face
from dt3d.extrapolation.exact.first_facets import checked_facets
from dt3d.extrapolation.exact.sites import ExactSites
from dt3d.extrapolation.faces import Face
from dt3d.extrapolation.points import Point
from dt3d.extrapolation.warrants import NO_SITE

from ..exact import integers, orient, validate
from ..families import grid, tetrahedra

MACHINE = sv.Device()
RNG = np.random.default_rng(0)


def exact_sites(points):
    """Sites of rows in lexicographic order."""
    points = exactly_scaled(points)
    return ExactSites(bucket(Point(*(MACHINE.vector(c.copy()) for c in points.T))), points)


def lexicographic(points):
    return np.unique(points, axis=0)


SETS = {
    "uniform": RNG.random((60, 3)),
    "lattice": RNG.integers(0, 5, (60, 3)).astype(float),
    "tenths": RNG.integers(0, 5, (60, 3)) * 0.1,
    "far": RNG.integers(0, 5, (60, 3)) + 2.0**40,
    "nearly flat": np.c_[RNG.random((60, 2)), 1e-12 * RNG.random(60)],
    "two scales": RNG.random((60, 3)) * np.repeat([1.0, 2.0**-60], 30)[:, None],
    "an ulp": 1 + np.ldexp(RNG.integers(0, 4, (60, 3)), -52),
}


def signed_distances(points, a, b, c, d):
    """Numerator and denominator of s(d), times |N|^2, in Python integers; arrays over d."""
    p = integers(points)
    u, v, w = p[b] - p[a], p[c] - p[a], p[d] - p[a]
    normal = np.cross(u, v)
    area = normal @ normal
    centre = np.cross((u @ u) * v - (v @ v) * u, normal)  # 2 |N|^2 o
    return (w * (w * area - centre)).sum(axis=-1), (w @ normal) * area


@pytest.mark.parametrize("name", SETS)
def test_bounds_hold_the_signed_distance(name):
    """Every certain comparison of two sites above a face is right in exact arithmetic."""
    points = lexicographic(SETS[name])
    exact = exact_sites(points)
    n = len(points)
    rng = np.random.default_rng(1)
    faces = np.array([rng.permutation(n)[:3] for _ in range(40)], np.int32)
    rank = exact.rank.to_numpy()
    index = np.argsort(rank).astype(np.int32)  # where each row of `points` went
    compared = 0
    for a, b, c in faces:
        face = Face(*(MACHINE.vector(np.full(n, index[v], np.int32)) for v in (a, b, c)))
        corners = (sv.get(exact.buckets.sites, v) for v in face)
        query = MACHINE.map(open_face, face, *corners, exact.lattice)
        bounds = MACHINE.map(FILTERED.score, query, exact.buckets.sites, MACHINE.iota(n))
        low, high = (v.to_numpy() for v in bounds)
        others = np.setdiff1d(np.arange(n), [a, b, c])
        p = integers(points)
        sign = orient(p[a], p[b], p[c], p[others])
        low, high = low[index[others]], high[index[others]]
        above = sign > 0
        assert np.isinf(high[~above]).all()
        top, bottom = signed_distances(points, a, b, c, others[above])
        low, high = low[above], high[above]
        # s_i = top_i / bottom_i, bottom > 0: certain order of the bounds must be that of the fractions
        certain = high[:, None] < low
        wrong = (top[:, None] * bottom >= top * bottom[:, None]).astype(bool)
        assert not (certain & wrong).any()
        compared += certain.sum()
    assert compared > (0 if name == "an ulp" else 1000)


@pytest.mark.parametrize("name", SETS)
def test_equals_insertion(name):
    tri = dt3d.Delaunay(SETS[name], method="extrapolation")
    validate(tri)
    want = dt3d.Delaunay(SETS[name], method="insertion")
    np.testing.assert_array_equal(tetrahedra(tri), tetrahedra(want))
    assert tri.stats.exact_decisions <= tri.stats.face_expansions
    if name == "uniform":
        assert tri.stats.exact_decisions == 0


def test_lattices_are_seen():
    assert exact_sites(lexicographic(SETS["lattice"])).lattice
    assert exact_sites(lexicographic(grid(5) * 2.0**-70)).lattice
    assert exact_sites(lexicographic(SETS["far"])).lattice
    assert not exact_sites(lexicographic(SETS["tenths"])).lattice
    assert not exact_sites(lexicographic(grid(3) * [2.0**17, 1, 1])).lattice


@pytest.mark.parametrize("factor", [2.0**-210, 2.0**-1070])
def test_sites_too_close_for_floating_point_are_an_error_that_says_so(factor):
    points = SETS["uniform"] * np.repeat([1, factor], 30)[:, None]
    with pytest.raises(ValueError, match=r"at least 2\^-200 of the greatest .* method='insertion'"):
        dt3d.Delaunay(points, machine=MACHINE)
    validate(dt3d.Delaunay(points))


@pytest.mark.parametrize("name", ["uniform", "lattice", "tenths"])
def test_wrong_first_facets_are_repaired(name, monkeypatch):
    """b is right and c the site furthest from both: facets that hardly ever are Delaunay."""
    real = loop.first_facets
    wrong = []

    def far_off(buckets):
        a, b, _ = real(buckets)
        sites = np.stack([v.to_numpy() for v in buckets.sites], axis=1)
        ends = sites[a.to_numpy()], sites[b.to_numpy()]
        distance = sum(np.linalg.norm(sites - e[:, None], axis=2) for e in ends)
        wrong.append((a, b, MACHINE.vector(distance.argmax(axis=1).astype(np.int32))))
        return wrong[-1]

    monkeypatch.setattr(loop, "first_facets", far_off)
    points = lexicographic(SETS[name])
    tri = dt3d.Delaunay(points, machine=MACHINE)
    assert len(wrong) == 1
    validate(tri)
    np.testing.assert_array_equal(tetrahedra(tri), tetrahedra(dt3d.Delaunay(points)))


def test_checked_facets_are_delaunay():
    points = lexicographic(SETS["lattice"])
    exact = exact_sites(points)
    start, counts = checked_facets(exact, loop.initial_facets(exact.buckets))
    origin = exact.buckets.origin.to_numpy()
    faces = origin[np.stack([v.to_numpy() for v in start.faces], axis=1)]
    site = start.site.to_numpy()
    found = np.c_[faces, origin[site]][site != NO_SITE]
    want = {tuple(sorted(t)) for t in dt3d.Delaunay(points).simplices.tolist()}
    assert len(found)
    assert {tuple(sorted(t)) for t in found.tolist()} <= want
    assert counts.face_expansions >= len(faces)


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
        best, searched = decisions.search_faces(exact.buckets, queries.query, corners, FILTERED)
        return best.site, nobody, searched

    monkeypatch.setattr(decisions, "_decide", guess)
    with pytest.raises(dt3d.InternalError, match="contradict others, which exact decisions exclude"):
        dt3d.Delaunay(SETS["tenths"], machine=MACHINE)
