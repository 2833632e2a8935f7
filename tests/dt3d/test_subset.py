"""A part of a triangulation: what it contains, its border, and where points are in it."""

import copy
import pickle
from contextlib import suppress

import numpy as np
import pytest

import dt3d
from dt3d import threaded2d
from dt3d._topology import open_edges

from . import families
from .exact import integers, orient

RNG = np.random.default_rng(0)
GRID2D = np.stack(np.meshgrid(*[np.arange(5.0)] * 2, indexing="ij"), -1).reshape(-1, 2)


def make(sites):
    return (dt3d.Delaunay if sites.shape[1] == 3 else threaded2d.Delaunay)(sites)


SITES = {
    "grid": 12 * families.grid(3),
    "skew lines": 12 * families.skew_lines(5),
    "random": RNG.integers(0, 10**6, (60, 3)) * 12.0,
    "grid in the plane": 12 * GRID2D,
    "random in the plane": RNG.integers(0, 10**6, (80, 2)) * 12.0,
}


def special_points(tri):
    """Vertices, and middles of edges, facets and simplices, of sites that are multiples of twelve."""
    corners = tri.points[tri.simplices]
    return np.concatenate([corners[:, :k].sum(axis=1) / k for k in range(1, corners.shape[1] + 1)])


def contained(tri, simplices, points):
    """Whether each simplex has each point, its border included: bool (k, m), in integers."""
    both = integers(np.concatenate([tri.points, points]))
    sites, points = both[: len(tri.points)], both[len(tri.points) :]
    inside = np.ones((len(points), len(simplices)), bool)
    d = points.shape[1]
    for i, point in enumerate(points):
        corners = sites[simplices]
        for k in range(d + 1):
            a = [
                np.broadcast_to(point, corners[:, j].shape) if j == k else corners[:, j] for j in range(d + 1)
            ]
            if d == 3:
                inside[i] &= orient(*a) >= 0
            else:
                (x, y), (u, v) = (a[1] - a[0]).T, (a[2] - a[0]).T
                inside[i] &= x * v - y * u >= 0
    return inside


@pytest.mark.parametrize("name", SITES)
@pytest.mark.parametrize("share", [0.15, 0.7])
def test_points_are_found_where_brute_force_finds_them(name, share):
    tri = make(SITES[name])
    keep = RNG.random(len(tri.simplices)) < share
    part = tri.subset(keep)
    points = special_points(tri)
    points = np.unique(np.concatenate([points, points + 1, points.min(axis=0) - points]), axis=0)
    points = points[RNG.permutation(len(points))[:400]]
    found, inside = part.find_simplex(points), contained(tri, part.simplices, points)
    np.testing.assert_array_equal(found >= 0, inside.any(axis=1))
    assert inside[np.flatnonzero(found >= 0), found[found >= 0]].all()
    assert set(found[found < 0]) == {dt3d.OUTSIDE}
    # the whole would answer with a simplex that is not kept for some of the points on borders
    assert (part._number[tri.find_simplex(points)] < 0).sum() > (found < 0).sum()


def test_a_vertex_of_more_tetrahedra_than_are_first_made_room_for():
    sites = np.concatenate([np.zeros((1, 3)), RNG.normal(size=(400, 3))])
    sites[1:] /= np.linalg.norm(sites[1:], axis=1)[:, None]
    tri = dt3d.Delaunay(sites)
    around = np.flatnonzero((tri.simplices == 0).any(axis=1))
    assert len(around) > 300
    for t in around[::50]:
        assert tri.subset([t]).find_simplex([0, 0, 0]) == 0
    assert tri.subset(np.setdiff1d(np.arange(len(tri.simplices)), around)).find_simplex([0, 0, 0]) == -1


@pytest.mark.parametrize("name", SITES)
def test_neighbors_and_the_border(name):
    tri = make(SITES[name])
    part = tri.subset(RNG.random(len(tri.simplices)) < 0.6)
    np.testing.assert_array_equal(part.simplices, tri.simplices[part.kept])
    facets = {}
    for t, vertices in enumerate(part.simplices.tolist()):
        for k in range(len(vertices)):
            facets.setdefault(frozenset(vertices[:k] + vertices[k + 1 :]), []).append((t, k))
    for sides in facets.values():
        for (t, k), (u, _) in zip(sides, sides[::-1], strict=True):
            assert part.neighbors[t, k] == (u if len(sides) == 2 else dt3d.OUTSIDE)
    assert {frozenset(facet) for facet in part.boundary.tolist()} == {
        f for f, s in facets.items() if len(s) == 1
    }
    whole = tri.subset(np.ones(len(tri.simplices), bool))
    np.testing.assert_array_equal(whole.boundary, tri.convex_hull)
    np.testing.assert_array_equal(whole.neighbors, tri.neighbors)
    if tri.points.shape[1] == 3:
        assert open_edges(part.boundary) == 0


@pytest.mark.parametrize("name", ["random", "random in the plane"])
def test_a_part_of_a_part(name):
    tri = make(SITES[name])
    rows = RNG.permutation(len(tri.simplices))[:40]
    part = tri.subset(rows)
    np.testing.assert_array_equal(part.kept, rows)
    again = part.subset(np.arange(40) % 2 == 0)
    np.testing.assert_array_equal(again.kept, rows[::2])
    assert type(again) is type(part)
    middles = tri.points[again.simplices].mean(axis=1)
    np.testing.assert_array_equal(again.find_simplex(middles), np.arange(20))
    np.testing.assert_array_equal(part.find_simplex(middles), np.arange(0, 40, 2))


@pytest.mark.parametrize("name", ["random", "random in the plane"])
def test_nothing_kept(name):
    part = make(SITES[name]).subset([])
    assert part.simplices.shape == part.neighbors.shape == (0, part.points.shape[1] + 1)
    assert part.boundary.shape == (0, part.points.shape[1])
    assert (part.find_simplex(part.points) == dt3d.OUTSIDE).all()


@pytest.mark.parametrize(
    ("keep", "message"),
    [
        (np.ones(3, bool), r"mask of shape \(2,\), one value for each simplex, got shape \(3,\)"),
        (np.ones((2, 1), bool), r"mask of shape \(2,\).*got shape \(2, 1\)"),
        ([0.0, 1.0], "integers of shape .*; got dtype float64"),
        ([[0, 1]], r"integers of shape .*shape \(1, 2\)"),
        (0, r"shape \(\)"),
        (["a"], "got dtype <U1"),
        ([0, 2], "keep names simplex 2, but there are simplices 0 to 1"),
        ([-1], "keep names simplex -1, but there are"),
        (np.array([2**40]), "keep names simplex 1099511627776, but"),
        ([1, 0, 1], r"keep names simplex 1 more than once; pass np.unique\(keep\)"),
    ],
)
def test_what_does_not_choose_simplices_is_an_error(keep, message):
    tri = threaded2d.Delaunay([[0, 0], [1, 0], [0, 1], [1, 1]])
    with pytest.raises(ValueError, match=message):
        tri.subset(keep)
    if "np.unique" in message:
        assert len(tri.subset(np.unique(keep)).simplices) == 2


@pytest.mark.parametrize("name", ["random", "random in the plane"])
def test_a_part_is_read_only_and_pickles(name):
    part = make(SITES[name]).subset([3, 1, 4])
    for array in (part.simplices, part.neighbors, part.kept, part.points, part.boundary, part.duplicates):
        with pytest.raises(ValueError, match="cannot set WRITEABLE flag"):
            array.flags.writeable = True
    with pytest.raises(AttributeError, match="kept cannot be assigned: results stay"):
        part.kept = [1]
    middles = part.points[part.simplices].mean(axis=1)
    for other in (part, pickle.loads(pickle.dumps(part)), copy.copy(part), copy.deepcopy(part)):
        np.testing.assert_array_equal(other.kept, [3, 1, 4])
        np.testing.assert_array_equal(other.find_simplex(middles), [0, 1, 2])


def test_a_part_is_drawn(tmp_path):
    from dt3d.plot import draw

    draw(make(SITES["random"]).subset(np.arange(50)), tmp_path / "part.png")
    assert (tmp_path / "part.png").stat().st_size > 1000


@pytest.mark.parametrize("name", ["random", "random in the plane"])
@pytest.mark.parametrize("part", [False, True])
def test_a_mesh_of_pyvista_shares_nothing_that_can_be_written(name, part):
    tri = make(SITES[name])
    tri = tri.subset(np.arange(50)) if part else tri
    names = [n for n in type(tri)._arrays if n != "duplicates"]
    before = {n: getattr(tri, n).copy() for n in names}
    mesh = tri.to_pyvista()
    cells = mesh.cells if hasattr(mesh, "cells") else mesh.faces
    for array in (mesh.points, cells, *mesh.cell_data.values(), *mesh.point_data.values()):
        with suppress(ValueError):  # where it is read-only
            array[:] = 77
    for n in names:
        np.testing.assert_array_equal(getattr(tri, n), before[n])


def test_queries_of_a_part_are_checked():
    part = make(SITES["grid"]).subset([0])
    with pytest.raises(
        ValueError, match=r"xi, points to be located, must have shape \(\.\.\., 3\), got \(2,\)"
    ):
        part.find_simplex([1, 2])
    assert part.find_simplex(np.zeros((2, 0, 3))).shape == (2, 0)
    assert part.find_simplex([1, 2, 3]).shape == ()


def test_parts_go_to_pyvista_and_to_files(tmp_path):
    from dt3d.files import read_mesh, write_mesh

    tri = make(SITES["random"])
    part = tri.subset(RNG.random(len(tri.simplices)) < 0.5)
    assert part.to_pyvista().n_cells == len(part.simplices)
    assert make(SITES["random in the plane"]).subset([0, 5]).to_pyvista().n_cells == 2
    for suffix in (".npz", ".vtu"):
        write_mesh(part, tmp_path / f"part{suffix}")
        np.testing.assert_array_equal(read_mesh(tmp_path / f"part{suffix}").simplices, part.simplices)
    import pyvista

    write_mesh(part, tmp_path / "part.ply")
    assert pyvista.read(tmp_path / "part.ply").n_cells == len(part.boundary)
