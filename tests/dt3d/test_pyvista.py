"""The accessor of PyVista's datasets."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
import pyvista

import dt3d
import dt3d.pyvista

POINTS = np.random.default_rng(2).random((80, 3))
ROOT = Path(dt3d.__file__).parents[1]


@pytest.fixture
def cloud():
    made = pyvista.PolyData(POINTS)
    made["temperature"] = np.arange(80.0)
    made["velocity"] = POINTS[::-1].copy()
    return made


def test_tetrahedra_with_the_point_data(cloud):
    grid = cloud.dt3d.delaunay()
    tri = dt3d.Delaunay(POINTS)
    np.testing.assert_array_equal(grid.cells_dict[pyvista.CellType.TETRA], tri.simplices)
    np.testing.assert_array_equal(grid.points, POINTS)
    for name in ("temperature", "velocity"):
        np.testing.assert_array_equal(grid.point_data[name], cloud[name])
    np.testing.assert_array_equal(grid.cell_data["volume"], tri.volumes)
    assert cloud.array_names == ["temperature", "velocity"]  # as it was


def test_options_are_those_of_the_class(cloud):
    assert "iteration" in cloud.dt3d.delaunay(method="extrapolation").cell_data
    assert repr(cloud.dt3d.triangulation(threads=1)) == "<dt3d.Delaunay: 80 sites, 401 tetrahedra>"
    with pytest.raises(TypeError, match="mehtod"):
        cloud.dt3d.delaunay(mehtod="insertion")


def test_alpha_is_a_radius_as_in_pyvista(cloud):
    grid = cloud.dt3d.delaunay(alpha=0.25)
    theirs = cloud.delaunay_3d(alpha=0.25)
    mine = {frozenset(row) for row in grid.cells_dict[pyvista.CellType.TETRA].tolist()}
    assert mine == {frozenset(row) for row in theirs.cells_dict[pyvista.CellType.TETRA].tolist()}
    assert grid.cell_data["circumradius"].max() <= 0.25
    assert len(grid.point_data["temperature"]) == 80
    with pytest.raises(ValueError, match="alpha must be a radius"):
        cloud.dt3d.delaunay(alpha=-1)


@pytest.mark.parametrize("alpha", [None, 0.15])
def test_a_terrain(cloud, alpha):
    surface = cloud.dt3d.delaunay_2d(alpha=alpha)
    tri = dt3d.Delaunay(POINTS[:, :2])
    expected = tri.simplices if alpha is None else tri.alpha_shape(alpha).simplices
    np.testing.assert_array_equal(surface.regular_faces, expected)
    np.testing.assert_array_equal(surface.points, POINTS)
    np.testing.assert_array_equal(surface.point_data["temperature"], cloud["temperature"])


def test_all_kinds_of_datasets_have_it():
    axis = np.arange(3.0)
    for dataset in (
        pyvista.ImageData(dimensions=(3, 3, 3)),
        pyvista.RectilinearGrid(axis, axis, axis),
        pyvista.StructuredGrid(*np.meshgrid(axis, axis, axis)),
        pyvista.ImageData(dimensions=(3, 3, 3)).cast_to_unstructured_grid(),
        pyvista.PointSet(POINTS[:27]),
    ):
        assert dataset.dt3d.delaunay().n_points == 27


def test_errors_are_those_of_the_class():
    with pytest.raises(dt3d.DegenerateInputError, match="lie on a plane"):
        pyvista.Plane().dt3d.delaunay()
    with pytest.raises(ValueError, match="points are empty"):
        pyvista.PolyData().dt3d.delaunay()


def test_the_entry_point_of_the_package_loads_it(tmp_path):
    """With metadata as pip writes it from pyproject.toml, and no import of dt3d."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    ((name, module),) = project["entry-points"]["pyvista.accessors"].items()
    metadata = tmp_path / "accessor_of_a_test-1.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: accessor-of-a-test\nVersion: 1\n")
    (metadata / "entry_points.txt").write_text(f"[pyvista.accessors]\n{name} = {module}\n")
    code = """import sys, pyvista
cloud = pyvista.ImageData(dimensions=(3, 3, 3))
cloud["x"] = cloud.points[:, 0]
assert "dt3d" not in sys.modules and "dt3d" in dir(cloud)
grid = cloud.dt3d.delaunay()
assert grid.n_cells == 48 and (grid.point_data["x"] == grid.points[:, 0]).all()"""
    paths = os.pathsep.join([str(tmp_path), str(ROOT), os.environ.get("PYTHONPATH", "")])
    subprocess.run([sys.executable, "-c", code], check=True, env=os.environ | {"PYTHONPATH": paths})


def test_it_is_an_attribute_of_the_package():
    code = "import pyvista, dt3d; dt3d.pyvista; print(pyvista.PolyData.dt3d)"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "dt3d.pyvista.Accessor" in out.stdout
    assert "pyvista" in dir(dt3d)


def test_registering_again_changes_nothing(cloud):
    before = cloud.dt3d
    dt3d.pyvista.register()
    assert cloud.dt3d is before


def test_an_old_pyvista_and_none_say_what_to_do(monkeypatch):
    monkeypatch.delattr(pyvista, "register_dataset_accessor")
    with pytest.raises(ImportError, match=r"has no accessors, which came with 0\.48; update it, or use"):
        dt3d.pyvista.register()
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match=r"dt3d\.pyvista needs PyVista.*pip install 'dt3d\[view\]'"):
        dt3d.pyvista.register()
