"""Which tetrahedron contains a point, and which vertices are joined."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import scipy.spatial
from hypothesis import given, settings
from hypothesis import strategies as st

import dt3d
from dt3d import location, threaded2d

from . import families
from .exact import integers, orient


def assert_located(tri, points, found):
    """Exactly: what was found contains the points, and those outside are beyond a facet of the hull."""
    both = integers(np.concatenate([tri.points, points]))
    sites, points = both[: len(tri.points)], both[len(tri.points) :]
    inside = found >= 0
    corners = sites[tri.simplices[found[inside]]]
    for k in range(4):
        replaced = [points[inside] if i == k else corners[:, i] for i in range(4)]
        assert (orient(*replaced) >= 0).all()
    a, b, c = (sites[tri.convex_hull[:, i]] for i in range(3))
    for p in points[~inside]:
        assert (orient(a, b, c, np.broadcast_to(p, a.shape)) > 0).any()


def special_points(tri):
    """Vertices, and middles of edges, facets and tetrahedra, where sites are multiples of twelve."""
    corners = tri.points[tri.simplices]
    middles = [corners[:, :k].sum(axis=1) / k for k in (2, 3, 4)]
    return np.concatenate([tri.points, *middles])


@pytest.mark.parametrize(
    "sites",
    [
        families.grid(4),
        families.octahedron(),
        families.skew_lines(6),
        families.rings(7, 3),
        families.plane_and_apex(5),
    ],
    ids=["grid", "octahedron", "skew lines", "rings", "plane and apex"],
)
def test_points_on_vertices_edges_and_facets(sites):
    tri = dt3d.Delaunay(12 * sites)
    points = special_points(tri)
    found = tri.find_simplex(points)
    assert found.dtype == np.int32
    assert_located(tri, points, found)
    outwards = points + 1e-9 * (points - points.mean(axis=0))
    assert_located(tri, outwards, tri.find_simplex(outwards))


@pytest.mark.parametrize("options", [{}, {"method": "extrapolation"}, {"robustness": "perturb"}])
def test_scipy_finds_the_same(options):
    rng = np.random.default_rng(0)
    sites, points = rng.random((500, 3)), 1.4 * rng.random((3000, 3)) - 0.2
    tri = dt3d.Delaunay(sites, **options)
    assert_scipy_finds_the_same(tri, tri.simplices, points)


def assert_scipy_finds_the_same(tri, simplices, points):
    theirs = scipy.spatial.Delaunay(tri.points)
    found, expected = tri.find_simplex(points), theirs.find_simplex(points)
    np.testing.assert_array_equal(found < 0, expected < 0)
    inside = found >= 0
    assert 500 < inside.sum() < 2500
    np.testing.assert_array_equal(
        np.sort(simplices[found[inside]], axis=1), np.sort(theirs.simplices[expected[inside]], axis=1)
    )


integer_points = st.lists(st.tuples(*[st.integers(-3, 3)] * 3), min_size=1, max_size=20)


@given(st.lists(st.tuples(*[st.integers(-2, 2)] * 3), min_size=4, max_size=14), integer_points)
@settings(max_examples=150, deadline=None)
def test_any_integer_points(sites, points):
    try:
        tri = dt3d.Delaunay(sites)
    except dt3d.DegenerateInputError:
        return
    points = np.array(points, float)
    assert_located(tri, points, tri.find_simplex(points))


def test_shapes_and_kinds_of_points():
    tri = dt3d.Delaunay(families.grid(3))
    assert tri.find_simplex([0.5, 0.5, 0.5]).shape == ()
    assert tri.find_simplex(np.full((2, 5, 3), 0.5)).shape == (2, 5)
    assert tri.find_simplex(np.empty((0, 3))).shape == (0,)
    assert tri.find_simplex([[1, 1, 1], [9, 9, 9]])[1] == dt3d.OUTSIDE
    assert (tri.find_simplex([[1e300, 0, 0], [5e-324, -5e-324, 0], [-1e300, 1e300, 0]]) == -1).all()


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([1, 2], r"shape \(\.\.\., 3\), got \(2,\)"),
        (3.0, r"shape \(\.\.\., 3\), got \(\)"),
        ([["a", "b", "c"]], "real numbers"),
        (np.ma.masked_equal([[1.0, 2.0, 3.0]], 2), "masked"),
    ],
)
def test_errors(points, message):
    with pytest.raises(ValueError, match=message):
        dt3d.Delaunay(families.grid(2)).find_simplex(points)


@pytest.mark.parametrize("dimension", [2, 3])
def test_points_that_are_not_finite_are_outside_as_in_scipy(dimension):
    tri = dt3d.Delaunay(np.random.default_rng(0).random((50, dimension)))
    xi = np.full((4, 2, dimension), 0.5)
    xi[0, 1, 0], xi[1, 0, -1], xi[3, 1, 1] = np.nan, np.inf, -np.inf
    found = tri.find_simplex(xi)
    finite = np.isfinite(xi).all(axis=-1)
    assert (found[finite] >= 0).all()
    assert (found[~finite] == dt3d.OUTSIDE).all()
    np.testing.assert_array_equal(tri.find_simplex(xi, tol=0.1), found)
    np.testing.assert_array_equal(tri.subset(np.ones(tri.nsimplex, bool)).find_simplex(xi), found)


@pytest.mark.parametrize("scale", [1e-300, 1e300, 1.0])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_any_scale(scale, offset):
    rng = np.random.default_rng(1)
    sites, points = (
        (rng.random((60, 3)) + offset) * scale,
        (1.2 * rng.random((200, 3)) - 0.1 + offset) * scale,
    )
    tri = dt3d.Delaunay(sites)
    assert_located(tri, points, tri.find_simplex(points))


def test_in_the_plane():
    rng = np.random.default_rng(5)
    sites, points = rng.random((500, 2)), 1.4 * rng.random((3000, 2)) - 0.2
    tri = threaded2d.Delaunay(sites)
    assert_scipy_finds_the_same(tri, tri.triangles, points)
    found = tri.find_simplex(sites)
    assert (tri.triangles[found] == np.arange(500)[:, None]).any(axis=1).all()
    with pytest.raises(ValueError, match=r"shape \(\.\.\., 2\), got \(3,\)"):
        tri.find_simplex([1, 2, 3])


@pytest.mark.parametrize("d", [2, 3])
def test_any_number_of_points_is_taken_some_at_a_time(monkeypatch, d):
    rng = np.random.default_rng(7)
    sites, points = rng.random((300, d)), 1.2 * rng.random((1000, d)) - 0.1
    tri = dt3d.Delaunay(sites) if d == 3 else threaded2d.Delaunay(sites)
    together = tri.find_simplex(points)
    monkeypatch.setattr(location, "POINTS_AT_A_TIME", 64)
    np.testing.assert_array_equal(tri.find_simplex(points), together)
    monkeypatch.setattr("dt3d._input.MOST_SITES", 500)  # a limit of sites, not of what is located
    np.testing.assert_array_equal(tri.find_simplex(points.reshape(10, 100, d)), together.reshape(10, 100))


@pytest.mark.parametrize("kind", [np.asfortranarray, lambda p: p[::-1], lambda p: p.astype(np.float32), list])
def test_points_to_be_located_in_any_layout(kind):
    rng = np.random.default_rng(8)
    tri, points = dt3d.Delaunay(rng.random((100, 3))), kind(rng.random((200, 3)))
    if isinstance(points, np.ndarray):
        points.flags.writeable = False
    wanted = [int(tri.find_simplex(np.array(point, float))) for point in points]
    np.testing.assert_array_equal(tri.find_simplex(points), wanted)


def test_callers_in_several_threads():
    rng = np.random.default_rng(6)
    tri, points = dt3d.Delaunay(rng.random((1000, 3))), rng.random((2000, 3))
    want = tri.find_simplex(points)
    with ThreadPoolExecutor(4) as pool:
        for found in pool.map(lambda _: [int(tri.find_simplex(p)) for p in points], range(4)):
            np.testing.assert_array_equal(found, want)


def test_many_points_by_several_threads(monkeypatch):
    rng = np.random.default_rng(2)
    tri, points = dt3d.Delaunay(rng.random((2000, 3))), rng.random((5000, 3))
    alone = tri.find_simplex(points)
    monkeypatch.setattr(location, "LEAST_POINTS_PER_THREAD", 500)
    monkeypatch.setattr(location, "available_cores", lambda: 7)
    several = location.Locator(tri.points, tri.simplices, tri.neighbors)
    np.testing.assert_array_equal(several.find(points), alone)
    assert min(several.last) > 0


def test_a_mesh_with_a_hole_is_searched_where_no_walk_ends():
    tri = dt3d.Delaunay(np.random.default_rng(3).random((200, 3)))
    points = tri.points[tri.simplices].mean(axis=1)
    hole = int(tri.find_simplex([0.5, 0.5, 0.5]))
    keep = np.arange(len(tri.simplices)) != hole
    number = np.append(np.cumsum(keep) - 1, -1)
    number[hole] = -1
    simplices, neighbors = tri.simplices[keep], number[tri.neighbors[keep]].astype(np.int32)
    found = location.Locator(tri.points, simplices, neighbors, convex=False).find(points)
    np.testing.assert_array_equal(found, number[: len(keep)])


@pytest.mark.parametrize(
    "sites", [families.grid(4), np.random.default_rng(4).random((300, 3))], ids=["grid", "random"]
)
def test_neighbors_of_vertices(sites):
    tri = dt3d.Delaunay(np.concatenate([sites, sites[:1]]))
    indptr, indices = tri.vertex_neighbor_vertices
    assert indptr.dtype == indices.dtype == np.int32
    joined = {(int(s[i]), int(s[j])) for s in tri.simplices for i in range(4) for j in range(4) if i != j}
    found = [(v, int(u)) for v in range(len(tri.points)) for u in indices[indptr[v] : indptr[v + 1]]]
    assert found == sorted(joined)
    assert indptr[-1] == indptr[-2]  # the last site is a copy


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_walk_in_circles_is_an_internal_error(dimension):
    points = np.random.default_rng(2).random((9000, dimension))
    tri = (threaded2d.Delaunay if dimension == 2 else dt3d.Delaunay)(points)
    simplices = tri.triangles if dimension == 2 else tri.simplices
    beyond = points[simplices].mean(axis=1)[5:]
    circle = np.repeat(((np.arange(len(simplices)) + 1) % 5)[:, None], dimension + 1, axis=1).astype(np.int32)
    broken = location.Locator(points, simplices, circle)
    for queries in (beyond[:1], beyond):  # by one thread, and by several
        with pytest.raises(dt3d.InternalError, match="a walk to a point does not end.*please report"):
            broken.find(queries)
    # where simplices may be missing all are searched
    patient = location.Locator(points, simplices, circle, convex=False)
    np.testing.assert_array_equal(patient.find(beyond[:3]), [5, 6, 7])
