"""Triangulations as meshes, written and read back."""

import sys

import numpy as np
import pytest

from dt3d._mesh import hull_to_pyvista, show, to_pyvista
from dt3d.files import check_mesh_path, read_mesh, read_points, write_mesh


def test_grid_keeps_numbers_and_carries_data(cube):
    grid = to_pyvista(cube)
    np.testing.assert_array_equal(grid.points, cube.points)
    assert grid.points.dtype == np.float64
    assert list(grid.cells_dict) == [10]  # VTK_TETRA
    np.testing.assert_array_equal(grid.cells_dict[10], cube.simplices)
    np.testing.assert_array_equal(grid.cell_data["iteration"], cube.iteration)
    np.testing.assert_allclose(grid.cell_data["volume"], 1 / 6)
    assert grid.volume == pytest.approx(1.0)


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
    for extension in (".vtu", ".ply", ".msh"):
        with pytest.raises(ImportError, match=r"pip install 'dt3d\[view\]'"):
            write_mesh(cube, tmp_path / f"a{extension}")
    with pytest.raises(ImportError, match=r"pip install 'dt3d\[view\]'"):
        to_pyvista(cube)


def test_window_shows_the_iterations(cube, monkeypatch):
    import pyvista

    calls = {}

    class Window:
        """Stands for a window, which a test machine may not be able to open."""

        def __init__(self, title):
            calls["title"] = title

        def add_mesh_clip_plane(self, mesh, **options):
            calls["cells"], calls["scalars"] = mesh.n_cells, options["scalars"]

        def add_axes(self):
            pass

        def show(self):
            calls["shown"] = True

    monkeypatch.setattr(pyvista, "Plotter", Window)
    show(cube, "a cube")
    assert calls == {"title": "a cube", "cells": 6, "scalars": "iteration", "shown": True}
