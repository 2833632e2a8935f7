"""Data of points, carried through `dt3d triangulate` from file to file."""

import io
import sys

import meshio
import numpy as np
import pytest
import pyvista as pv

from dt3d import cli
from dt3d.files import read_cloud

from .clouds import DATA, POINTS, TEXT, WRITERS, N, check, cloud, table


def run(capsys, *words):
    """Runs a command that must end well; what it says on standard error."""
    status = cli.main([str(word) for word in words])
    err = capsys.readouterr().err
    assert status == 0, err
    return "".join(line for line in err.splitlines(keepends=True) if "compiling" not in line)


def read_back(path, expected):
    """The point data of a mesh that another program reads, those that are expected."""
    if path.suffix == ".npz":
        with np.load(path) as arrays:
            return {name: arrays[name] for name in expected}
    if path.suffix == ".msh":
        found = meshio.read(path).point_data
        return {name: found[name] for name in expected}
    dataset = pv.read(path)
    return {name: np.asarray(dataset.point_data[name]) for name in expected}


@pytest.mark.parametrize("name", WRITERS)
@pytest.mark.parametrize("plane", [False, True])
def test_data_go_through_the_command_line(tmp_path, capsys, name, plane):
    write, expected = WRITERS[name]
    source = tmp_path / name
    write(source)
    mesh = tmp_path / "mesh.vtu"
    words = ["--dimension", "2"] if plane else []
    assert run(capsys, "triangulate", source, "-o", mesh, *words) == ""
    check(read_back(mesh, expected), expected)
    if plane:
        np.testing.assert_array_equal(pv.read(mesh)["z"], POINTS[:, 2])


@pytest.mark.parametrize(
    ("target", "plane"),
    [
        (".vtu", 0),
        (".vtk", 0),
        (".npz", 0),
        (".msh", 0),
        (".vtu", 1),
        (".vtk", 1),
        (".vtp", 1),
        (".npz", 1),
        (".msh", 1),
    ],
)
@pytest.mark.parametrize("packed", [False, True])
def test_every_output_that_holds_them(tmp_path, capsys, target, plane, packed):
    mesh, source = tmp_path / f"mesh{target}", tmp_path / "cloud.vtp"
    cloud().save(source)
    words = ["--dimension", "2"] * plane + ["--compress"] * packed
    err = run(capsys, "triangulate", source, "-o", mesh, *words)
    expected = dict(DATA)
    if target == ".msh":
        del expected["pair"]
        assert (
            err
            == "dt3d: point data left out: pair (.msh holds 1, 3 or 9 numbers per point, and this has 2)\n"
        )
    else:
        assert err == ""
    check(read_back(mesh, expected), expected, types=target != ".msh")  # Gmsh has double precision only


@pytest.mark.parametrize(
    ("target", "plane"), [(".ply", 0), (".stl", 0), (".mesh", 0), (".obj", 1), (".ply", 1)]
)
def test_what_the_output_cannot_hold_is_said_once(tmp_path, capsys, target, plane):
    source = tmp_path / "cloud.vtp"
    cloud().save(source)
    words = ["--dimension", "2"] * plane
    err = run(capsys, "triangulate", source, "-o", tmp_path / f"mesh{target}", *words)
    names = ", ".join([*DATA, *["z"] * plane])
    assert err == f"dt3d: point data left out: {names} ({target} holds no point data)\n"


def test_text_goes_where_it_can(tmp_path, capsys):
    source, mesh = tmp_path / "atoms.csv", tmp_path / "mesh.vtu"
    rows = [
        f"{x},{y},{z},{k % 3},C{k},{k / 8 if k % 2 else ''}" for k, (x, y, z) in enumerate(POINTS.tolist())
    ]
    source.write_text("x,y,z,chain,atom,charge\n" + "\n".join(rows) + "\n")
    err = run(capsys, "triangulate", source, "-o", mesh)
    assert err == "dt3d: point data left out: atom (.vtu holds numbers only, and this is text)\n"
    dataset = pv.read(mesh)
    assert dataset["chain"].tolist() == [k % 3 for k in range(N)]
    charges = np.where(np.arange(N) % 2, np.arange(N) / 8, np.nan)
    np.testing.assert_array_equal(dataset["charge"], charges)
    assert "atom" not in dataset.point_data
    assert run(capsys, "triangulate", source, "-o", tmp_path / "mesh.npz") == ""
    with np.load(tmp_path / "mesh.npz") as arrays:
        assert arrays["atom"].tolist() == [f"C{k}" for k in range(N)]


def test_text_and_bytes_of_arrays(tmp_path, capsys):
    source = tmp_path / "arrays.npz"
    values = {
        "name": np.array(["a"] * N),
        "raw": np.array([b"b"] * N),
        "when": np.full(N, np.datetime64("2026-01-01")),
    }
    np.savez(source, points=POINTS, **values, wave=np.ones(N, complex))
    err = run(capsys, "triangulate", source, "-o", tmp_path / "mesh.vtu")
    for name, kind in {"name": "text", "raw": "bytes", "when": "times", "wave": "complex numbers"}.items():
        assert f"{name} (.vtu holds numbers only, and this is {kind})" in err
    assert err.count("\n") == 1
    assert run(capsys, "triangulate", source, "-o", tmp_path / "mesh.npz") == ""
    check(read_back(tmp_path / "mesh.npz", values), values)


def test_text_of_vtk_is_named(tmp_path, capsys):
    dataset = cloud()
    dataset.point_data["species"] = np.array(["C", "Fe\n"] * (N // 2))
    dataset.save(tmp_path / "cloud.vtp")
    dataset.save(tmp_path / "cloud.vtk")
    dataset.save(tmp_path / "text.vtk", binary=False)
    err = run(capsys, "triangulate", tmp_path / "cloud.vtp", "-o", tmp_path / "mesh.npz")
    assert err == "dt3d: point data left out: species (text of VTK's XML files is not read)\n"
    for name in ("cloud.vtk", "text.vtk"):
        found = read_cloud(tmp_path / name)
        assert found.point_data["species"].tolist() == ["C", "Fe\n"] * (N // 2)
        check(found.point_data, DATA)


def test_arrays_of_another_length(tmp_path, capsys):
    source = tmp_path / "arrays.npz"
    np.savez(source, points=POINTS, faces=np.zeros((7, 3), int), good=np.arange(N), scale=2.0)
    found = read_cloud(source)
    assert list(found.point_data) == ["good"]
    assert found.left_out == {
        "faces": f"its shape is (7, 3), and there are {N} points",
        "scale": f"its shape is (), and there are {N} points",
    }
    err = run(capsys, "triangulate", source, "-o", tmp_path / "mesh.npz", "--quiet")
    assert err.startswith(
        "dt3d: point data left out: faces (its shape is (7, 3), and there are 60 points); scale"
    )
    assert err.count("\n") == 1


def test_a_mesh_of_our_own_has_no_data_but_those_of_its_points(tmp_path, capsys):
    source, mesh = tmp_path / "cloud.npz", tmp_path / "mesh.npz"
    np.savez(source, points=POINTS, temperature=DATA["temperature"])
    run(capsys, "triangulate", source, "-o", mesh)
    found = read_cloud(mesh)
    assert list(found.point_data) == ["temperature"]
    assert found.left_out == {}


@pytest.mark.parametrize(
    ("name", "old", "new", "message"),
    [
        ("text.vtp", b'"big" format', b'"big" NumberOfComponents="2" format', "'big' is damaged: 60 numbers"),
        ("text.vtk", b"class 1 60", b"class 1 59", "array 'class' has 59 entries, and there are 60 points"),
        ("text.vtk", b"POINT_DATA 60", b"POINT_DATA 59", "have shape (59,), and there are 60 points"),
        ("text.vtk", b"unsigned_char\n0 1", b"unsigned_char\n0 256", "have 256, which is beyond"),
        ("text.ply", b" 0 -7 ", b" 300 -7 ", "'class' have 300, which is beyond their type uint8"),
    ],
)  # fmt: skip
def test_broken_arrays_are_named(tmp_path, capsys, name, old, new, message):
    source = tmp_path / name
    WRITERS[name][0](source)
    data = source.read_bytes()
    assert old in data
    source.write_bytes(data.replace(old, new, 1))
    with pytest.raises(ValueError, match=r"^[^\n]*$") as error:
        read_cloud(source)
    assert message in str(error.value)
    assert str(source) in str(error.value)
    assert cli.main(["triangulate", str(source), "-o", str(tmp_path / "mesh.vtu")]) == 2
    assert message in capsys.readouterr().err


def test_columns_without_names_are_named(tmp_path, capsys):
    source = tmp_path / "scan.xyz"
    source.write_text("".join(f"{x} {y} {z} 7 8\n" for x, y, z in POINTS.tolist()))
    err = run(capsys, "triangulate", source, "-o", tmp_path / "mesh.vtu")
    assert err == "dt3d: point data left out: columns 4 to 5 (they have no names, as by '# x y z c4 c5')\n"
    source = tmp_path / "scan.pts"
    source.write_text(f"{N}\n" + "".join(f"{x} {y} {z} 7\n" for x, y, z in POINTS.tolist()))
    assert read_cloud(source).left_out == {"columns 4 to 4": "they have no names"}


def test_streams_and_json(tmp_path, capsys, monkeypatch):
    table(tmp_path / "a.csv", ",", "")
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO((tmp_path / "a.csv").read_bytes())))
    status = cli.main(["triangulate", "-", "-o", str(tmp_path / "mesh.vtu"), "--format", "csv", "--json"])
    out = capsys.readouterr().out
    assert status == 0
    assert '"point_data": ["temperature", "big"], "left_out": {}' in out
    check(read_back(tmp_path / "mesh.vtu", TEXT), TEXT)
