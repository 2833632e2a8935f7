"""What is said of each simplex of a mesh: sizes, shapes, depths."""

import itertools
from collections import deque

import numpy as np
import pytest

import dt3d
from dt3d import threaded2d
from dt3d._cell_data import cell_data, neighbors_of, varies
from dt3d.files import Mesh, read_mesh, write_mesh
from dt3d.geometry.depths import depths
from dt3d.geometry.edge_lengths import longest_edges

RNG = np.random.default_rng(11)
SETS = {
    "space": RNG.random((200, 3)),
    "plane": RNG.random((200, 2)),
    "grid": np.stack(np.meshgrid(*3 * [np.arange(5.0)]), axis=-1).reshape(-1, 3),
    "one tetrahedron": np.vstack([np.zeros(3), np.eye(3)]),
}


def depths_one_by_one(simplices):
    """By a queue, from facets as sets of vertices."""
    sides = {}
    for t, row in enumerate(simplices.tolist()):
        for facet in itertools.combinations(row, len(row) - 1):
            sides.setdefault(frozenset(facet), []).append(t)
    depth = {of[0]: 0 for of in sides.values() if len(of) == 1}
    queue = deque(depth)
    while queue:
        t = queue.popleft()
        row = simplices[t].tolist()
        for facet in itertools.combinations(row, len(row) - 1):
            for u in sides[frozenset(facet)]:
                if u not in depth:
                    depth[u] = depth[t] + 1
                    queue.append(u)
    return [depth.get(t, -1) for t in range(len(simplices))]


@pytest.mark.parametrize("name", SETS)
def test_depths_are_those_of_a_queue(name):
    tri = dt3d.Delaunay(SETS[name])
    found = cell_data(tri)["depth"]
    assert found.dtype == np.int32
    assert found.tolist() == depths_one_by_one(tri.simplices)
    assert ((found == 0) == (tri.neighbors == dt3d.OUTSIDE).any(axis=1)).all()
    np.testing.assert_array_equal(neighbors_of(tri.simplices)[:, ::-1], tri.neighbors[:, ::-1])


def test_depths_of_a_part_begin_at_its_boundary():
    tri = dt3d.Delaunay(SETS["space"])
    part = tri.subset(RNG.random(len(tri.simplices)) < 0.9)
    found = cell_data(part)
    assert found["depth"].tolist() == depths_one_by_one(part.simplices)
    assert {len(values) for values in found.values()} == {len(part.simplices)}
    assert all(len(values) == 0 for values in cell_data(tri.subset([])).values())


def test_what_no_path_reaches_has_no_depth():
    torus = np.array([[1, 2, 1, 2], [0, 2, 0, 2], [0, 1, 0, 1]])  # nowhere a facet of the hull
    assert depths(torus).tolist() == [-1, -1, -1]


def test_meshes_without_neighbors_have_the_same_data(tmp_path):
    tri = dt3d.Delaunay(SETS["space"])
    write_mesh(tri, tmp_path / "a.vtu")
    read = cell_data(read_mesh(tmp_path / "a.vtu"))
    for name, values in cell_data(tri).items():
        np.testing.assert_array_equal(read[name], values)


def test_a_facet_of_three_tetrahedra_is_no_end():
    points = np.vstack([np.zeros(3), np.eye(3), np.ones((1, 3)), -np.ones((1, 3))])
    mesh = Mesh(points, np.array([[0, 1, 2, 3], [0, 1, 2, 4], [0, 1, 2, 5]], np.int32), np.ones(3, np.int32))
    assert cell_data(mesh)["depth"].tolist() == [0, 0, 0]


@pytest.mark.parametrize("name", SETS)
def test_sizes_and_shapes(name):
    tri = dt3d.Delaunay(SETS[name])
    found = cell_data(tri)
    corners = tri.points[tri.simplices]
    sides = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=-1)
    np.testing.assert_allclose(found["longest_edge"], sides.max(axis=(1, 2)), rtol=1e-14)
    np.testing.assert_array_equal(found["circumradius"], tri.circumradii)
    size = "volume" if tri.ndim == 3 else "area"
    np.testing.assert_array_equal(found[size], tri.volumes)
    assert ("volume" in found, "area" in found) == (tri.ndim == 3, tri.ndim == 2)
    assert all(values.flags.writeable for values in found.values())


@pytest.mark.parametrize("size", [1e-300, 1e300])
def test_lengths_of_any_magnitude(size):
    points = size * np.vstack([np.zeros(3), np.eye(3)])
    np.testing.assert_allclose(longest_edges(points, np.array([[0, 1, 2, 3]])), size * np.sqrt(2.0))


def test_flat_tetrahedra_of_a_file_have_no_circumsphere():
    square = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    found = cell_data(Mesh(square, np.array([[0, 1, 2, 3]], np.int32), np.ones(1, np.int32)))
    assert found["circumradius"].tolist() == [np.inf]
    assert found["volume"].tolist() == [0]


def test_iterations_and_threads_are_there_where_they_tell_something():
    tri = dt3d.Delaunay(SETS["space"])
    assert "iteration" not in cell_data(tri)
    rounds = dt3d.Delaunay(SETS["space"], method="extrapolation")
    np.testing.assert_array_equal(cell_data(rounds)["iteration"], rounds.iteration)
    last = rounds.subset(rounds.iteration == 3)  # one value, which is not that of insertion
    assert set(cell_data(last)["iteration"].tolist()) == {3}
    alone = threaded2d.Delaunay(SETS["plane"], threads=1)
    assert "thread" not in cell_data(alone)
    several = threaded2d.Delaunay(SETS["plane"], method="optimistic", threads=3)
    np.testing.assert_array_equal(cell_data(several)["thread"], several.thread)


def test_what_varies():
    assert varies(np.array([1, 1, 2]))
    assert not varies(np.array([1, 1]))
    assert not varies(np.array([]))
    assert varies(np.array([1.0, np.inf]))
