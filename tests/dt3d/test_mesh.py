"""Triangulations as meshes, written and read back."""

import sys

import meshio
import numpy as np
import pytest
import pyvista

import dt3d
from dt3d._mesh import hull_to_pyvista, to_pyvista
from dt3d._mesh_data import carry
from dt3d.files import check_mesh_path, read_mesh, read_points, write_mesh

POINTS = np.random.default_rng(4).random((60, 3))


def test_grid_keeps_numbers_and_carries_data(cube):
    grid = to_pyvista(cube)
    np.testing.assert_array_equal(grid.points, cube.points)
    assert grid.points.dtype == np.float64
    assert list(grid.cells_dict) == [10]  # VTK_TETRA
    np.testing.assert_array_equal(grid.cells_dict[10], cube.simplices)
    np.testing.assert_array_equal(grid.cell_data["iteration"], cube.iteration)
    np.testing.assert_allclose(grid.cell_data["volume"], 1 / 6)
    assert grid.volume == pytest.approx(1.0)


def cloud_of(points):
    cloud = pyvista.PolyData(points)
    cloud["normal"] = np.arange(3.0 * len(points)).reshape(-1, 3)
    cloud["label"] = np.arange(len(points), dtype=np.int16)
    return cloud


@pytest.mark.parametrize("part", [False, True])
def test_the_point_data_of_a_source(part):
    tri = dt3d.Delaunay(POINTS)
    tri = tri.subset(np.arange(20)) if part else tri
    cloud = cloud_of(POINTS)
    cloud.set_active_scalars("label")
    grid = tri.to_pyvista(cloud)
    assert grid.point_data.keys() == ["normal", "label"]
    for name in ("normal", "label"):
        np.testing.assert_array_equal(grid.point_data[name], cloud[name])
        assert grid.point_data[name].dtype == cloud[name].dtype
        assert not np.shares_memory(grid.point_data[name], cloud[name])
    assert grid.active_scalars_name == "label"
    hull = tri.hull_to_pyvista(cloud)
    np.testing.assert_array_equal(hull.point_data["label"], hull.point_data["site"])
    np.testing.assert_array_equal(hull.points, POINTS[hull["site"]])


def test_any_dataset_is_a_source():
    image = pyvista.ImageData(dimensions=(3, 4, 5))
    image["x"] = image.points[:, 0]
    grid = dt3d.Delaunay(image).to_pyvista(image)
    np.testing.assert_array_equal(grid.point_data["x"], grid.points[:, 0])


def test_a_wrong_source_says_so():
    tri = dt3d.Delaunay(POINTS)
    for make in (tri.to_pyvista, tri.hull_to_pyvista, dt3d.Delaunay(POINTS[:, :2]).to_pyvista):
        with pytest.raises(ValueError, match="source has 59 points, and the triangulation has 60"):
            make(cloud_of(POINTS[:-1]))
        with pytest.raises(
            ValueError, match="source must be a dataset of PyVista, got a ndarray; .* for arrays"
        ):
            make(POINTS)


def test_active_is_what_varies(cube):
    grid = dt3d.Delaunay(POINTS).to_pyvista()
    assert (grid.active_scalars_name, grid.active_scalars_info.association.name) == ("longest_edge", "CELL")
    cloud = cloud_of(POINTS)
    cloud["label"][:] = 7
    cloud.set_active_scalars("label")
    assert dt3d.Delaunay(POINTS).to_pyvista(cloud).active_scalars_name == "longest_edge"
    # one edge length, one circumradius, one volume, one depth
    assert to_pyvista(cube).active_scalars_name == "longest_edge"
    alike = np.ones(grid.n_cells)
    carry(grid, {"longest_edge": alike, "circumradius": alike, "depth": np.arange(grid.n_cells)})
    assert grid.active_scalars_name == "depth"


def test_a_terrain_of_a_source_in_the_plane():
    tri = dt3d.Delaunay(POINTS[:, :2])
    assert (tri.to_pyvista().points[:, 2] == 0).all()
    terrain = tri.to_pyvista(cloud_of(POINTS))
    np.testing.assert_array_equal(terrain.points, POINTS)
    np.testing.assert_array_equal(terrain.point_data["label"], np.arange(60))
    assert terrain.cell_data.keys()[:4] == ["area", "longest_edge", "circumradius", "depth"]
    assert terrain.active_scalars_name == "normal"
    assert tri.to_pyvista().active_scalars_name == "longest_edge"
    outline = tri.hull_to_pyvista(cloud_of(POINTS))
    np.testing.assert_array_equal(outline.points, POINTS[outline["site"]])
    assert (outline.n_cells, outline.n_open_edges) == (len(tri.convex_hull), 0)
    np.testing.assert_array_equal(outline["site"][outline.lines.reshape(-1, 3)[:, 1:]], tri.convex_hull)


def test_hull_is_closed_and_faces_outwards(cube):
    hull = hull_to_pyvista(cube)
    assert hull.n_points == 8
    assert hull.n_cells == 12
    assert hull.n_open_edges == 0
    a, b, c = hull.points[hull.regular_faces].swapaxes(0, 1)
    outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), a - 0.5)
    assert (outward > 0).all()


@pytest.mark.parametrize("extension", [".vtu", ".vtk", ".npz", ".mesh"])
def test_what_is_written_is_read_back(cube, tmp_path, extension):
    path = tmp_path / f"cube{extension}"
    write_mesh(cube, path)
    mesh = read_mesh(path)
    np.testing.assert_array_equal(mesh.points, cube.points)
    np.testing.assert_array_equal(mesh.simplices, cube.simplices)
    np.testing.assert_array_equal(mesh.iteration, cube.iteration)
    assert (mesh.points.dtype, mesh.simplices.dtype, mesh.iteration.dtype) == ("f8", "i4", "i4")


def test_gmsh_holds_the_tetrahedra_only(cube, tmp_path):
    write_mesh(cube, str(tmp_path / "cube.msh"))
    mesh = read_mesh(tmp_path / "cube.msh")
    np.testing.assert_array_equal(mesh.simplices, cube.simplices)
    assert (mesh.iteration == 1).all()


def test_npz_holds_everything(cube, tmp_path):
    write_mesh(cube, tmp_path / "cube.npz")
    with np.load(tmp_path / "cube.npz") as arrays:
        assert set(arrays.files) == {"points", "simplices", "neighbors", "iteration", "volume"}
        np.testing.assert_array_equal(arrays["neighbors"], cube.neighbors)
        np.testing.assert_allclose(arrays["volume"], 1 / 6)
    # and serves as a file of points
    np.testing.assert_array_equal(read_points(tmp_path / "cube.npz"), cube.points)


@pytest.mark.parametrize("extension", [".ply", ".stl"])
def test_surface_formats_hold_the_hull(cube, tmp_path, extension):
    path = tmp_path / f"cube{extension}"
    write_mesh(cube, path)
    assert len(np.unique(read_points(path), axis=0)) == 8
    with pytest.raises(ValueError, match="holds no tetrahedra"):
        read_mesh(path)


def test_a_file_that_exists_is_replaced(cube, tmp_path):
    path = tmp_path / "cube.vtu"
    path.write_text("old")
    write_mesh(cube, path)
    assert len(read_mesh(path).simplices) == 6


def test_unknown_extension_lists_the_known(cube, tmp_path):
    expected = r"unknown extension '\.docx'; known are \.mesh, \.msh, \.npz, \.ply, \.stl, \.vtk, \.vtu"
    with pytest.raises(ValueError, match=expected):
        write_mesh(cube, tmp_path / "a.docx")


def test_missing_folder(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"cannot write .*a\.vtu: there is no folder .*nowhere"):
        check_mesh_path(tmp_path / "nowhere" / "a.vtu")
    assert check_mesh_path(str(tmp_path / "a.vtu")) == tmp_path / "a.vtu"


def test_files_without_tetrahedra(tmp_path):
    np.savez(tmp_path / "a.npz", points=np.zeros((4, 3)))
    with pytest.raises(ValueError, match=r"a\.npz holds no mesh: there is no array simplices"):
        read_mesh(tmp_path / "a.npz")
    with pytest.raises(FileNotFoundError, match="there is no file"):
        read_mesh(tmp_path / "b.vtu")
    (tmp_path / "c.docx").write_text("")
    with pytest.raises(ValueError, match=r"unknown extension '\.docx'; known are \.mesh, \.msh"):
        read_mesh(tmp_path / "c.docx")


def test_missing_packages_say_how_to_install_them(cube, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    monkeypatch.setitem(sys.modules, "meshio", None)
    for extension in (".vtk", ".ply", ".msh"):
        with pytest.raises(ImportError, match=r"pip install 'dt3d\[view\]'"):
            write_mesh(cube, tmp_path / f"a{extension}")
    with pytest.raises(ImportError, match=r"pip install 'dt3d\[view\]'"):
        to_pyvista(cube)


@pytest.mark.parametrize("name", ["space", "plane", "part"])
def test_meshio_has_the_same_cells_and_data(name, tmp_path):
    tri = dt3d.Delaunay(POINTS[:, :2] if name == "plane" else POINTS)
    tri = tri.subset([3, 1, 4]) if name == "part" else tri
    mesh = tri.to_meshio()
    assert mesh.points.shape == (60, 3)
    np.testing.assert_array_equal(mesh.points[:, : tri.ndim], tri.points)
    (block,) = mesh.cells
    assert block.type == ("triangle" if name == "plane" else "tetra")
    np.testing.assert_array_equal(block.data, tri.simplices)
    grid = tri.to_pyvista()
    assert list(mesh.cell_data) == grid.cell_data.keys()
    for key, (values,) in mesh.cell_data.items():
        np.testing.assert_array_equal(values, grid.cell_data[key])
    assert not np.shares_memory(mesh.points, tri.points)
    assert not np.shares_memory(block.data, tri.simplices)
    mesh.write(tmp_path / "a.vtu")
    np.testing.assert_array_equal(meshio.read(tmp_path / "a.vtu").cells[0].data, tri.simplices)


def test_without_packages_the_methods_say_how_to_install_them(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    monkeypatch.setitem(sys.modules, "meshio", None)
    for points in (POINTS, POINTS[:, :2]):
        tri = dt3d.Delaunay(points)
        for method in (tri.to_pyvista, tri.hull_to_pyvista, tri.to_meshio):
            with pytest.raises(ImportError, match=r"pip install 'dt3d\[view\]'"):
                method()
