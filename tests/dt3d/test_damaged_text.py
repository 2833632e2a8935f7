"""Damaged files of text: each is one sentence, or all its rows are there.

What a reader may make of a damaged file is told by what the damage left: every line that is a row of the
whole file still gives its point, in order, and there are as many points as lines that are rows.
"""

import re

import numpy as np
import pytest

from dt3d.files import read_points

N = 12
POINTS = np.random.default_rng(7).uniform(-99, 99, (N, 3)).round(3)
CELLS = [[f"{v:.3f}" for v in row] for row in POINTS.tolist()]


def rows(delimiter=" ", front="", back="", cells=CELLS):
    """The lines of a table; ``front`` may hold the index of its row."""
    return [front.format(k) + delimiter.join(row) + back for k, row in enumerate(cells)]


ATOMS = [f"ATOM  {k:5}  CA  ALA A   1    {x:>8}{y:>8}{z:>8}  1.00  0.00" for k, (x, y, z) in enumerate(CELLS)]
LAMMPS = ["ITEM: TIMESTEP", "0", "ITEM: NUMBER OF ATOMS", str(N), "ITEM: BOX BOUNDS pp pp pp"]
LAMMPS += ["0 9", "0 9", "0 9", "ITEM: ATOMS id x y z"]
CIF = ["data_a", "loop_", "_atom_site.label", *(f"_atom_site.Cartn_{axis}" for axis in "xyz")]

# the extension, and the lines before, with, and behind the points
FORMATS = {
    "table": (".csv", [], rows(","), []),
    "header": (".csv", ["id,x,y,z,name"], rows(",", "{},", ",a point"), []),
    "quoted": (".csv", ['"name","x","y","z"'], rows(",", '"a {}",'), []),
    "commas": (".csv", ["x;y;z"], [row.replace(".", ",") for row in rows(";")], []),
    "tabs": (".tsv", [], rows("\t"), []),
    "blanks": (".txt", [], rows(), []),
    "comment": (".txt", ["# x y z i"], rows(back=" 0.5"), []),
    "count": (".txt", [str(N)], rows(), []),
    "asc": (".asc", ["//X Y Z R G B"], rows(back=" 1 2 3"), []),
    "xyz": (".xyz", [], rows(back=" 255 0 0"), []),
    "atoms": (".xyz", [str(N), "a comment"], rows(front="C "), []),
    "extended": (".xyz", [str(N), "Properties=id:I:1:pos:R:3"], rows(front="{} "), []),
    "scan": (".pts", [str(N)], rows(back=" -1200 1 2 3"), []),
    "landmarks": (".pts", ["version: 1", f"n_points: {N}", "{"], rows(), ["}"]),
    "pdb": (".pdb", ["HEADER", "REMARK 1"], ATOMS, ["TER", "END"]),
    "cif": (".cif", CIF, rows(front="C{} "), []),
    "lammps": (".dump", LAMMPS, rows(front="{} "), []),
    "obj": (".obj", ["# a", "o thing"], rows(front="v "), ["vn 0 0 1", "f 1 2 3"]),
    "off": (".off", ["OFF", f"{N} 2 0"], rows(), ["3 0 1 2", "3 1 2 3"]),
    "node": (".node", [f"{N} 3 0 0"], rows(front="{} "), []),
}


def whole(kind):
    _, before, lines, behind = FORMATS[kind]
    return "".join(f"{line}\n" for line in [*before, *lines, *behind]).encode()


def damaged(data, generator):
    """The bytes of a file with one of the things that happen to files."""
    data = bytearray(data)
    place, length = int(generator.integers(len(data))), int(generator.integers(1, 40))
    match generator.integers(7):
        case 0:
            del data[place:]
        case 1:
            for k in generator.integers(len(data), size=generator.integers(1, 10)):
                data[k] = generator.integers(256)
        case 2:  # one character becomes another of the file
            data[place] = data[generator.integers(len(data))]
        case 3:
            del data[place : place + length]
        case 4:
            data[place:place] = data[:length]
        case 5:
            data[place : place + length] = bytes(length)
        case 6:
            data[place:place] = generator.bytes(length)
    return bytes(data)


MARKS: dict[str, tuple[str, ...]] = dict.fromkeys(FORMATS, ("#", "//", "%", "!"))
MARKS |= dict.fromkeys(["obj", "off", "node"], ("#",)) | dict.fromkeys(["pdb", "cif", "lammps"], ())
MARKS |= dict.fromkeys(["atoms", "extended"], ())


def row_lines(kind, text):
    """How many lines must be rows, since they have three numbers, and may be, since they are not blank.

    Neither are comments and lines that stand around the rows of the whole file.
    """
    _, before, _, behind = FORMATS[kind]
    lines = [line for line in re.split("\r\n|\r|\n", text) if line not in before + behind]
    lines = [line for line in lines if line.strip() and not line.strip().startswith(MARKS[kind])]
    return sum(len(re.findall(r"\d[.,]\d", line)) >= 3 for line in lines), len(lines)


def read(path):
    """The points, or the error that a user would see."""
    try:
        return read_points(path, dimension=None)
    except (ValueError, OSError) as error:
        return error


def check(path, kind, data):
    path.write_bytes(data)
    found = read(path)
    if isinstance(found, Exception):
        assert "\n" not in str(found)
        assert str(path) in str(found)
        return
    assert found.dtype == np.float64
    _, _, lines, _ = FORMATS[kind]
    text = data.decode("utf-8-sig", errors="replace")
    there = [lines.index(line) for line in re.split("\r\n|\r|\n", text) if line in lines]
    # the points of the lines that are as they were, in their order
    at = 0
    for k in there:
        matches = np.flatnonzero((found[at:] == POINTS[k, : found.shape[1]]).all(axis=1))
        assert len(matches), f"row {k} is lost"
        at += matches[0] + 1
    least, most = row_lines(kind, text)
    assert least <= len(found) <= most, text


@pytest.mark.parametrize("kind", FORMATS)
def test_the_whole_files_are_read(tmp_path, kind):
    path = tmp_path / f"a{FORMATS[kind][0]}"
    path.write_bytes(whole(kind))
    np.testing.assert_array_equal(read_points(path), POINTS)


MANY = pytest.param(range(40, 1000), marks=pytest.mark.slow, id="many")


@pytest.mark.parametrize("kind", FORMATS)
@pytest.mark.parametrize("seeds", [pytest.param(range(40), id="40"), MANY])
def test_damage_is_a_sentence_or_leaves_every_row(tmp_path, kind, seeds):
    path = tmp_path / f"a{FORMATS[kind][0]}"
    for seed in seeds:
        check(path, kind, damaged(whole(kind), np.random.default_rng([seed, len(kind)])))


@pytest.mark.parametrize("kind", FORMATS)
def test_a_file_that_is_cut_off_anywhere(tmp_path, kind):
    path = tmp_path / f"a{FORMATS[kind][0]}"
    data = whole(kind)
    for length in range(0, len(data), 7):
        check(path, kind, data[:length])


GARBAGE = {
    "nothing": b"",
    "blanks": b" \n\t\r\n \n",
    "zeros": bytes(1000),
    "noise": np.random.default_rng(3).bytes(5000),
    "noise without NUL": np.random.default_rng(4).bytes(5000).replace(b"\0", b"1"),
    "letters": b"The quick brown fox\njumps over the lazy dog\n",
    "a picture": b"\x89PNG\r\n\x1a\n" + bytes(50),
    "a long line of digits": b"1" * 100_000,
    "a long line of blanks": b"1" + b" " * 100_000 + b"2",
    "a long line of commas": b"," * 100_000,
    "a long line of quotes": b'"' * 100_001,
    "a long line of brackets": b"x " + b"[" * 100_000 + b"\n1 2 3\n",
    "a long line of atoms": b"ATOM " * 20_000,
    "a promise": b"999999999999\n\n1 2 3\n",
    "a promise of OFF": b"OFF\n999999999 999999999 0\n1 2 3\n",
    "a promise of points": b"999999999 3 0 0\n1 2 3\n",
    "a number of many digits": b"9" * 30 + b"\n\n1 2 3\n",
    "one number": b"1\n",
    "braces": b"version: 1\nn_points: 1\n{\n}\n",
    "items": b"ITEM: NUMBER OF ATOMS\nITEM: ATOMS x y z\n",
}


@pytest.mark.parametrize("extension", sorted({extension for extension, *_ in FORMATS.values()}))
def test_garbage_is_a_sentence(tmp_path, extension):
    path = tmp_path / f"a{extension}"
    for name, data in GARBAGE.items():
        path.write_bytes(data)
        with pytest.raises((ValueError, OSError)) as error:
            read_points(path)
        assert "\n" not in str(error.value), name
        assert len(str(error.value)) < 700, name
        assert str(path) in str(error.value), name
