"""Where an optional package is missing, the message names an extra of pyproject.toml that brings it."""

import re
import sys
import tomllib
from pathlib import Path

import laspy
import numpy as np
import pytest
import pyvista
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

import dt3d
from dt3d import cli, samples
from dt3d._mesh_plane import write_plane_mesh
from dt3d._optional import EXTRAS, optional
from dt3d._output import new_figure
from dt3d.files import read_points, write_mesh

ROOT = Path(dt3d.__file__).parents[1]
POINTS = np.random.default_rng(2).random((30, 3))
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def brought_by(extra):
    """The packages of an extra, those of the extras that it names included."""
    found = set()
    for requirement in PROJECT["optional-dependencies"][extra]:
        name, inner = re.fullmatch(r"([\w-]+)(?:\[([\w,]+)\])?.*", requirement).groups()
        if name == "dt3d":
            found |= set().union(*map(brought_by, inner.split(",")))
        else:
            found |= {name, *(inner or "").split(",")}
    return found


@pytest.fixture
def without(monkeypatch):
    """Makes a package and its modules such as are not installed."""

    def block(package):
        for name in [package, *sys.modules]:
            if name.partition(".")[0] == package:
                monkeypatch.setitem(sys.modules, name, None)

    return block


def las(tmp_path, name):
    scan = laspy.LasData(laspy.LasHeader(point_format=3))
    scan.xyz = POINTS
    scan.write(str(tmp_path / name))
    return tmp_path / name


def cif(tmp_path):
    path = tmp_path / "a.cif"
    path.write_text("data_a\n")
    return path


def packed_by_lz4(tmp_path):
    writer = vtkXMLPolyDataWriter()
    writer.SetFileName(str(tmp_path / "a.vtp"))
    writer.SetInputData(pyvista.PolyData(POINTS))
    writer.SetCompressorTypeToLZ4()
    writer.Write()
    return tmp_path / "a.vtp"


# the package, what the test prepares, and a call that needs it
TRI, PLANE = dt3d.Delaunay(POINTS), dt3d.Delaunay(POINTS[:, :2])
CALLS = {
    "to_pyvista": ("pyvista", None, lambda _: TRI.to_pyvista()),
    "hull_to_pyvista": ("pyvista", None, lambda _: TRI.hull_to_pyvista()),
    "plot": ("pyvista", None, lambda _: TRI.plot()),
    "write .vtk": ("pyvista", lambda path: path / "a.vtk", lambda path: write_mesh(TRI, path)),
    "plane .vtk": ("pyvista", lambda path: path / "a.vtk", lambda path: write_plane_mesh(PLANE, path)),
    "to_meshio": ("meshio", None, lambda _: TRI.to_meshio()),
    "write .msh": ("meshio", lambda path: path / "a.msh", lambda path: write_mesh(TRI, path)),
    "write .mesh": ("meshio", lambda path: path / "a.mesh", lambda path: write_mesh(TRI, path)),
    "write .ply": ("meshio", lambda path: path / "a.ply", lambda path: write_mesh(TRI, path)),
    "plane .msh": ("meshio", lambda path: path / "a.msh", lambda path: write_plane_mesh(PLANE, path)),
    "figure": ("matplotlib", None, lambda _: new_figure(2, 2)),
    "plane plot": ("matplotlib", None, lambda _: PLANE.plot()),
    "read .las": ("laspy", lambda path: las(path, "a.las"), read_points),
    "read .laz": ("lazrs", lambda path: las(path, "a.laz"), read_points),
    "read .cif": ("gemmi", cif, read_points),
    "read packed .vtp": ("lz4", packed_by_lz4, read_points),
}  # fmt: skip


@pytest.mark.parametrize("name", CALLS)
def test_the_message_names_the_extra(tmp_path, without, name):
    package, prepare, call = CALLS[name]
    given = None if prepare is None else prepare(tmp_path)
    without(package)
    with pytest.raises(ImportError, match=r"needs .*pip install 'dt3d\[\w+\]'") as error:
        call(given)
    assert re.search(package, str(error.value), re.IGNORECASE)
    (extra,) = re.findall(r"dt3d\[(\w+)\]", str(error.value))
    assert package in brought_by(extra)


def test_the_command_line_says_so_in_one_line(tmp_path, without, capsys):
    path = cif(tmp_path)
    without("gemmi")
    assert cli.main(["triangulate", str(path), "-o", str(tmp_path / "a.vtu")]) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert err.endswith("install it with: pip install 'dt3d[formats]'\n")


def test_all_that_is_optional_is_in_an_extra():
    assert set(EXTRAS.values()) | {"formats"} <= PROJECT["optional-dependencies"].keys()
    for package, extra in EXTRAS.items():
        assert package in brought_by(extra)
    assert brought_by("files") == brought_by("formats")
    with pytest.raises(ImportError, match=r"this needs nowhere, which cannot be loaded"):
        optional("nowhere")


def test_samples_need_nothing(without):
    for package in ("pyvista", "matplotlib", "meshio", "laspy", "lz4", "gemmi"):
        without(package)
    assert samples.mtor().shape == (22194, 3)
