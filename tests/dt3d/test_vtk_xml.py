"""Files of VTK in XML as other programs read them: VTK itself, and meshio."""

import meshio
import numpy as np
import pytest
import pyvista

import dt3d
from dt3d import threaded2d
from dt3d._mesh_plane import write_plane_mesh
from dt3d._vtk_xml import BLOCK, XmlMesh, write_xml
from dt3d.files import read_mesh, read_points, write_mesh

RNG = np.random.default_rng(3)
POINTS = RNG.random((300, 3))
DATA = {
    "wind & <rain>": RNG.random((300, 3)),
    "count": np.arange(300, dtype=np.uint16),
    "swapped": np.arange(300.0).astype(">f4"),
    "half": np.arange(300, dtype=np.float16),
    "above": POINTS[:, 2] > 0.5,
    "tensor": RNG.random((300, 3, 3)),
    "every second": np.arange(600)[::2],
}


@pytest.mark.parametrize("compress", [False, True])
def test_vtk_and_meshio_read_what_is_written(tmp_path, compress):
    tri = dt3d.Delaunay(POINTS)
    path = tmp_path / "a.vtu"
    write_mesh(tri, path, point_data=DATA, compress=compress)
    grid, ours = pyvista.read(path), tri.to_pyvista()
    np.testing.assert_array_equal(grid.points, tri.points)
    np.testing.assert_array_equal(grid.cells_dict[pyvista.CellType.TETRA], tri.simplices)
    assert grid.active_scalars_name == ours.active_scalars_name
    for name in ours.cell_data:
        np.testing.assert_array_equal(grid.cell_data[name], ours.cell_data[name])
        assert grid.cell_data[name].dtype == ours.cell_data[name].dtype
    assert grid.point_data.keys() == list(DATA)
    for name, values in DATA.items():
        np.testing.assert_array_equal(grid.point_data[name], values.reshape(300, -1).squeeze())
    np.testing.assert_array_equal(read_mesh(path).simplices, tri.simplices)
    np.testing.assert_array_equal(read_points(path), tri.points)
    other = meshio.read(path)
    np.testing.assert_array_equal(other.cells_dict["tetra"], tri.simplices)
    np.testing.assert_array_equal(other.point_data["count"], DATA["count"])


def test_many_blocks_and_one_that_is_full(tmp_path):
    points = RNG.random((BLOCK // 8, 3))  # three full blocks
    simplices = RNG.integers(0, len(points), (100_000, 4))
    write_xml(XmlMesh(points, simplices), tmp_path / "a.vtu", compress=True)
    grid = pyvista.read(tmp_path / "a.vtu")
    np.testing.assert_array_equal(grid.points, points)
    np.testing.assert_array_equal(grid.cells_dict[10], simplices)
    np.testing.assert_array_equal(read_points(tmp_path / "a.vtu"), points)


@pytest.mark.parametrize("compress", [False, True])
@pytest.mark.parametrize("extension", [".vtu", ".vtp"])
def test_triangles(tmp_path, extension, compress):
    tri = threaded2d.Delaunay(POINTS[:, :2], threads=2)
    path = tmp_path / f"a{extension}"
    write_plane_mesh(tri, path, point_data={"height": POINTS[:, 2]}, compress=compress)
    mesh = pyvista.read(path)
    found = mesh.regular_faces if extension == ".vtp" else mesh.cells_dict[pyvista.CellType.TRIANGLE]
    np.testing.assert_array_equal(found, tri.triangles)
    np.testing.assert_array_equal(mesh.points, np.column_stack([tri.points, np.zeros(300)]))
    np.testing.assert_array_equal(mesh.point_data["height"], POINTS[:, 2])
    np.testing.assert_array_equal(mesh.cell_data["area"], tri.volumes)
    assert mesh.n_cells == len(tri.triangles)


@pytest.mark.parametrize("compress", [False, True])
def test_no_tetrahedra(tmp_path, compress):
    part = dt3d.Delaunay(POINTS).subset([])
    write_mesh(part, tmp_path / "a.vtu", compress=compress)
    grid = pyvista.read(tmp_path / "a.vtu")
    assert (grid.n_points, grid.n_cells) == (300, 0)


def test_the_files_are_as_large_as_the_format_says(tmp_path):
    tri = dt3d.Delaunay(POINTS)
    sizes = {}
    for compress in (False, True):
        for extension in (".vtu", ".npz"):
            path = tmp_path / f"{compress}{extension}"
            write_mesh(tri, path, compress=compress)
            sizes[extension, compress] = path.stat().st_size
    m, n = len(tri.simplices), len(tri.points)
    arrays = n * 24 + m * (16 + 4 + 1 + 3 * 8 + 4)  # points; corners, offsets, types, three sizes, depth
    assert 0 < sizes[".vtu", False] - arrays < 2_500
    assert sizes[".vtu", True] < 0.8 * sizes[".vtu", False]
    assert sizes[".npz", True] < 0.8 * sizes[".npz", False]


def test_data_that_are_no_numbers(tmp_path):
    tri = dt3d.Delaunay(POINTS)
    names = np.array([f"atom {k}" for k in range(300)])
    with pytest.raises(
        ValueError, match=r"hold numbers, and 'name' has dtype <U8; leave it out, or write \.npz"
    ):
        write_mesh(tri, tmp_path / "a.vtu", point_data={"name": names})
    assert list(tmp_path.iterdir()) == []
    write_mesh(tri, tmp_path / "a.npz", point_data={"name": names, "points": POINTS})
    with np.load(tmp_path / "a.npz") as found:
        np.testing.assert_array_equal(found["name"], names)
        np.testing.assert_array_equal(found["point_points"], POINTS)


def test_point_data_of_another_length(tmp_path):
    with pytest.raises(
        ValueError, match=r"'t' must have an entry for each of the 300 sites, got shape \(299,\)"
    ):
        write_mesh(dt3d.Delaunay(POINTS), tmp_path / "a.vtu", point_data={"t": np.zeros(299)})


@pytest.mark.parametrize("extension", [".vtk", ".msh"])
def test_point_data_in_other_formats(tmp_path, extension):
    write_mesh(dt3d.Delaunay(POINTS), tmp_path / f"a{extension}", point_data={"height": POINTS[:, 2]})
    read = pyvista.read if extension == ".vtk" else meshio.read
    np.testing.assert_array_equal(read(tmp_path / f"a{extension}").point_data["height"], POINTS[:, 2])
