"""Files that promise what they do not hold, or hold what they do not say, each kind by its name."""

import struct
import subprocess
import sys
import zipfile

import numpy as np
import pytest

from dt3d import cli
from dt3d.files import read_mesh, read_points
from dt3d.reading import npy

from .good_files import POINTS, ROWS, TETRAHEDRA, gmsh, las, ply, stl, vtk, vtu

N = len(POINTS)
MANY = 4_000_000_000


def refused(path, sentence, read=read_points):
    """The file is refused by one line that names it and has this sentence."""
    with pytest.raises((ValueError, OSError), match=sentence) as caught:
        read(path)
    message = str(caught.value)
    assert message.isprintable()
    assert str(path) in message


def changed(path, writer, old, new):
    """A file of the writer in which some bytes, which must be there, are others."""
    writer(path)
    data = path.read_bytes()
    assert old in data
    path.write_bytes(data.replace(old, new, 1))
    return path


def test_an_array_header_that_promises_billions_of_rows(tmp_path):
    old, new = b"(18, 3), }        ", b"(4000000000, 3), }"
    path = changed(tmp_path / "a.npy", lambda p: np.save(p, POINTS), old, new)
    refused(path, r"promises shape \(4000000000, 3\) of float64, 96000000000 bytes; there are 432")


def test_an_array_header_that_promises_fewer_rows_than_there_are(tmp_path):
    path = changed(tmp_path / "a.npy", lambda p: np.save(p, POINTS), b"(18, 3)", b"(17, 3)")
    refused(path, "promises .* 408 bytes; there are 432")


def test_objects_are_refused_and_the_advice_works(tmp_path):
    array = POINTS.astype(object)
    np.save(tmp_path / "a.npy", array)
    refused(tmp_path / "a.npy", r"Python objects.*np\.save\(file, array\.astype\(float\)\)")
    np.save(tmp_path / "a.npy", array.astype(float))
    np.testing.assert_array_equal(read_points(tmp_path / "a.npy"), POINTS)


def test_coordinates_that_are_kept_apart(tmp_path):
    x, y, z = POINTS.T
    np.savez(tmp_path / "a.npz", x=x, y=y.astype(np.float32), z=z, weights=x)
    np.testing.assert_array_equal(read_points(tmp_path / "a.npz"), POINTS)
    np.savez(tmp_path / "flat.npz", X=x, Y=y)
    np.testing.assert_array_equal(read_points(tmp_path / "flat.npz", dimension=None), POINTS[:, :2])
    np.savez(tmp_path / "short.npz", x=x, y=y, z=z[:-1])
    refused(tmp_path / "short.npz", "differ in number: x has 18, y has 18, z has 17")
    table = np.zeros(N, [("red", "u1"), ("z", "f8"), ("x", "f8"), ("y", "f4")])
    table["x"], table["y"], table["z"] = x, y, z
    np.save(tmp_path / "table.npy", table)
    np.testing.assert_array_equal(read_points(tmp_path / "table.npy"), POINTS)


def test_integers_beside_floats_are_not_rounded_on_the_way(tmp_path):
    np.savez(tmp_path / "a.npz", x=np.array([2**53 + 1]), y=np.array([0.5]), z=np.array([0.5]))
    refused(tmp_path / "a.npz", r"row 0 of .*a\.npz: x is 9007199254740993, which float64 does not hold")


def test_an_array_with_a_usual_name_among_others(tmp_path):
    np.savez(tmp_path / "a.npz", pos=POINTS, velocity=POINTS)
    np.testing.assert_array_equal(read_points(tmp_path / "a.npz"), POINTS)
    np.savez(tmp_path / "b.npz", pos=POINTS, xyz=POINTS)
    refused(tmp_path / "b.npz", "arrays x, y and z, or a single array; found pos, xyz")


def test_an_archive_that_unpacks_to_more_than_memory_is_refused_before(tmp_path, monkeypatch):
    np.savez_compressed(tmp_path / "a.npz", points=np.zeros((100_000, 3)))
    monkeypatch.setattr(npy, "available_memory", lambda: 2_000_000)
    refused(tmp_path / "a.npz", r"array 'points' needs 2\.4 MB of memory; 2\.0 MB are available")


def test_an_archive_whose_directory_lies_about_sizes(tmp_path):
    np.savez(tmp_path / "a.npz", points=POINTS)
    with zipfile.ZipFile(tmp_path / "a.npz") as archive:
        entry = archive.infolist()[0]
    data = (tmp_path / "a.npz").read_bytes()
    at = data.rindex(b"PK\x01\x02") + 24
    assert struct.unpack_from("<I", data, at)[0] == entry.file_size
    path = tmp_path / "b.npz"
    path.write_bytes(data[:at] + struct.pack("<I", MANY) + data[at + 4 :])
    refused(path, r"array 'points' is said to unpack to 4\.0 GB, which its data cannot")


def test_an_archive_with_a_changed_number(tmp_path):
    old = struct.pack("<d", 7.5)
    path = changed(tmp_path / "a.npz", lambda p: np.savez(p, points=POINTS), old, b"\1" * 8)
    refused(path, "array 'points' is damaged: Bad CRC-32")


@pytest.mark.parametrize("form", ["ASCII", "BINARY"])
def test_a_legacy_file_that_is_cut_off_is_no_uninitialised_memory(tmp_path, form):
    vtk(tmp_path / "a.vtk", form)
    data = (tmp_path / "a.vtk").read_bytes()
    points_end = data.index(b"METADATA")
    for length in range(0, len(data), 7):
        (tmp_path / "b.vtk").write_bytes(data[:length])
        if length < points_end - 1:
            refused(tmp_path / "b.vtk", "cut off|no VTK file|or BINARY|are of type|no keyword|no points")
            continue
        try:
            points = read_points(tmp_path / "b.vtk")
        except ValueError:
            continue
        np.testing.assert_array_equal(points, POINTS)


def test_letters_that_are_no_base64(tmp_path):
    path = changed(tmp_path / "a.vtu", lambda p: vtu(p, "binary"), b"AAAAAA", b"AA@AAA")
    refused(path, "array 'Points' is damaged: Only base64 data is allowed")


def test_a_file_of_vtk_that_promises_billions_of_points(tmp_path):
    lie = f'NumberOfPoints="{MANY}"'.encode()
    path = changed(tmp_path / "a.vtu", vtu, f'NumberOfPoints="{N}"'.encode(), lie)
    refused(path, "need .* of memory|damaged")
    path = changed(tmp_path / "a.vtk", vtk, b"POINTS 18", b"POINTS %d" % MANY)
    refused(path, "the number of points is 4000000000, more than the file has bytes")
    (tmp_path / "a.vti").write_text(
        '<VTKFile type="ImageData"><ImageData WholeExtent="0 99999 0 99999 0 99999"><Piece/></ImageData>'
        "</VTKFile>"
    )
    refused(tmp_path / "a.vti", "the 1000000000000000 points of the image need .* of memory")


def test_entities_of_xml_are_refused(tmp_path):
    path = changed(tmp_path / "a.vtu", vtu, b"<VTKFile", b'<!DOCTYPE x [<!ENTITY a "b">]><VTKFile')
    refused(path, "a document type")


def test_the_points_of_all_blocks_or_the_name_of_the_missing_one(tmp_path):
    (tmp_path / "blocks").mkdir()
    vtu(tmp_path / "blocks" / "0.vtu")
    vtu(tmp_path / "blocks" / "1.vtu", "binary")
    (tmp_path / "a.vtm").write_text(
        '<VTKFile type="vtkMultiBlockDataSet"><vtkMultiBlockDataSet><DataSet index="0" file="blocks/0.vtu"/>'
        '<Block index="1"><DataSet index="0" file="blocks/1.vtu"/></Block></vtkMultiBlockDataSet></VTKFile>'
    )
    np.testing.assert_array_equal(read_points(tmp_path / "a.vtm"), np.vstack([POINTS, POINTS]))
    (tmp_path / "blocks" / "1.vtu").unlink()
    refused(tmp_path / "a.vtm", r"names the block 'blocks/1\.vtu', and there is no such file")


def test_lattices_of_vtk_run_along_x_first(tmp_path):
    (tmp_path / "a.vti").write_text(
        '<VTKFile type="ImageData"><ImageData WholeExtent="0 1 2 3 0 0" Origin="1 0 5" Spacing="0.5 2 1" '
        'Direction="0 -1 0 1 0 0 0 0 1"><Piece/></ImageData></VTKFile>'
    )
    expected = [[-3.0, 0.0, 5.0], [-3.0, 0.5, 5.0], [-5.0, 0.0, 5.0], [-5.0, 0.5, 5.0]]
    np.testing.assert_array_equal(read_points(tmp_path / "a.vti"), expected)
    (tmp_path / "a.vtk").write_text(
        "# vtk DataFile Version 3.0\n\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 2 2 1\n"
        "X_COORDINATES 2 float\n0 1\nY_COORDINATES 2 float\n0 0.1\nZ_COORDINATES 1 float\n7\n"
    )
    expected = [[0, 0, 7], [1, 0, 7], [0, 0.1, 7], [1, 0.1, 7]]
    np.testing.assert_array_equal(read_points(tmp_path / "a.vtk"), expected)


@pytest.mark.parametrize("form", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_rows_that_a_header_of_ply_does_not_count_are_not_dropped(tmp_path, form):
    def write(path):
        ply(path, form, faces=False)

    refused(changed(tmp_path / "a.ply", write, b"vertex 18", b"vertex 17"), "follow the rows that its header")
    refused(changed(tmp_path / "b.ply", write, b"vertex 18", b"vertex 19"), "cut off")
    refused(changed(tmp_path / "c.ply", write, b"vertex 18", b"vertex %d" % MANY), "4000000000 rows")


def test_every_cut_of_a_header_of_ply_ends_in_a_sentence(tmp_path):
    ply(tmp_path / "a.ply")
    data = (tmp_path / "a.ply").read_bytes()
    for length in range(0, data.index(b"end_header")):
        (tmp_path / "b.ply").write_bytes(data[:length])
        refused(tmp_path / "b.ply", "cut off inside its header|no PLY file|is empty")


def test_vertices_whose_lists_differ_in_length(tmp_path):
    rows = "".join(f"{row} {k % 3} {'7 ' * (k % 3)}\n" for k, row in enumerate(ROWS.splitlines()))
    header = "".join(f"property float {axis}\n" for axis in "xyz") + "property list uchar int near\n"
    (tmp_path / "a.ply").write_text(f"ply\nformat ascii 1.0\nelement vertex {N}\n{header}end_header\n{rows}")
    np.testing.assert_array_equal(read_points(tmp_path / "a.ply"), POINTS)


def test_a_binary_surface_with_another_number_of_triangles(tmp_path):
    path = changed(tmp_path / "a.stl", stl, struct.pack("<I", N), struct.pack("<I", N - 1))
    path.write_bytes(b"binary" + path.read_bytes()[6:])
    refused(path, "its 17 triangles take 934 bytes, and it has 984")


def test_blocks_of_nodes_that_are_fewer_than_promised(tmp_path):
    path = changed(tmp_path / "a.msh", gmsh, b"2 18 11 28", b"2 20 11 28")
    refused(path, "its blocks have 18 nodes, and 20 are promised")


def test_an_element_that_names_a_node_that_is_not_there(tmp_path):
    path = changed(tmp_path / "a.msh", gmsh, b"\n1 11 12 13\n", b"\n1 11 12 99\n")
    refused(path, "an element names node 99, which is not among the 18 nodes", read_mesh)


def test_a_laser_scan_with_other_records_than_promised(tmp_path):
    las(tmp_path / "a.las")
    data = bytearray((tmp_path / "a.las").read_bytes())
    for name, at, value, sentence in [
        ("fewer", 107, N - 1, "bytes follow the 17 points"),
        ("more", 107, MANY, "4000000000 points are promised"),
        ("records", 100, MANY, "4000000000 records before its points"),
    ]:
        path = tmp_path / f"{name}.las"
        path.write_bytes(data[:at] + struct.pack("<I", value) + data[at + 4 :])
        refused(path, sentence)


@pytest.mark.parametrize(
    ("simplices", "sentence"),
    [
        (TETRAHEDRA.astype(np.int64) + 2**32, "names point 4294967296, and there are points 0 to 17 only"),
        (TETRAHEDRA + 0.5, r"simplices should be whole numbers, found 0\.5 in row 0"),
        (TETRAHEDRA * np.nan, "simplices should be whole numbers, found nan in row 0"),
        (TETRAHEDRA[:, :3], r"expected simplices of shape \(m, 4\), tetrahedra; found \(\d+, 3\)"),
        (TETRAHEDRA - 1, "tetrahedron 0 names point -1"),
        (TETRAHEDRA.astype(np.uint64) + np.uint64(2**63), "simplices should be whole numbers"),
        (TETRAHEDRA.astype(complex), "found complex128"),
        (TETRAHEDRA[:0], "holds no tetrahedra"),
    ],
)
def test_indices_are_neither_wrapped_nor_cut_off(tmp_path, simplices, sentence):
    np.savez(tmp_path / "a.npz", points=POINTS, simplices=simplices)
    refused(tmp_path / "a.npz", sentence, read_mesh)


def test_indices_that_are_whole_floats_are_read(tmp_path):
    np.savez(tmp_path / "a.npz", points=POINTS, simplices=TETRAHEDRA.astype(float))
    mesh = read_mesh(tmp_path / "a.npz")
    np.testing.assert_array_equal(mesh.simplices, TETRAHEDRA)
    assert mesh.simplices.dtype == np.int32


def test_tetrahedra_beside_other_cells_that_fill_space(tmp_path):
    rows = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 1 1\n"
    start = f"# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 float\n{rows}"
    (tmp_path / "a.vtk").write_text(f"{start}CELLS 2 11\n4 0 1 2 3\n5 0 1 2 3 4\nCELL_TYPES 2\n10 14\n")
    refused(tmp_path / "a.vtk", "holds 1 pyramids beside 1 tetrahedra; expected tetrahedra only", read_mesh)
    (tmp_path / "b.vtk").write_text(f"{start}CELLS 2 9\n3 0 1 2\n4 0 1 2 3\nCELL_TYPES 2\n5 10\n")
    assert read_mesh(tmp_path / "b.vtk").simplices.tolist() == [[0, 1, 2, 3]]


@pytest.mark.parametrize("name", ["a.msh", "a.mesh", "a.vtk", "a.vtu", "a.npz"])
@pytest.mark.parametrize("content", [b"", bytes(300), b"garbage\n" * 20])
def test_the_commands_end_with_one_line_and_status_2(tmp_path, name, content, capfd):
    path = tmp_path / name
    path.write_bytes(content)
    for command in (["verify", str(path)], ["triangulate", str(path), "-o", str(tmp_path / "out.npz")]):
        assert cli.main(command) == 2
        out, error = capfd.readouterr()
        assert out == ""
        assert error.count("\n") == 1
        assert name in error


@pytest.mark.parametrize(
    ("command", "name", "content"),
    [("verify", "a.msh", bytes(300)), ("triangulate", "b.vtk", b"# vtk DataFile Version 3.0\n\nBINARY\n")],
)
def test_a_process_of_its_own_ends_likewise(tmp_path, command, name, content):
    (tmp_path / name).write_bytes(content)
    out = ["-o", str(tmp_path / "out.npz")] if command == "triangulate" else []
    words = [sys.executable, "-m", "dt3d", command, str(tmp_path / name), *out]
    done = subprocess.run(words, capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1
    assert name in done.stderr


@pytest.mark.parametrize("number", ["1_0", "1O", "0x10", "--1", "\u0663"])
def test_words_that_are_no_numbers(tmp_path, number):
    rows = f"0 0 0\n1 {number} 0\n"
    head = "".join(f"property float {axis}\n" for axis in "xyz")
    files = {
        "a.vtk": f"# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 2 float\n{rows}",
        "a.ply": f"ply\nformat ascii 1.0\nelement vertex 2\n{head}end_header\n{rows}",
        "a.vtp": '<VTKFile type="PolyData"><PolyData><Piece NumberOfPoints="2"><Points><DataArray '
        f'type="Float64" NumberOfComponents="3">{rows}</DataArray></Points></Piece></PolyData></VTKFile>',
        "a.mesh": f"MeshVersionFormatted 2\nDimension 3\nVertices 2\n0 0 0 0\n1 {number} 0 0\nEnd\n",
        "a.msh": f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n2 1 {number} 0\n$EndNodes\n",
        "a.stl": "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 0 1\n"
        f"vertex 1 {number} 0\nendloop\nendfacet\nendsolid\n",
        "a.pcd": "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\n"
        f"DATA ascii\n{rows}",
    }
    for name, text in files.items():
        (tmp_path / name).write_text(text.replace(number, "1"), encoding="utf-8")
        assert read_points(tmp_path / name).shape == (3 if name == "a.stl" else 2, 3)
        (tmp_path / name).write_text(text, encoding="utf-8")
        refused(tmp_path / name, "which is no number|expected 'vertex x y z'")


def test_negative_counts(tmp_path):
    (tmp_path / "a.pcd").write_text(
        "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH -1\nHEIGHT -1\nPOINTS 1\nDATA ascii\n1 2 3\n"
    )
    refused(tmp_path / "a.pcd", "WIDTH -1 times HEIGHT -1 is not POINTS 1")
    start = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n"
    (tmp_path / "a.msh").write_text(f"{start}1 -5 1 1\n3 1 0 -5\n$EndNodes\n")
    refused(tmp_path / "a.msh", r"numbers of nodes are \[1, -5\]")


def test_a_number_beyond_float64_is_not_infinity(tmp_path):
    start = "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 1 double\n"
    (tmp_path / "a.vtk").write_text(start + "0 -1e999 0\n")
    refused(tmp_path / "a.vtk", "points have -1e999, which is too great for float64")
    (tmp_path / "a.vtk").write_text(start + "0 -inf 0\n")  # written as such, it is kept for the triangulation
    assert read_points(tmp_path / "a.vtk").tolist() == [[0.0, -np.inf, 0.0]]
