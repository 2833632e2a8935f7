"""What imports what, and what an import costs."""

import subprocess
import sys

import pytest


def loaded_by(statement):
    code = f"import sys\n{statement}\nprint(*sorted(sys.modules))"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return set(out.stdout.split())


def test_importing_dt3d_loads_no_viewer_and_no_command_line():
    modules = loaded_by("import dt3d")
    assert "jax" in modules
    viewers = {"pyvista", "vtk", "vtkmodules", "matplotlib", "meshio"}
    assert modules.isdisjoint(viewers | {"numba", "rich", "cyclopts", "scipy.spatial"})


def test_scanvec_does_not_know_dt3d():
    assert not any(name.split(".")[0] == "dt3d" for name in loaded_by("import scanvec"))


@pytest.mark.parametrize("package", ["scanvec", "dt3d"])
def test_jax_keeps_its_default_precision(package):
    code = f"import {package}, jax; assert not jax.config.jax_enable_x64"
    subprocess.run([sys.executable, "-c", code], check=True)
