"""Snippets as users of SciPy write them, with one import changed.

Each is a function of the class `Delaunay`, run with SciPy's and with ours; what both give is compared, and
with what it has to be where SciPy's is wrong. They are the recipes that questions about
`scipy.spatial.Delaunay` are answered with.
"""

import itertools
from collections import defaultdict

import matplotlib.pyplot as plt
import numpy as np
import pytest
import scipy.spatial
from scipy.interpolate import CloughTocher2DInterpolator, LinearNDInterpolator
from scipy.sparse import csr_matrix
from scipy.spatial import delaunay_plot_2d, tsearch

import dt3d

OURS, THEIRS = dt3d.Delaunay, scipy.spatial.Delaunay
RNG = np.random.default_rng(3)
POINTS = {2: RNG.random((300, 2)), 3: RNG.random((300, 3))}
QUERIES = {d: RNG.uniform(-0.2, 1.2, (500, d)) for d in (2, 3)}
GRID = {d: np.stack(np.meshgrid(*[np.arange(5.0)] * d), -1).reshape(-1, d) for d in (2, 3)}
DIMENSIONS = pytest.mark.parametrize("d", [2, 3])


def field(x):
    return 2 + x @ np.arange(1, x.shape[-1] + 1)


@DIMENSIONS
def test_linear_interpolation(d):
    points, values = POINTS[d], np.sin(5 * POINTS[d]).sum(axis=1)
    tri = OURS(points)
    f = LinearNDInterpolator(tri.to_scipy(), values)
    wanted = LinearNDInterpolator(THEIRS(points), values)(QUERIES[d])
    np.testing.assert_allclose(f(QUERIES[d]), wanted, rtol=1e-9, atol=1e-12)


def test_smooth_interpolation_in_the_plane():
    points, values = POINTS[2], np.sin(5 * POINTS[2]).sum(axis=1)
    f = CloughTocher2DInterpolator(OURS(points).to_scipy(), values)
    wanted = CloughTocher2DInterpolator(THEIRS(points), values)(QUERIES[2])
    np.testing.assert_allclose(f(QUERIES[2]), wanted, rtol=1e-5, atol=1e-5)


def interp_weights(Delaunay, xyz, uvw, d):
    tri = Delaunay(xyz)
    simplex = tri.find_simplex(uvw)
    vertices = np.take(tri.simplices, simplex, axis=0)
    temp = np.take(tri.transform, simplex, axis=0)
    delta = uvw - temp[:, d]
    bary = np.einsum("njk,nk->nj", temp[:, :d, :], delta)
    return vertices, np.hstack((bary, 1 - bary.sum(axis=1, keepdims=True)))


def interpolate(values, vtx, wts, fill_value=np.nan):
    ret = np.einsum("nj,nj->n", np.take(values, vtx), wts)
    ret[np.any(wts < -1e-12, axis=1)] = fill_value
    return ret


@DIMENSIONS
def test_weights_that_are_kept_for_many_fields(d):
    values = np.cos(3 * POINTS[d]).prod(axis=1)
    ours, theirs = (
        interpolate(values, *interp_weights(kind, POINTS[d], QUERIES[d], d)) for kind in (OURS, THEIRS)
    )
    np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-12)


def in_hull(Delaunay, p, hull):
    if not isinstance(hull, Delaunay):
        hull = Delaunay(hull)
    return hull.find_simplex(p) >= 0


@DIMENSIONS
def test_points_in_a_hull(d):
    wanted = in_hull(THEIRS, QUERIES[d], POINTS[d])
    np.testing.assert_array_equal(in_hull(OURS, QUERIES[d], POINTS[d]), wanted)
    np.testing.assert_array_equal(in_hull(OURS, QUERIES[d], OURS(POINTS[d])), wanted)
    np.testing.assert_array_equal(tsearch(OURS(POINTS[d]), QUERIES[d]) >= 0, wanted)


def alpha_shape_3d(Delaunay, pos, alpha):
    tetra = Delaunay(pos)
    # Find radius of the circumsphere.
    tetrapos = np.take(pos, tetra.simplices, axis=0)
    normsq = np.sum(tetrapos**2, axis=2)[:, :, None]
    ones = np.ones((tetrapos.shape[0], tetrapos.shape[1], 1))
    a = np.linalg.det(np.concatenate((tetrapos, ones), axis=2))
    Dx = np.linalg.det(np.concatenate((normsq, tetrapos[:, :, [1, 2]], ones), axis=2))
    Dy = -np.linalg.det(np.concatenate((normsq, tetrapos[:, :, [0, 2]], ones), axis=2))
    Dz = np.linalg.det(np.concatenate((normsq, tetrapos[:, :, [0, 1]], ones), axis=2))
    c = np.linalg.det(np.concatenate((normsq, tetrapos), axis=2))
    r = np.sqrt(Dx**2 + Dy**2 + Dz**2 - 4 * a * c) / (2 * np.abs(a))
    # Find tetrahedrals
    tetras = tetra.simplices[r < alpha, :]
    # triangles
    TriComb = np.array([(0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3)])
    Triangles = tetras[:, TriComb].reshape(-1, 3)
    Triangles = np.sort(Triangles, axis=1)
    # Remove triangles that occurs twice, because they are within shapes
    TrianglesDict = defaultdict(int)
    for tri in Triangles:
        TrianglesDict[tuple(tri)] += 1
    return np.array([tri for tri in TrianglesDict if TrianglesDict[tri] == 1])


def test_alpha_shape_in_space():
    ours, theirs = (
        {tuple(t) for t in alpha_shape_3d(kind, POINTS[3], 0.12).tolist()} for kind in (OURS, THEIRS)
    )
    assert ours == theirs
    assert len(ours) > 100
    # on a grid SciPy has flat tetrahedra; 6 sides of 4 x 4 squares are 192 triangles
    with np.errstate(divide="ignore", invalid="ignore"):
        assert len(alpha_shape_3d(OURS, GRID[3], 0.9)) == 192


def alpha_shape_2d(Delaunay, points, alpha):
    def add_edge(edges, i, j):
        if (i, j) in edges or (j, i) in edges:
            edges.remove((j, i))
            return
        edges.add((i, j))

    tri = Delaunay(points)
    edges = set()
    for ia, ib, ic in tri.simplices:
        pa, pb, pc = points[ia], points[ib], points[ic]
        a = np.sqrt((pa[0] - pb[0]) ** 2 + (pa[1] - pb[1]) ** 2)
        b = np.sqrt((pb[0] - pc[0]) ** 2 + (pb[1] - pc[1]) ** 2)
        c = np.sqrt((pc[0] - pa[0]) ** 2 + (pc[1] - pa[1]) ** 2)
        s = (a + b + c) / 2.0
        area = np.sqrt(s * (s - a) * (s - b) * (s - c))
        circum_r = a * b * c / (4.0 * area)
        if circum_r < alpha:
            add_edge(edges, ia, ib)
            add_edge(edges, ib, ic)
            add_edge(edges, ic, ia)
    return edges


def test_alpha_shape_in_the_plane():
    ours, theirs = (
        {frozenset(map(int, e)) for e in alpha_shape_2d(kind, POINTS[2], 0.05)} for kind in (OURS, THEIRS)
    )
    assert ours == theirs
    assert len(ours) > 50


def test_pictures_of_triangles():
    points = POINTS[2]
    tri = OURS(points)
    fig, ax = plt.subplots()
    lines = ax.triplot(points[:, 0], points[:, 1], tri.simplices)
    edges = {frozenset(e) for t in tri.simplices.tolist() for e in itertools.combinations(t, 2)}
    assert len(lines[0].get_xdata()) == 3 * len(edges)  # two ends and a gap
    assert delaunay_plot_2d(tri) is not None
    assert delaunay_plot_2d(tri.to_scipy()) is not None
    plt.close("all")
    plt.close(fig)


@DIMENSIONS
def test_graphs(d):
    import networkx

    def graph(Delaunay):
        indptr, indices = Delaunay(POINTS[d]).vertex_neighbor_vertices
        g = networkx.Graph()
        for k in range(len(indptr) - 1):
            for j in indices[indptr[k] : indptr[k + 1]]:
                g.add_edge(k, int(j))
        return g

    ours, theirs = graph(OURS), graph(THEIRS)
    assert {frozenset(e) for e in ours.edges} == {frozenset(e) for e in theirs.edges}
    assert networkx.is_connected(ours)


@DIMENSIONS
def test_sparse_matrices(d):
    def adjacency(Delaunay):
        indptr, indices = Delaunay(POINTS[d]).vertex_neighbor_vertices
        n = len(POINTS[d])
        return csr_matrix((np.ones(len(indices)), indices, indptr), shape=(n, n))

    ours, theirs = adjacency(OURS), adjacency(THEIRS)
    assert (ours != theirs).nnz == 0
    assert (ours != ours.T).nnz == 0


@DIMENSIONS
def test_natural_neighbours_by_a_walk_over_circumspheres(d):
    def neighbours(Delaunay, x):
        tri = Delaunay(POINTS[d])
        start = int(tri.find_simplex(x))
        seen, todo = {start}, [start]
        while todo:
            t = todo.pop()
            for u in map(int, tri.neighbors[t]):
                if u != -1 and u not in seen:
                    corners = tri.points[tri.simplices[u]]
                    m = 2 * (corners[1:] - corners[0])
                    center = np.linalg.solve(m, (corners[1:] ** 2).sum(axis=1) - (corners[0] ** 2).sum())
                    if np.linalg.norm(x - center) < np.linalg.norm(corners[0] - center):
                        seen.add(u)
                        todo.append(u)
        return set(tri.simplices[sorted(seen)].ravel().tolist())

    x = np.full(d, 0.45)
    assert neighbours(OURS, x) == neighbours(THEIRS, x)
    assert len(neighbours(OURS, x)) > d


@DIMENSIONS
def test_gradients_of_a_field(d):
    def gradients(Delaunay, points):
        tri = Delaunay(points)
        corners, values = points[tri.simplices], field(points)[tri.simplices]
        return np.linalg.solve(corners[:, 1:] - corners[:, :1], (values[:, 1:] - values[:, :1])[..., None])

    slope = np.arange(1, d + 1)
    for points in (POINTS[d], GRID[d]):
        np.testing.assert_allclose(
            gradients(OURS, points)[..., 0], np.broadcast_to(slope, (OURS(points).nsimplex, d)), rtol=1e-6
        )
    if d == 3:
        with pytest.raises(np.linalg.LinAlgError, match="Singular"):
            gradients(THEIRS, GRID[3])


@DIMENSIONS
def test_cells_of_voronoi_by_a_walk_around_a_vertex(d):
    def cell(Delaunay, k):
        tri = Delaunay(POINTS[d])
        start = int(tri.vertex_to_simplex[k])
        around, todo = {start}, [start]
        while todo:
            for u in map(int, tri.neighbors[todo.pop()]):
                if u != -1 and u not in around and k in tri.simplices[u]:
                    around.add(u)
                    todo.append(u)
        corners = tri.points[tri.simplices[sorted(around)]]
        m = 2 * (corners[:, 1:] - corners[:, :1])
        right = (corners[:, 1:] ** 2).sum(axis=2) - (corners[:, :1] ** 2).sum(axis=2)
        centers = np.linalg.solve(m, right[..., None])[..., 0]
        return centers[np.lexsort(centers.T)]

    inner = int(np.argmin(np.linalg.norm(POINTS[d] - 0.5, axis=1)))
    np.testing.assert_allclose(cell(OURS, inner), cell(THEIRS, inner), rtol=1e-8)


def test_a_hull_as_a_mesh():
    import trimesh

    tri = OURS(POINTS[3])
    hull = trimesh.Trimesh(POINTS[3], tri.convex_hull)
    assert hull.is_volume
    np.testing.assert_allclose(hull.volume, scipy.spatial.ConvexHull(POINTS[3]).volume, rtol=1e-12)


@DIMENSIONS
def test_another_library_that_calls_scipy(d, monkeypatch):
    monkeypatch.setattr(scipy.spatial, "Delaunay", OURS)
    tri = scipy.spatial.Delaunay(POINTS[d], qhull_options="Qbb Qc Qz")
    assert type(tri) is OURS
    assert tri.nsimplex == len(THEIRS(POINTS[d]).simplices)


@DIMENSIONS
def test_points_without_volume(d):
    flat = POINTS[d].copy()
    flat[:, -1] = 0.5
    with pytest.raises(ValueError, match="the 300 distinct sites that came lie on a") as caught:
        OURS(flat)
    assert "\n" not in str(caught.value)
