"""Formats of text with rules of their own: XYZ, PTS, PDB, CIF, LAMMPS, OBJ, OFF, .node."""

import sys

import numpy as np
import pytest

from dt3d.files import read_points

POINTS = np.array([[0.125, -1.5, 2.75], [10.001, 0.333, -7.25], [-119.715, 148.529, 1.0], [4.0, 5.5, 6.75]])
ROWS = [" ".join(map(str, row)) for row in POINTS.tolist()]
CARBON = [f"C {row}" for row in ROWS]


def read(tmp_path, text, extension):
    path = tmp_path / f"a{extension}"
    path.write_text(text, encoding="utf-8")
    return read_points(path, dimension=None)


def same(tmp_path, text, extension):
    np.testing.assert_array_equal(read(tmp_path, text, extension), POINTS)


def refused(tmp_path, text, extension, complaint):
    with pytest.raises(ValueError, match=complaint) as error:
        read(tmp_path, text, extension)
    assert "\n" not in str(error.value)


def lines(rows):
    return "".join(f"{row}\n" for row in rows)


# XYZ


@pytest.mark.parametrize(
    "text",
    [
        "4\n" + lines(ROWS),
        "# points\n\n4\n" + lines(ROWS) + "\n",
        "4\n\n" + lines(ROWS),
        "4\na comment\n" + lines(f"C{k} {row}" for k, row in enumerate(ROWS)),
        "4\n" + lines(f"He {row}" for row in ROWS),
        "4\n1 2 3\n" + lines(f"He {row}" for row in ROWS),
        "4\n\n" + lines(f"{k + 5} {row} 0.5" for k, row in enumerate(ROWS)),
        "4\ncolours\n" + lines(f"{row} 0.1 0.2 0.3" for row in ROWS),
        lines(row.replace(" ", ",") for row in ROWS),
        "X Y Z R G B\n" + lines(f"{row} 1 2 3" for row in ROWS),
        "r,g,b,x,y,z\n" + lines(f"1,2,3,{row}".replace(" ", ",") for row in ROWS),
        '4\nLattice="1 0 0 0 1 0 0 0 1" Properties=species:S:1:pos:R:3:forces:R:3\n'
        + lines(f"Si {row} 0 0 1" for row in ROWS),
        '4\nProperties="id:I:1:forces:R:3:species:S:1:pos:R:3" pbc="T T T"\n'
        + lines(f"{k} 7 8 9 Si {row}" for k, row in enumerate(ROWS)),
    ],
)
def test_xyz(tmp_path, text):
    same(tmp_path, text, ".xyz")


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("5\n" + lines(ROWS), "promises 5 atoms, but 3 lines follow the comment"),
        ("3\n" + lines(ROWS), "line 2: .* looks like one row more than promised"),
        ("3\n" + lines(CARBON), "line 2: .* looks like one row more than promised"),
        ("4\nComment\n" + lines(ROWS[:3]), "promises 4 atoms, but 3 lines follow the comment"),
        ("0\n\n", "holds no points; its first line promises 0"),
        ("4\n", "holds no points"),
        ("99999999999\n\n" + lines(ROWS), "promises 99999999999 atoms, but 4"),
        (2 * ("4\n\n" + lines(ROWS)), "several frames must be split first"),
        (lines(["O.5 1 2 3", *ROWS]), "line 1, column 1: 'O.5' is not an element or a label"),
        (lines([CARBON[0], *ROWS[1:]]), "line 2, column 1: .* is not an element or a label"),
        (lines([*ROWS[:3], CARBON[3]]), "line 4: 4 columns where 3 are expected"),
        (lines([*ROWS[:3], "1 2"]), "line 4: 2 columns where 3 are expected"),
        ("4\n\n" + lines([*CARBON[:3], "C 1 2"]), "line 6: 3 columns where 4 are expected"),
        ("4\n\n" + lines([*CARBON[:3], "C 1 NA 2"]), "line 6, column 3: a value is missing"),
        ("4\nProperties=species:S:1:forces:R:3\n" + lines(CARBON), "should have pos:R:3"),
        ("4\nProperties=species:S:1:pos:R:3:q:R:1\n" + lines(CARBON), "line 3: 4 columns where 5"),
        ("4\nProperties=species:S:x:pos:R:3\n" + lines(CARBON), "should have pos:R:3"),
    ],
)
def test_xyz_that_is_refused(tmp_path, text, complaint):
    refused(tmp_path, text, ".xyz", complaint)


# PTS


def test_scans_and_landmarks(tmp_path):
    coloured = lines(f"{row} -1200 1 2 3" for row in ROWS)
    same(tmp_path, "4\n" + coloured, ".pts")
    same(tmp_path, coloured, ".pts")
    same(tmp_path, "1\n" + lines(ROWS[:1]) + "0\n3\n" + lines(ROWS[1:]), ".pts")
    refused(tmp_path, "5\n" + coloured, ".pts", "line 1: 5 points are promised, but 4 follow")
    refused(tmp_path, "3\n" + coloured, ".pts", "line 5: .*: more points than promised")
    refused(tmp_path, "4\n" + coloured.replace(" 3\n", "\n", 1), ".pts", "line 3: 7 columns where 6")
    refused(tmp_path, "0\n", ".pts", "holds no points")
    plane = "version: 1\nn_points:  4\n{\n" + lines(row.rsplit(" ", 1)[0] for row in ROWS) + "}\n"
    np.testing.assert_array_equal(read(tmp_path, plane, ".pts"), POINTS[:, :2])
    more = plane.replace("4\n", "5\n", 1)
    refused(tmp_path, more, ".pts", "line 2: 5 points are promised, but 4 are in braces")
    refused(tmp_path, plane.replace("}", ""), ".pts", "points in braces")


# PDB


def atom(serial, row, record="ATOM  "):
    x, y, z = row
    return f"{record}{serial:>5}  CA  ALA A   1    {x:8.3f}{y:8.3f}{z:8.3f}  1.00  0.00           C"


def pdb(serials=("1", "2", "3", "4"), record="ATOM  "):
    return [atom(serial, row, record) for serial, row in zip(serials, POINTS, strict=True)]


@pytest.mark.parametrize(
    "rows",
    [
        pdb(),
        pdb(record="HETATM"),
        pdb(("99998", "99999", "100000", "100001"), "ATOM "),
        pdb(("99998", "99999", "100000", "100001")),  # one column further right
        pdb(("9999998", "9999999", "10000000", "10000001")),
        pdb(("99998", "99999", "A0000", "A0001")),
        pdb(("99998", "99999", "186a0", "*****")),
        pdb(("99998", "99999", "100000", "100001"), "HETATM"),
        [row.lower() for row in pdb()],
        ["HEADER", "REMARK 1", "CRYST1", "MODEL        1", *pdb(), "TER", "ENDMDL", "CONECT    1", "END"],
        ["REMARK " + pdb()[0][:70], *pdb(), "#BEGIN_POSE", "label fa_atr", "MET:1 -2.5 1.25 3.125 2.500"],
        [row.replace("ALA", "A") for row in pdb()],  # two columns further left
        [row[:54] for row in pdb()],
    ],
)
def test_pdb(tmp_path, rows):
    same(tmp_path, lines(rows), ".pdb")


@pytest.mark.parametrize("k", [0, 2, 3])
@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        (lambda row: row[:50], r"an atom's coordinates \(columns 31 to 54\) are not numbers"),
        (lambda row: row[:20], r"an atom's coordinates"),
        (lambda row: row.replace("  ", "\t"), r"an atom's coordinates"),
        (lambda row: row[:30] + "        " + row[38:], "an atom's coordinates"),
        (lambda row: row[:33] + "x" + row[34:], "an atom's coordinates"),
        (lambda row: "BTOM  " + row[6:], "'BTOM' is not a record of a PDB file; it may be a damaged atom"),
        (lambda row: " " + row, "an atom that does not start where the line starts"),
        (lambda row: "REMARK 1 " + row, "an atom that does not start where the line starts"),
        (lambda row: row + " " + row, "a second atom on the line"),
        (lambda row: "REMA" + row[24:], "'REMA 1' is not a record"),
        (lambda row: row + 2000 * " ", "characters, while a record has 80"),
    ],
)
def test_an_atom_that_is_not_understood_is_an_error_that_names_its_line(tmp_path, k, change, complaint):
    rows = pdb()
    rows[k] = change(rows[k])
    refused(tmp_path, lines(["REMARK", *rows, "END"]), ".pdb", f"line {k + 2}.*: .*{complaint}")


def test_great_numbers_in_shifted_columns_are_not_read_from_the_wrong_ones(tmp_path):
    rows = [atom("100000", row) for row in [[1000.25, 2000.5, 3000.75], [-999.125, 1111.25, -222.5]]]
    points = read(tmp_path, lines(rows), ".pdb")
    assert points.tolist() == [[1000.25, 2000.5, 3000.75], [-999.125, 1111.25, -222.5]]


# CIF

CELL = """
_cell.length_a 10
_cell.length_b 20(1)
_cell.length_c 8
_cell.angle_alpha 90
_cell.angle_beta 90
_cell.angle_gamma 120
"""
SITES = "loop_\n_atom_site.label\n_atom_site.Cartn_x\n_atom_site.Cartn_y\n_atom_site.Cartn_z\n"


def test_cif(tmp_path):
    atoms = lines(f"'C {k}' {row}" for k, row in enumerate(ROWS))
    same(tmp_path, "data_a\n" + SITES + atoms, ".cif")
    same(tmp_path, "data_cell\n_x 1\ndata_a\n" + SITES + atoms, ".mmcif")
    fractions = SITES.replace("Cartn", "fract") + "C1 0.5 0.25(3) -1\nC2 0 0.5 0.125\n"
    right = [[0.5 * 10 - 0.25 * 10, 0.25 * 20 * np.sqrt(0.75), -8], [-5, 10 * np.sqrt(0.75), 1]]
    for text in (CELL + fractions, (CELL + fractions).replace("_cell.", "_cell_").replace("site.", "site_")):
        np.testing.assert_allclose(read(tmp_path, "data_a\n" + text, ".cif"), right, rtol=1e-14)
    text = "data_a\n" + SITES + atoms
    refused(tmp_path, "data_a\n" + fractions, ".cif", "fractions of the unit cell, but its _cell_len")
    refused(tmp_path, text.replace("4.0", "?"), ".cif", r"_x of atom 4: a value is missing \('\?'\)")
    refused(tmp_path, text.replace("4.0", "9007199254740993"), ".cif", "_x of atom 4: .*not hold exactly")
    refused(tmp_path, text + "C 1 2\n", ".cif", "is not a CIF file")
    refused(tmp_path, text + text.replace("data_a", "data_b"), ".cif", "holds 2 structures")
    refused(tmp_path, "data_a\n_x 1\n", ".cif", "holds no structures with atoms")
    refused(tmp_path, "1 2 3\n", ".cif", "is not a CIF file")


def test_cif_without_gemmi_says_how_to_install_it(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "gemmi", None)
    (tmp_path / "a.cif").write_text("data_a\n")
    with pytest.raises(ImportError, match=r"pip install 'dt3d\[formats\]'"):
        read_points(tmp_path / "a.cif")


# LAMMPS

BOX = "ITEM: BOX BOUNDS pp pp pp\n0 9\n0 9\n0 9\n"
DUMP = f"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n4\n{BOX}ITEM: ATOMS id {{}} q\n"


def test_lammps(tmp_path):
    atoms = lines(f"{k} {row} 0.5" for k, row in enumerate(ROWS))
    for extension in (".dump", ".lammpstrj"):
        same(tmp_path, DUMP.format("x y z") + atoms, extension)
    same(tmp_path, DUMP.format("xu yu zu") + atoms, ".dump")
    np.testing.assert_array_equal(read(tmp_path, DUMP.format("y x z") + atoms, ".dump"), POINTS[:, [1, 0, 2]])
    text = DUMP.format("x y z") + atoms
    refused(tmp_path, text.replace("x y z", "xs ys zs"), ".dump", "line 9: found columns id, xs, ys, zs, q; ")
    refused(tmp_path, text * 2, ".dump", "should have one time step; found 2")
    refused(tmp_path, text + "5 1 2 3 4\n", ".dump", "line 3: '4' atoms are promised, but 5 follow")
    refused(tmp_path, text.replace("0.333", "o.333"), ".dump", "line 11, column 3: 'o.333' is not a number")
    refused(tmp_path, "1 2 3\n", ".dump", "is not a LAMMPS dump")


# OBJ


def test_obj(tmp_path):
    vertices = [f"v {row}" for row in ROWS]
    same(tmp_path, lines(vertices), ".obj")
    same(tmp_path, lines(f"  v\t{row} 1.0" for row in ROWS), ".obj")
    same(tmp_path, lines(f"v {row} 0.1 0.2 0.3" for row in ROWS), ".obj")
    same(tmp_path, lines([vertices[0] + " 1", vertices[1], vertices[2] + " 1 0 0", vertices[3]]), ".obj")
    same(tmp_path, lines(vertices).replace("-1.5", "\\\n -1.5"), ".obj")
    front, back = "# v 1 2 3\nmtllib a.mtl\no cube\nvn 0 0 1\nvt 0 0\n", "f 1/1/1 2//1 3\n"
    same(tmp_path, front + lines(vertices) + back, ".obj")
    for k, damaged, complaint in [
        (0, "u 1 2 3", "line 1, column 1: 'u' is not a statement of an OBJ file"),
        (2, "v1 2 3", "line 3, column 1: 'v1' is not a statement"),
        (1, "v 1 2", "line 2: 2 numbers in a vertex where 3, 4, 6 or 7 are expected"),
        (3, "v 1 2 3 v 4 5 6", "line 4: a second statement on the line"),
        (3, "f 1 2 3 v 4 5 6", "line 4: a second statement on the line"),
        (3, "o thing v 1 2 3", "line 4: a vertex within a name"),
        (3, "o thing -1.5 2.5 3.5", "line 4: a vertex within a name"),
        (3, "v 1 2 -", "line 4, column 4: a value is missing"),
    ]:
        refused(tmp_path, lines([*vertices[:k], damaged, *vertices[k + 1 :]]), ".obj", complaint)


# OFF


HEADS = ["OFF\n4 2 0\n", "OFF 4 2 0\n", "OFF4 2 0\n", "4 2 0\n", "# a\nOFF # b\n\n# c\n4 2\n"]


@pytest.mark.parametrize("head", HEADS)
@pytest.mark.parametrize("extra", ["", " 255 0 0 255"])
def test_off(tmp_path, head, extra):
    text = head + lines(row + extra for row in ROWS) + "3 0 1 2\n4 0 1 2 3 0.5 0.5 0.5\n"
    same(tmp_path, text, ".off")
    same(tmp_path, text.replace("OFF", "CNOFF"), ".off")


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        ("4 1 0", "5 1 0", "promises 5 vertices and 1 faces, but 5 lines follow"),
        ("4 1 0", "3 1 0", "promises 3 vertices and 1 faces, but 5 lines follow"),
        ("4 1 0", "3 2 0", "line 6: .* is not a face"),
        ("4 1 0", "5 0 0", "line 7: 4 columns where 3 are expected"),
        ("4 1 0", "0 5 0", "holds no vertices"),
        ("4 1 0", "four", "line 2: 'four' where the numbers of vertices and faces are expected"),
        ("4 1 0", "1000000000 1 0", "promises 1000000000 vertices"),
        ("3 0 1 2", "3 0 1 4", "line 7: a face has a vertex that is not there; they are numbered 0 to 3"),
        ("3 0 1 2", "3 0 1", "line 7: '3 0 1' is not a face"),
        ("OFF", "4OFF", "line 1: 4OFF has other than three dimensions"),
        ("OFF", "nOFF", "line 1: nOFF has other than three dimensions"),
        ("OFF", "OFF BINARY", "line 1: a binary OFF file; write it as text"),
        ("0.333", "0,333", "line 4, column 2: '0,333' has a comma within"),
        (" -7.25", "", "line 4: 2 columns where 3 are expected"),
    ],
)
def test_off_that_is_refused(tmp_path, old, new, complaint):
    text = "OFF\n4 1 0\n" + lines(ROWS) + "3 0 1 2\n"
    refused(tmp_path, text.replace(old, new, 1), ".off", complaint)


# .node


@pytest.mark.parametrize("start", [0, 1])
def test_node(tmp_path, start):
    rows = [f"{k + start} {row}" for k, row in enumerate(ROWS)]
    same(tmp_path, "# TetGen\n4 3 0 0\n" + lines(rows) + "# end\n", ".node")
    same(tmp_path, "4\n" + lines(rows), ".node")
    same(tmp_path, "4  3  2  1\n" + lines(row + " 0.5 0.25 1" for row in rows), ".node")
    plane = [f"{k + start} {row.rsplit(' ', 1)[0]} 7" for k, row in enumerate(ROWS)]
    np.testing.assert_array_equal(read(tmp_path, "4 2 0 1\n" + lines(plane), ".node"), POINTS[:, :2])
    refused(tmp_path, "5 3 0 0\n" + lines(rows), ".node", "promises 5 points, but 4 lines follow")
    refused(tmp_path, "4 3 1 0\n" + lines(rows), ".node", "line 2: 4 columns where 5 are expected")
    refused(tmp_path, "4 4 0 0\n" + lines(rows), ".node", "line 1: dimension 4, expected 2 or 3")
    refused(tmp_path, "4 3 0 0\n" + lines(rows[::-1]), ".node", "index .*; points are numbered in order")
    refused(tmp_path, "4 3 0 0\n" + lines([*rows[:3], rows[0]]), ".node", "line 5, column 1: index")
    refused(tmp_path, lines(rows), ".node", "line 1: .* should be the numbers of points, dimensions")
