"""Each member of SciPy's class beside SciPy's own, in the plane and in space."""

import pickle

import numpy as np
import pytest
import scipy.spatial

import dt3d
from dt3d import threaded2d

from . import families

RNG = np.random.default_rng(5)
SETS = {
    "plane": RNG.random((200, 2)) * 5 - [7, 3],
    "space": RNG.random((200, 3)) * 5 - [7, 3, 2],
    "few in the plane": np.array([[0, 0], [3, 1], [1, 3.0]]),
    "few in space": np.array([[0, 0, 0], [3, 1, 0], [1, 3, 0], [1, 1, 2.0]]),
}
CLASS_MEMBERS = [name for name in dir(scipy.spatial.Delaunay) if not name.startswith("_")]


def pair(name):
    """Ours and SciPy's of one set, and the row in ours of each of SciPy's simplices."""
    ours, theirs = dt3d.Delaunay(SETS[name]), scipy.spatial.Delaunay(SETS[name])
    rows = {tuple(sorted(t)): i for i, t in enumerate(ours.simplices.tolist())}
    return ours, theirs, np.array([rows[tuple(sorted(t))] for t in theirs.simplices.tolist()])


def test_no_member_is_missing():
    theirs = scipy.spatial.Delaunay(SETS["space"])
    names = {*CLASS_MEMBERS, *(name for name in vars(theirs) if not name.startswith("_"))}
    assert len(names) >= 23
    for d in (2, 3):
        tri = dt3d.Delaunay(SETS["space"][:, :d])
        assert not [name for name in sorted(names) if not hasattr(tri, name)]


@pytest.mark.parametrize("name", SETS)
def test_kinds_and_shapes_of_arrays(name):
    ours, theirs, _ = pair(name)
    names = ["points", "simplices", "neighbors", "equations", "coplanar", "good", "convex_hull", "transform"]
    for member in [*names, "vertex_to_simplex", "min_bound", "max_bound"]:
        mine, other = getattr(ours, member), getattr(theirs, member)
        assert (mine.shape, mine.dtype) == (other.shape, other.dtype), member
        with pytest.raises(ValueError, match="read-only"):
            mine[:] = 0
    for mine, other in zip(ours.vertex_neighbor_vertices, theirs.vertex_neighbor_vertices, strict=True):
        assert (mine.shape, mine.dtype) == (other.shape, other.dtype)
    for member in ("ndim", "npoints", "nsimplex", "furthest_site", "paraboloid_scale", "paraboloid_shift"):
        assert type(getattr(ours, member)) is type(getattr(theirs, member)), member


@pytest.mark.parametrize("name", SETS)
def test_values_are_those_of_scipy(name):
    ours, theirs, rows = pair(name)
    d = ours.ndim
    for member in (
        "ndim",
        "npoints",
        "nsimplex",
        "furthest_site",
        "min_bound",
        "max_bound",
        "points",
        "good",
    ):
        np.testing.assert_array_equal(getattr(ours, member), getattr(theirs, member))
    for member in ("paraboloid_scale", "paraboloid_shift"):
        np.testing.assert_allclose(getattr(ours, member), getattr(theirs, member), rtol=1e-13)
    np.testing.assert_allclose(ours.equations[rows], theirs.equations, rtol=1e-7, atol=1e-10)
    x = RNG.uniform(ours.min_bound - 1, ours.max_bound + 1, (3, 5, d))
    np.testing.assert_allclose(ours.lift_points(x), theirs.lift_points(x), rtol=1e-13)
    np.testing.assert_allclose(
        ours.plane_distance(x)[..., rows], theirs.plane_distance(x), rtol=1e-7, atol=1e-9
    )
    found = theirs.find_simplex(x)
    np.testing.assert_array_equal(ours.find_simplex(x), np.where(found < 0, -1, rows[found]))
    np.testing.assert_array_equal(ours.find_simplex(x, True), ours.find_simplex(x, bruteforce=False, tol=0))
    np.testing.assert_array_equal(scipy.spatial.tsearch(ours, x), ours.find_simplex(x))
    for mine, other in zip(ours.vertex_neighbor_vertices, theirs.vertex_neighbor_vertices, strict=True):
        assert len(mine) == len(other)
    facets = [{tuple(sorted(f)) for f in tri.convex_hull.tolist()} for tri in (ours, theirs)]
    assert facets[0] == facets[1]


@pytest.mark.parametrize("name", SETS)
def test_the_map_to_barycentric_coordinates(name):
    tri = dt3d.Delaunay(SETS[name])
    d = tri.ndim
    weights = RNG.dirichlet(np.ones(d + 1), tri.nsimplex)
    x = np.einsum("ij,ijk->ik", weights, tri.points[tri.simplices])
    c = np.einsum("ijk,ik->ij", tri.transform[:, :d], x - tri.transform[:, d])
    # the condition of the matrices is below 1e6 here
    np.testing.assert_allclose(c, weights[:, :d], atol=1e-9)
    np.testing.assert_array_equal(tri.transform[:, d], tri.points[tri.simplices[:, d]])


def test_maps_on_a_grid_where_scipy_has_flat_simplices():
    grid = families.grid(5)
    theirs = scipy.spatial.Delaunay(grid)
    assert np.isnan(theirs.transform).any()
    assert np.isfinite(dt3d.Delaunay(grid).transform).all()


def test_maps_of_slivers_are_nan_as_in_scipy():
    points = np.array([[0, 0], [1, 0], [0.5, 2.0**-50], [0.5, 1]])
    tri = dt3d.Delaunay(points)
    flat = (tri.points[tri.simplices][..., 1].max(axis=1) < 0.5).nonzero()[0]
    assert len(flat) == 1
    assert np.isnan(tri.transform[flat[0], :2]).all()
    assert np.isfinite(np.delete(tri.transform, flat[0], axis=0)).all()


@pytest.mark.parametrize("d", [2, 3])
def test_duplicates(d):
    sites = RNG.random((40, d))
    points = np.concatenate([sites, sites[::2], sites[:1]])
    tri = dt3d.Delaunay(points)
    assert all(k in tri.simplices[t] for k, t in enumerate(tri.vertex_to_simplex[:40]))
    unused, simplex, used = tri.coplanar.T
    np.testing.assert_array_equal(np.column_stack([unused, used]), tri.duplicates)
    np.testing.assert_array_equal(points[unused], points[used])
    assert sorted(unused) == list(range(40, 61))
    assert all(k in tri.simplices[t] for k, t in zip(used, simplex, strict=True))
    np.testing.assert_array_equal(tri.vertex_to_simplex[unused], simplex)


@pytest.mark.parametrize("d", [2, 3])
def test_a_tolerance_takes_in_points_beside_the_hull(d):
    tri = dt3d.Delaunay(np.concatenate([np.zeros((1, d)), np.eye(d)]))
    x = np.full((4, d), 0.1)
    x[:, 0] = [-1e-3, -1e-12, 1e-12, -1.0]
    assert tri.find_simplex(x).tolist() == [-1, -1, 0, -1]
    assert tri.find_simplex(x, tol=1e-9).tolist() == [-1, 0, 0, -1]
    assert tri.find_simplex(x, tol=1e-2).tolist() == [0, 0, 0, -1]
    theirs = scipy.spatial.Delaunay(tri.points)
    np.testing.assert_array_equal(tri.find_simplex(x, tol=1e-9), theirs.find_simplex(x, tol=1e-9))
    many = dt3d.Delaunay(RNG.random((300, d)))
    hull = many.points[many.convex_hull].mean(axis=1)
    outwards = hull + 1e-9 * (hull - 0.5)
    assert (many.find_simplex(outwards) == -1).all()
    assert (many.find_simplex(outwards, tol=1e-4) >= 0).all()
    for tol in (-1, "a", np.nan):
        with pytest.raises(ValueError, match="tol must be a number that is not negative"):
            tri.find_simplex(x, tol=tol)


@pytest.mark.parametrize("d", [2, 3])
def test_scipys_keywords(d):
    points = RNG.random((30, d))
    plain = dt3d.Delaunay(points)
    for options in ("", "Qbb Qc Qz Q12", "Qt Qx", b"Qbb"):
        np.testing.assert_array_equal(dt3d.Delaunay(points, qhull_options=options).simplices, plain.simplices)
    np.testing.assert_array_equal(dt3d.Delaunay(points, False, False, None).simplices, plain.simplices)
    for args, message in [
        ((True,), "furthest_site=True is not served: .*scipy.spatial.Delaunay serves it"),
        ((False, False, "Qbb QJ"), "'Qbb QJ': QJ is not served; it moves the sites at random"),
        ((False, False, "Qbb Q77"), "Q77 is not served; those that change nothing here are Pp Q11"),
        (("insertion",), "furthest_site must be True or False, got 'insertion'"),
        ((False, 2), "incremental must be True or False, got 2"),
        ((False, False, 5), "qhull_options must be a str of options"),
    ]:
        with pytest.raises(ValueError, match=message):
            dt3d.Delaunay(points, *args)
    with pytest.raises(RuntimeError, match="sites cannot be added .* np.concatenate"):
        plain.add_points(points)
    assert plain.close() is None


@pytest.mark.parametrize("options", [{}, {"threads": 1}, {"threads": 2, "seed": 7}, {"method": "insertion"}])
def test_the_plane_has_the_triangles_of_its_own_class(options):
    points = RNG.integers(0, 40, (500, 2))
    tri, other = dt3d.Delaunay(points, **options), threaded2d.Delaunay(points)
    found = [{frozenset(t) for t in made.simplices.tolist()} for made in (tri, other)]
    assert found[0] == found[1]
    assert sorted(tri.duplicates.tolist()) == sorted(other.duplicates.tolist())
    assert tri.triangles is tri.simplices
    assert tri.verify()
    assert isinstance(other, dt3d.Delaunay)
    assert tri.stats.inconsistencies == 0 < tri.stats.seconds["total"]
    assert repr(tri) == f"<dt3d.Delaunay: 500 sites, {tri.nsimplex} triangles>"
    again = pickle.loads(pickle.dumps(tri))
    assert type(again) is dt3d.Delaunay
    np.testing.assert_array_equal(again.vertex_to_simplex, tri.vertex_to_simplex)


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ({"method": "extrapolation"}, "method='extrapolation'"),
        ({"robustness": "perturb"}, "robustness='perturb'"),
        ({"preset": "teng1993"}, "preset='teng1993'"),
        ({"callback": print}, "callback=<built-in function print>"),
    ],
)
def test_options_of_space_are_refused_in_the_plane(options, name):
    with pytest.raises(ValueError, match=f"^{name} goes with points in space"):
        dt3d.Delaunay(RNG.random((30, 2)), **options)


def test_methods_of_the_plane_are_named():
    with pytest.raises(ValueError, match=r"got 'batch'; that is one of dt3d.threaded2d.Delaunay"):
        dt3d.Delaunay(RNG.random((30, 2)), method="batch")


def test_attributes_of_the_other_dimension_say_where_they_are():
    plane, space = dt3d.Delaunay(RNG.random((30, 2))), dt3d.Delaunay(RNG.random((30, 3)))
    with pytest.raises(AttributeError, match=r"in the plane have no iteration: .* there is thread"):
        plane.iteration  # noqa: B018
    for name in ("triangles", "thread", "inserted_by"):
        with pytest.raises(AttributeError, match=f"in space have no {name}: "):
            getattr(space, name)
    with pytest.raises(AttributeError, match="'Delaunay' object has no attribute 'simplexes'"):
        space.simplexes  # noqa: B018


@pytest.mark.parametrize("name", SETS)
def test_an_object_of_scipys_class(name):
    tri = dt3d.Delaunay(SETS[name])
    made = tri.to_scipy()
    assert isinstance(made, scipy.spatial.Delaunay)
    for member in ("simplices", "neighbors", "equations", "transform", "vertex_to_simplex", "convex_hull"):
        mine, other = getattr(tri, member), getattr(made, member)
        if member == "convex_hull":
            mine, other = (np.unique(np.sort(facets), axis=0) for facets in (mine, other))
        np.testing.assert_array_equal(mine, other)
    x = RNG.uniform(tri.min_bound - 0.5, tri.max_bound + 0.5, (200, tri.ndim))
    np.testing.assert_array_equal(made.find_simplex(x), tri.find_simplex(x))
    np.testing.assert_allclose(made.plane_distance(x[0]), tri.plane_distance(x[0]), atol=1e-12)
    made.simplices[:] = 0
    assert tri.verify()


def test_a_scipy_of_other_fields_is_an_error(monkeypatch):
    class Other(scipy.spatial.Delaunay):
        def __init__(self, points):
            super().__init__(points)
            self.more = 1

    monkeypatch.setattr(scipy.spatial, "Delaunay", Other)
    with pytest.raises(ImportError, match="does not know the fields .*: more"):
        dt3d.Delaunay(SETS["plane"]).to_scipy()
