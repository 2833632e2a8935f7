"""What imports what, and what an import costs."""

import subprocess
import sys

import pytest

import dt3d


def loaded_by(statement):
    code = f"import sys\n{statement}\nprint(*sorted(sys.modules))"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(out.stdout.split())


def test_importing_dt3d_loads_no_viewer_and_no_command_line():
    modules = loaded_by("import dt3d; dt3d.Delaunay")
    viewers = {"pyvista", "vtk", "vtkmodules", "matplotlib", "meshio"}
    assert modules.isdisjoint(viewers | {"numba", "rich", "cyclopts", "scipy", "jax", "scanvec"})


def test_modules_are_attributes():
    code = "import dt3d; print(dt3d.interpolate.Linear, dt3d.threaded2d.Delaunay, dt3d.files.read_points)"
    subprocess.run([sys.executable, "-c", code], check=True)
    assert {"interpolate", "threaded2d", "jax"} <= set(dir(dt3d))


def test_inserting_loads_no_jax():
    code = """import numpy, dt3d
points = numpy.random.default_rng(0).random((50, 3))
for tri in dt3d.Delaunay(points), dt3d.Delaunay(points[:, :2]):
    tri.find_simplex(points[:, :tri.ndim]), tri.verify(), tri.convex_hull, tri.vertex_neighbor_vertices
    tri.subset([0]).boundary, tri.transform, tri.equations"""
    modules = loaded_by(code)
    assert "numba" in modules
    assert "jax" not in modules
    assert "jax" in loaded_by(
        "import dt3d; dt3d.Delaunay([[0,0,0],[1,0,0],[0,1,0],[0,0,1]], method='extrapolation')"
    )


def test_every_public_name_is_there_and_no_other():
    assert {name for name in dt3d.__all__ if getattr(dt3d, name) is not None} == set(dt3d.__all__)
    assert set(dt3d.__all__) <= set(dir(dt3d))
    with pytest.raises(AttributeError, match="module 'dt3d' has no attribute 'Delauney'"):
        dt3d.Delauney  # noqa: B018


def test_scanvec_does_not_know_dt3d():
    assert not any(name.split(".")[0] == "dt3d" for name in loaded_by("import scanvec"))


@pytest.mark.parametrize("package", ["scanvec", "dt3d"])
def test_jax_keeps_its_default_precision(package):
    code = f"import {package}, jax; assert not jax.config.jax_enable_x64"
    subprocess.run([sys.executable, "-c", code], check=True)
