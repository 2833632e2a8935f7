"""What a file says of its points: read beside them, and carried through `dt3d triangulate`."""

import gzip
import io
import struct
import sys

import meshio
import numpy as np
import pytest
import pyvista as pv

from dt3d import cli
from dt3d.files import read_cloud, read_points
from dt3d.reading.point_data import PointData, join
from dt3d.reading.text_values import values_of

N = 60
RANDOM = np.random.default_rng(11)
POINTS = np.round(256 * RANDOM.random((N, 3))) / 256  # which scaled integers and text hold
POINTS[-1] = POINTS[0]  # a site that is not used
DATA = {
    "temperature": np.round(RANDOM.random(N), 3).astype(np.float32),
    "big": 2**40 + np.arange(N),
    "class": (np.arange(N) % 5).astype(np.uint8),
    "velocity": np.round(RANDOM.random((N, 3)), 3),  # text of VTK has twelve digits
    "pair": np.arange(2 * N, dtype=np.int16).reshape(N, 2),
}


def cloud():
    """A dataset of PyVista with all that it holds."""
    dataset = pv.PolyData(POINTS)
    for name, values in DATA.items():
        dataset.point_data[name] = values
    return dataset


def structured():
    table = np.zeros(
        N, [(axis, "f8") for axis in "xyz"] + [(k, v.dtype, v.shape[1:]) for k, v in DATA.items()]
    )
    for axis, column in zip("xyz", POINTS.T, strict=True):
        table[axis] = column
    for name, values in DATA.items():
        table[name] = values
    return table


def ply(path, order):
    kinds = {"f8": "double", "f4": "float", "u1": "uchar", "i4": "int"}
    columns = {**dict(zip("xyz", POINTS.T, strict=True)), **SCALARS}
    header = f"ply\nformat {order} 1.0\nelement vertex {N}\n"
    header += "".join(f"property {kinds[v.dtype.str[1:]]} {k}\n" for k, v in columns.items()) + "end_header\n"
    if order == "ascii":
        rows = zip(*[v.tolist() for v in columns.values()], strict=True)
        path.write_text(header + "".join(" ".join(map(repr, row)) + "\n" for row in rows))
        return
    sign = "<" if "little" in order else ">"
    table = np.zeros(N, [(k, v.dtype.newbyteorder(sign)) for k, v in columns.items()])
    for name, values in columns.items():
        table[name] = values
    path.write_bytes(header.encode() + table.tobytes())


SCALARS = {
    "temperature": DATA["temperature"],
    "class": DATA["class"],
    "label": np.arange(N, dtype=np.int32) - 7,
    "energy": RANDOM.random(N),
}


def pcd(path, form):
    fields = {**dict(zip("xyz", POINTS.T, strict=True)), **SCALARS, "normal": DATA["velocity"]}
    lines = [
        "VERSION 0.7",
        "FIELDS " + " ".join(fields),
        "SIZE " + " ".join(str(v.dtype.itemsize) for v in fields.values()),
        "TYPE " + " ".join({"u": "U", "i": "I", "f": "F"}[v.dtype.kind] for v in fields.values()),
        "COUNT " + " ".join(str(v[0].size) for v in fields.values()),
        f"WIDTH {N}\nHEIGHT 1\nPOINTS {N}\nDATA {form}\n",
    ]
    head = "\n".join(lines).encode()
    if form == "ascii":
        rows = np.column_stack([v.astype(float) for v in fields.values()])
        path.write_bytes(head + b"".join(" ".join(map(repr, r)).encode() + b"\n" for r in rows.tolist()))
    elif form == "binary":
        table = np.zeros(N, [(k, v.dtype, v.shape[1:]) for k, v in fields.items()])
        for name, values in fields.items():
            table[name] = values
        path.write_bytes(head + table.tobytes())
    else:
        plain = b"".join(v.tobytes() for v in fields.values())
        literal = b"".join(
            bytes([len(c) - 1]) + c for c in (plain[k : k + 32] for k in range(0, len(plain), 32))
        )
        path.write_bytes(head + struct.pack("<II", len(literal), len(plain)) + literal)


def table(path, comma, head):
    columns = {
        **dict(zip("xyz", POINTS.T, strict=True)),
        "temperature": TEXT["temperature"],
        "big": TEXT["big"],
    }
    rows = zip(*[v.tolist() for v in columns.values()], strict=True)
    text = head + comma.join(columns) + "\n" + "".join(comma.join(map(repr, row)) + "\n" for row in rows)
    path.write_text(text)


TEXT = {"temperature": np.round(RANDOM.random(N), 3), "big": DATA["big"]}


def lammps(path):
    lines = [f"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{N}\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1"]
    lines.append("ITEM: ATOMS big x y z temperature")
    rows = zip(TEXT["big"].tolist(), *POINTS.T.tolist(), TEXT["temperature"].tolist(), strict=True)
    path.write_text("\n".join([*lines, *(" ".join(map(repr, row)) for row in rows)]) + "\n")


def extended(path):
    rows = zip(TEXT["big"].tolist(), *POINTS.T.tolist(), TEXT["temperature"].tolist(), strict=True)
    head = f"{N}\nProperties=big:I:1:pos:R:3:temperature:R:1\n"
    path.write_text(head + "".join(" ".join(map(repr, row)) + "\n" for row in rows))


def las(path):
    laspy = pytest.importorskip("laspy")
    if path.suffix == ".laz":
        pytest.importorskip("lazrs")
    header = laspy.LasHeader(point_format=3, version="1.4")
    header.scales = [1 / 256] * 3
    header.add_extra_dim(laspy.ExtraBytesParams("temperature", np.float32))
    header.add_extra_dim(laspy.ExtraBytesParams("velocity", "3f8"))
    scan = laspy.LasData(header)
    scan.xyz = POINTS
    scan.classification, scan.intensity = DATA["class"], np.arange(N, dtype=np.uint16) * 7
    scan["temperature"], scan["velocity"] = DATA["temperature"], DATA["velocity"]
    scan.write(str(path))


LAS = {
    "temperature": DATA["temperature"], "classification": DATA["class"], "velocity": DATA["velocity"],
    "intensity": np.arange(N, dtype=np.uint16) * 7,
}  # fmt: skip
WRITERS = {
    "binary.vtp": (lambda path: cloud().save(path), DATA),
    "text.vtp": (lambda path: cloud().save(path, binary=False), DATA),
    "binary.vtu": (lambda path: cloud().cast_to_unstructured_grid().save(path), DATA),
    "binary.vtk": (lambda path: cloud().save(path), DATA),
    "text.vtk": (lambda path: cloud().save(path, binary=False), DATA),
    "meshio.vtu": (lambda path: meshio.Mesh(POINTS, [("vertex", [[0]])], DATA).write(path), DATA),
    "text.ply": (lambda path: ply(path, "ascii"), SCALARS),
    "little.ply": (lambda path: ply(path, "binary_little_endian"), SCALARS),
    "big.ply": (lambda path: ply(path, "binary_big_endian"), SCALARS),
    "arrays.npz": (lambda path: np.savez(path, points=POINTS, **DATA), DATA),
    "table.npy": (lambda path: np.save(path, structured()), DATA),
    "text.pcd": (lambda path: pcd(path, "ascii"), {**SCALARS, "normal": DATA["velocity"]}),
    "binary.pcd": (lambda path: pcd(path, "binary"), {**SCALARS, "normal": DATA["velocity"]}),
    "packed.pcd": (lambda path: pcd(path, "binary_compressed"), {**SCALARS, "normal": DATA["velocity"]}),
    "table.csv": (lambda path: table(path, ",", ""), TEXT),
    "table.tsv": (lambda path: table(path, "\t", ""), TEXT),
    "table.txt": (lambda path: table(path, " ", "# "), TEXT),
    "table.xyz": (lambda path: table(path, " ", "# "), TEXT),
    "table.asc": (lambda path: table(path, " ", "# "), TEXT),
    "table.pts": (lambda path: table(path, " ", "# "), TEXT),
    "extended.xyz": (extended, TEXT),
    "atoms.dump": (lammps, TEXT),
    "scan.las": (las, LAS),
    "scan.laz": (las, LAS),
}  # fmt: skip


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


def check(found, expected, *, types=True):
    for name, values in expected.items():
        np.testing.assert_array_equal(found[name], values)
        if types:
            assert found[name].dtype == values.dtype, name


@pytest.mark.parametrize("name", WRITERS)
def test_a_cloud_has_points_and_their_data(tmp_path, name):
    write, expected = WRITERS[name]
    path = tmp_path / name
    write(path)
    found = read_cloud(path)
    np.testing.assert_array_equal(found.points, POINTS)
    np.testing.assert_array_equal(read_points(path), POINTS)
    check(found.point_data, expected)
    assert found.left_out == {}
    assert all(values.flags.writeable for values in found.point_data.values())

    (tmp_path / f"{name}.gz").write_bytes(gzip.compress(path.read_bytes()))
    check(read_cloud(tmp_path / f"{name}.gz").point_data, expected)


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


def test_pieces_and_blocks(tmp_path):
    parts = [cloud(), cloud()]
    del parts[1].point_data["pair"]
    parts[1].point_data["class"] = parts[1]["class"].astype(float)
    blocks = pv.MultiBlock(parts)
    blocks.save(tmp_path / "both.vtm")
    found = read_cloud(tmp_path / "both.vtm")
    assert found.points.shape == (2 * N, 3)
    twice = {name: np.concatenate([DATA[name]] * 2) for name in ("temperature", "big", "velocity")}
    check(found.point_data, twice)
    assert found.left_out == {
        "class": "its type is not the same in all pieces",
        "pair": "1 of 2 pieces have it",
    }


def test_images_and_grids(tmp_path):
    image = pv.ImageData(dimensions=(3, 4, 5))
    image["value"] = np.arange(60, dtype=np.int32)
    image.save(tmp_path / "image.vti")
    image.cast_to_rectilinear_grid().save(tmp_path / "grid.vtr")
    image.cast_to_structured_grid().save(tmp_path / "grid.vts")
    image.save(tmp_path / "image.vtk")
    for name in ("image.vti", "grid.vtr", "grid.vts", "image.vtk"):
        found = read_cloud(tmp_path / name)
        check(found.point_data, {"value": np.arange(60, dtype=np.int32)})
        np.testing.assert_allclose(found.points, image.points)


def test_attributes_of_the_legacy_format(tmp_path):
    rows = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
    text = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n" + rows
    text += "POINT_DATA 4\nSCALARS heat short 1\nLOOKUP_TABLE mine\n1 2 3 4\n"
    text += "LOOKUP_TABLE mine 2\n0 0 0 1 1 1 1 1\nVECTORS flow%20field float\n" + rows
    text += "COLOR_SCALARS paint 3\n" + rows + "TEXTURE_COORDINATES uv 2 double\n0 0 1 0 0 1 1 1\n"
    text += "FIELD FieldData 1\non 1 4 bit\n1 0 1 1\nSOMETHING else\n"
    (tmp_path / "cloud.vtk").write_text(text)
    found = read_cloud(tmp_path / "cloud.vtk")
    types = {name: (values.dtype.str[1:], values.shape) for name, values in found.point_data.items()}
    assert types == {
        "heat": ("i2", (4,)),
        "flow field": ("f4", (4, 3)),
        "paint": ("f4", (4, 3)),
        "uv": ("f8", (4, 2)),
        "on": ("b1", (4,)),
    }
    assert found.point_data["on"].tolist() == [True, False, True, True]
    assert found.left_out == {"SOMETHING": "what begins with this word is not understood"}


def test_columns_without_names_are_named(tmp_path, capsys):
    source = tmp_path / "scan.xyz"
    source.write_text("".join(f"{x} {y} {z} 7 8\n" for x, y, z in POINTS.tolist()))
    err = run(capsys, "triangulate", source, "-o", tmp_path / "mesh.vtu")
    assert err == "dt3d: point data left out: columns 4 to 5 (they have no names, as by '# x y z c4 c5')\n"
    source = tmp_path / "scan.pts"
    source.write_text(f"{N}\n" + "".join(f"{x} {y} {z} 7\n" for x, y, z in POINTS.tolist()))
    assert read_cloud(source).left_out == {"columns 4 to 4": "they have no names"}


def test_elements_of_molecules(tmp_path):
    source = tmp_path / "molecule.xyz"
    source.write_text(
        f"{N}\ncomment\n" + "".join(f"C{k} {x} {y} {z}\n" for k, (x, y, z) in enumerate(POINTS.tolist()))
    )
    assert read_cloud(source).point_data["element"].tolist() == [f"C{k}" for k in range(N)]


def test_lists_of_vertices_and_objects(tmp_path):
    head = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
    (tmp_path / "lists.ply").write_text(
        head + "property list uchar int near\nend_header\n0 0 0 1 1\n1 1 1 0\n"
    )
    assert read_cloud(tmp_path / "lists.ply").left_out == {"near": "it is a list"}
    np.savez(tmp_path / "a.npz", points=POINTS, things=np.array([{}] * N))
    assert read_cloud(tmp_path / "a.npz").left_out == {"things": "it holds Python objects"}


def test_an_index_of_pandas_is_no_data(tmp_path):
    (tmp_path / "a.csv").write_text(",x,y,z,t\n0,0,0,0,5\n1,1,0,0,6\n2,0,1,0,7\n")
    found = read_cloud(tmp_path / "a.csv")
    assert (list(found.point_data), found.left_out) == (["t"], {})
    (tmp_path / "b.csv").write_text(",x,y,z,t\n9,0,0,0,5\n1,1,0,0,6\n2,0,1,0,7\n")
    assert read_cloud(tmp_path / "b.csv").left_out == {"column 1": "it has no name"}


def test_heights_are_data_in_the_plane_unless_they_are_all_equal(tmp_path):
    np.save(tmp_path / "a.npy", POINTS)
    found = read_cloud(tmp_path / "a.npy", dimension=2)
    np.testing.assert_array_equal(found.point_data["z"], POINTS[:, 2])
    np.save(tmp_path / "b.npy", POINTS * [1, 1, 0])
    assert read_cloud(tmp_path / "b.npy", dimension=2).point_data == {}


def test_streams_and_json(tmp_path, capsys, monkeypatch):
    table(tmp_path / "a.csv", ",", "")
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO((tmp_path / "a.csv").read_bytes())))
    status = cli.main(["triangulate", "-", "-o", str(tmp_path / "mesh.vtu"), "--format", "csv", "--json"])
    out = capsys.readouterr().out
    assert status == 0
    assert '"point_data": ["temperature", "big"], "left_out": {}' in out
    check(read_back(tmp_path / "mesh.vtu", TEXT), TEXT)


@pytest.mark.parametrize(
    ("cells", "kind"),
    [
        (["1", "-2", "+3"], "int64"),
        (["1", "18446744073709551615"], "uint64"),
        (["1", "1.5", "nan", "-inf"], "float64"),
        (["1", "", "NA"], "float64"),
        (["1.0D+00", "2"], "float64"),
        (["1_000", "2"], "U"),
        (["\u0661", "2"], "U"),
        (["1", "C"], "U"),
        (["9007199254740993", "0.5"], "U"),  # float64 does not hold it
    ],
)
def test_what_cells_are(cells, kind):
    found = values_of(cells)
    assert str(found.dtype) == kind or found.dtype.kind == kind


def test_decimal_commas():
    np.testing.assert_array_equal(values_of(["0,5", "1"], ","), [0.5, 1])


def test_names_are_kept_apart_and_printable():
    keep = PointData()
    for name in ("a", "a", "b\x01", ""):
        keep.add(name, np.zeros(2))
    assert list(keep.arrays) == ["a", "a_2", "b", "unnamed"]
    with pytest.raises(ValueError, match=r"cloud: point data 'a' have shape \(2,\), and there are 3 points"):
        keep.check("cloud", 3)
    join(None, [keep])
    keep.add("mixed", np.zeros(2, [("p", int)]))
    assert "mixed" in keep.left_out


def gmsh(rows, tags=(4, 2, 9, 1)):
    """A file with four nodes and one view of them, in text."""
    nodes = "".join(f"{tag} {k % 2} {k // 2} {k == 3:d}\n" for k, tag in enumerate(tags))
    head = f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n{nodes}$EndNodes\n$Elements\n0\n$EndElements\n"
    view = f'$NodeData\n1\n"warm air"\n1\n0.0\n3\n0\n1\n{len(rows)}\n'
    return head + view + "".join(f"{tag} {value}\n" for tag, value in rows) + "$EndNodeData\n"


def test_views_of_gmsh_go_by_the_tags_of_nodes(tmp_path):
    path = tmp_path / "a.msh"
    path.write_text(gmsh([(1, 10.5), (2, 20), (4, 40), (9, 90)]))
    assert read_cloud(path).point_data["warm air"].tolist() == [40, 20, 90, 10.5]
    path.write_text(gmsh([(1, 10.5), (2, 20)]))
    found = read_cloud(path)
    assert (dict(found.point_data), found.left_out) == ({}, {"warm air": "2 of 4 nodes have it"})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            gmsh([(1, 1), (2, 2), (4, 4), (4, 9)]),
            "data 'warm air' name a node twice, or one that is not there",
        ),
        (
            gmsh([(1, 1), (2, 2), (4, 4), (5, 9)]),
            "data 'warm air' name a node twice, or one that is not there",
        ),
        (gmsh([(1, 1)]).replace("$EndNodeData", "7"), "expected \\$EndNodeData after 'warm air', found '7'"),
        (gmsh([(1, 1)]).replace("\n1\n1\n1 1", "\n0\n1\n1 1"), "have the integer tags \\[0, 0, 1\\]"),
        (
            gmsh([(1, 1)]).replace("\n0.0\n3\n", "\n0.0\nx\n"),
            "expected the number of integer tags, found 'x'",
        ),
    ],
)
def test_broken_views_of_gmsh(tmp_path, text, message):
    path = tmp_path / "a.msh"
    path.write_text(text)
    with pytest.raises(ValueError, match=message):
        read_cloud(path)
    assert len(read_points(path)) == 4
