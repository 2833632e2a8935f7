"""Points from files: every format with its variants, and the errors a user can meet."""

import sys

import numpy as np
import pytest

from dt3d import samples
from dt3d.files import read_points

# numbers that lose digits in single precision
POINTS = np.array([[0.1, 1 / 3, -2.5], [1e-7, 2.0, 3.0000000001], [-1.0, 0.0, 1e5 / 7], [4.0, 5.0, 6.0]])
ROWS = [[repr(float(v)) for v in row] for row in POINTS]


def lines(separator, rows=ROWS):
    return "\n".join(separator.join(row) for row in rows) + "\n"


def write(path, text):
    path.write_text(text, encoding="utf-8")
    return path


def same(points):
    assert points.dtype == np.float64
    assert points.flags.c_contiguous
    np.testing.assert_array_equal(points, POINTS)


def test_npy_and_npz(tmp_path):
    np.save(tmp_path / "a.npy", POINTS)
    np.savez(tmp_path / "named.npz", other=np.zeros(3), points=POINTS)
    np.savez_compressed(tmp_path / "single.NPZ", cloud=POINTS)
    same(read_points(tmp_path / "a.npy"))
    same(read_points(str(tmp_path / "named.npz")))
    (tmp_path / "single.NPZ.npz").rename(tmp_path / "single.NPZ")
    same(read_points(tmp_path / "single.NPZ"))


def test_integers_and_single_precision_become_double(tmp_path):
    np.save(tmp_path / "a.npy", np.asfortranarray(np.arange(12, dtype=np.int16).reshape(4, 3)))
    points = read_points(tmp_path / "a.npy")
    assert points.dtype == np.float64
    assert points.flags.c_contiguous
    assert points.tolist() == np.arange(12.0).reshape(4, 3).tolist()


@pytest.mark.parametrize(
    ("array", "complaint"),
    [
        (np.zeros((5, 2)), r"expected an array of shape \(n, 3\), found \(5, 2\)"),
        (np.zeros(6), r"expected an array of shape \(n, 3\), found \(6,\)"),
        (np.zeros((5, 3), complex), "expected real numbers, found complex128"),
        (np.full((5, 3), "1"), "expected real numbers, found <U1"),
        (np.full((5, 3), None), "holds Python objects, which are not read"),
    ],
)
def test_arrays_that_are_not_points(tmp_path, array, complaint):
    np.save(tmp_path / "a.npy", array)
    with pytest.raises(ValueError, match=complaint):
        read_points(tmp_path / "a.npy")


def test_npz_with_several_arrays_lists_them(tmp_path):
    np.savez(tmp_path / "a.npz", left=POINTS, right=POINTS)
    with pytest.raises(ValueError, match="an array 'points', .* or a single array; found left, right"):
        read_points(tmp_path / "a.npz")


def test_text_that_calls_itself_npy(tmp_path):
    with pytest.raises(ValueError, match=r"a\.npy is not a NumPy array file"):
        read_points(write(tmp_path / "a.npy", "1 2 3\n"))


@pytest.mark.parametrize(
    "text",
    [
        lines(","),
        lines(", "),
        lines(";"),
        lines(" "),
        lines("\t"),
        lines(";").replace(".", ","),
        "x,y,z\n" + lines(","),
        "\ufeffX; Y; Z\n" + lines(";"),
        "# x y z\n" + lines(" "),
        "# made by hand\n# on a Sunday\n\n" + lines(" "),
        "length width height\n" + lines(" "),
        '"x","y","z"\n' + lines(","),
        "name,z,y,x\n" + lines(",", [['"a, b"', *row[::-1]] for row in ROWS]),
        "x y z quality\n" + lines(" ", [[*row, "0.5"] for row in ROWS]),
    ],
)
@pytest.mark.parametrize("extension", [".csv", ".txt"])
def test_columns(tmp_path, text, extension):
    same(read_points(write(tmp_path / f"a{extension}", text)))


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", r"a\.csv is empty"),
        ("x,y,z\n", "has a header but no rows of numbers"),
        ("1,2\n3,4\n", r"expected an array of shape \(n, 3\), found \(2, 2\)"),
        ("1\n3\n", "found 1 column; expected three, or a header that names x, y and z"),
        ("a,b,c,d\n1,2,3,4\n", "found columns a, b, c, d; expected three, or a header"),
        ("1,2,3\n4,five,6\n", r"a\.csv, line 2, column 2: 'five' is not a number"),
        ("1,2,3\n4,5\n", r"a\.csv, line 2: 2 columns where 3 are expected"),
    ],
)
def test_columns_that_are_not_points(tmp_path, text, complaint):
    with pytest.raises(ValueError, match=complaint):
        read_points(write(tmp_path / "a.csv", text))


@pytest.mark.parametrize(
    "text",
    [
        lines(" "),
        "# a comment\n" + lines("\t", [[*row, "255", "0", "0"] for row in ROWS]),
        "4\nfour atoms\n" + lines(" ", [["C", *row] for row in ROWS]),
        "4\n\n" + lines(" ", [["6", *row, "-0.1"] for row in ROWS]) + "\n\n",
        lines(" ", [["Fe", *row] for row in ROWS]),
    ],
)
def test_xyz(tmp_path, text):
    same(read_points(write(tmp_path / "a.xyz", text)))


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("5\n\nC 1 2 3\n", "the first line promises 5 atoms, but 1 lines follow"),
        ("1\n\nC 1 2 3\n1\n\nC 1 2 3\n", "a file of several frames must be split first"),
        ("", "holds no points"),
        ("1 2\n", "found 2 coordinates on a line, expected x y z"),
    ],
)
def test_xyz_that_is_broken(tmp_path, text, complaint):
    with pytest.raises(ValueError, match=complaint):
        read_points(write(tmp_path / "a.xyz", text))


def test_pdb(tmp_path):
    text = (
        "REMARK   1\n"
        "ATOM      1  N   MET A   1     -20.014 -20.694 -17.415  1.00 74.50           N\n"
        "HETATM    2 MG    MG A   2    -119.715-119.230-117.405  1.00 74.50          MG\n"
    )
    points = read_points(write(tmp_path / "a.pdb", text))
    assert points.tolist() == [[-20.014, -20.694, -17.415], [-119.715, -119.23, -117.405]]
    with pytest.raises(ValueError, match="holds no ATOM or HETATM records"):
        read_points(write(tmp_path / "b.pdb", "REMARK\n"))
    with pytest.raises(ValueError, match=r"coordinates \(columns 31 to 54\) are not numbers"):
        read_points(write(tmp_path / "c.pdb", text.replace("-20.694", "  hello")))


def test_obj_keeps_double_precision(tmp_path):
    vertices = "".join(f"v {' '.join(row)}\n" for row in ROWS)
    same(read_points(write(tmp_path / "a.obj", f"# cube\n{vertices}vn 0 0 1\nf 1 2 3\n")))
    with pytest.raises(ValueError, match="holds no vertices"):
        read_points(write(tmp_path / "b.obj", "f 1 2 3\n"))


def test_ply_keeps_double_precision(tmp_path):
    header = "".join(f"property double {axis}\n" for axis in "xyz")
    text = f"ply\nformat ascii 1.0\nelement vertex 4\n{header}end_header\n{lines(' ')}"
    same(read_points(write(tmp_path / "a.ply", text)))
    with pytest.raises(ValueError, match=r"b\.ply is no PLY file"):
        read_points(write(tmp_path / "b.ply", "not a ply file\n"))


def test_off(tmp_path):
    same(read_points(write(tmp_path / "a.off", f"OFF\n4 1 0\n{lines(' ')}3 0 1 2\n")))


@pytest.mark.parametrize("extension", [".vtk", ".vtp"])
def test_vtk_files_keep_double_precision(tmp_path, extension):
    import pyvista

    pyvista.PolyData(POINTS).save(tmp_path / f"a{extension}")
    same(read_points(tmp_path / f"a{extension}"))


def test_stl_gives_each_corner_once(tmp_path):
    import pyvista

    pyvista.Cube().triangulate().save(tmp_path / "a.stl")
    corners = [(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    assert sorted(map(tuple, read_points(tmp_path / "a.stl"))) == corners


def test_missing_file(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"there is no file .*nowhere\.npy"):
        read_points(tmp_path / "nowhere.npy")


def test_unknown_extension_lists_the_known(tmp_path):
    with pytest.raises(ValueError, match=r"unknown extension '\.blend'; known are .*\.csv, .*\.npy, .*\.xyz"):
        read_points(tmp_path / "a.blend")


@pytest.mark.parametrize(("package", "extension"), [("laspy", ".las"), ("gemmi", ".cif")])
def test_missing_package_says_how_to_install_it(tmp_path, monkeypatch, package, extension):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(ImportError, match=r"pip install 'dt3d\[formats\]'"):
        read_points(write(tmp_path / f"a{extension}", "anything"))


def test_the_shipped_set():
    points = samples.mtor()
    assert points.shape == (22194, 3)
    assert points.dtype == np.float64
    assert len(np.unique(points, axis=0)) == len(points)
    assert points[0].tolist() == [-20.014, -20.694, -17.415]
    assert points.min(axis=0).tolist() == [-41.827, -70.782, -110.691]
    assert points.max(axis=0).tolist() == [116.198, 37.265, 7.784]


def test_one_dimension_is_asked_for_or_what_the_file_has(tmp_path):
    np.save(tmp_path / "space.npy", POINTS)
    np.save(tmp_path / "plane.npy", POINTS[:, :2])
    assert read_points(tmp_path / "space.npy", dimension=None).shape == (4, 3)
    assert read_points(tmp_path / "plane.npy", dimension=None).shape == (4, 2)
    np.testing.assert_array_equal(read_points(tmp_path / "space.npy", dimension=2), POINTS[:, :2])
    np.testing.assert_array_equal(read_points(tmp_path / "plane.npy", dimension=2), POINTS[:, :2])
    with pytest.raises(ValueError, match=r"plane\.npy: expected .*\(n, 3\), found \(4, 2\).*dimension=2"):
        read_points(tmp_path / "plane.npy")
    with pytest.raises(ValueError, match="dimension must be 2, 3 or None, got 4"):
        read_points(tmp_path / "space.npy", dimension=4)


def test_an_array_that_lies_on_its_side_is_told_to_be_transposed(tmp_path):
    np.save(tmp_path / "a.npy", POINTS.T)
    with pytest.raises(ValueError, match=r"found \(3, 4\); transpose it \(array\.T\)"):
        read_points(tmp_path / "a.npy")
    np.save(tmp_path / "b.npy", np.load(tmp_path / "a.npy").T)  # as the message says
    same(read_points(tmp_path / "b.npy"))


def test_numbers_that_double_precision_does_not_hold_are_errors(tmp_path):
    np.save(tmp_path / "a.npy", np.array([[0, 0, 0], [1, 2**53 + 1, 2**55]]))
    with pytest.raises(ValueError, match="row 1, column 1 of .*a.npy is 9007199254740993.*exactly"):
        read_points(tmp_path / "a.npy")
    np.save(tmp_path / "b.npy", np.array([[2**55, 2**63, 1]], np.uint64))
    assert read_points(tmp_path / "b.npy").tolist() == [[2.0**55, 2.0**63, 1.0]]
    np.save(tmp_path / "c.npy", np.array([[2**64 - 1, 0, 1]], np.uint64))
    with pytest.raises(ValueError, match="row 0, column 0 of .*c.npy is 18446744073709551615.*exactly"):
        read_points(tmp_path / "c.npy")
