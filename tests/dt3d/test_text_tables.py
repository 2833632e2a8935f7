"""Tables of text: what is a header, a comment, a delimiter, a number, and what each fault is called."""

import numpy as np
import pytest

from dt3d.files import read_points

POINTS = np.array([[0.1, 1 / 3, -2.5], [1e-7, 2.0, 3.0000000001], [-1.0, 0.0, 1e5 / 7], [4.25, 5.5, 6.75]])
CELLS = [[repr(float(v)) for v in row] for row in POINTS]


def table(rows=CELLS, delimiter=","):
    return "".join(delimiter.join(row) + "\n" for row in rows)


def with_cell(row, column, cell, delimiter=","):
    rows = [list(cells) for cells in CELLS]
    rows[row][column] = cell
    return table(rows, delimiter)


def write(path, text, encoding="utf-8"):
    path.write_bytes(text.encode(encoding))
    return path


def read(tmp_path, text, extension=".csv", dimension=None):
    return read_points(write(tmp_path / f"a{extension}", text), dimension=dimension)


def refused(tmp_path, text, complaint, extension=".csv"):
    with pytest.raises(ValueError, match=complaint) as error:
        read(tmp_path, text, extension)
    assert "\n" not in str(error.value)
    assert f"a{extension}" in str(error.value)


# a letter O; a unit; NaN as Windows writes it, with a comment's mark; notations of Python and C; wide digits;
# a minus that is a dash
FAULTS = ["", "NA", "-", "?", "O.5", "0.5m", "0.5 m", "1.#IND", "1_0", "0x1p3", "\uff11", "\u22121", "1.2.3"]
PLACES = [(row, column) for row in (0, 2, 3) for column in range(3)]


@pytest.mark.parametrize("cell", FAULTS)
@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_a_row_with_a_fault_is_an_error_wherever_it_stands(tmp_path, cell, delimiter):
    for row, column in PLACES:
        what = "a value is missing" if cell in ("", "NA", "-", "?") else ""
        text = with_cell(row, column, cell, delimiter)
        refused(tmp_path, text, f"line {row + 1}, column {column + 1}: {what}")


@pytest.mark.parametrize("cell", [cell for cell in FAULTS if cell and " " not in cell])
@pytest.mark.parametrize("extension", [".txt", ".asc"])
def test_a_row_with_a_fault_between_blanks(tmp_path, cell, extension):
    for row, column in PLACES:
        text = with_cell(row, column, cell, "  ")
        refused(tmp_path, text, f"line {row + 1}, column {column + 1}: ", extension)


FAULTY_ROWS = ["O.5,O.5,O.5", "0.5 m,0.5 m,0.5 m", ",,", "-,-,-", "NA,NA,NA", "1.2.3,4.5.6,7.8.9"]


@pytest.mark.parametrize("row", FAULTY_ROWS)
def test_a_first_row_of_faults_alone_is_no_header(tmp_path, row):
    refused(tmp_path, row + "\n" + table(), "line 1, column 1: ")


@pytest.mark.parametrize("change", [-1, 1, 2])
@pytest.mark.parametrize("row", [0, 1, 3])
@pytest.mark.parametrize("header", ["", "x,y,z\n"])
def test_a_row_of_another_length_is_an_error_that_names_its_line(tmp_path, change, row, header):
    rows = [list(cells) for cells in CELLS]
    rows[row] = (rows[row] + ["7.5", "8.5"])[: 3 + change]
    line = row + 1 + bool(header)
    if row == 0:
        line = 2  # the first row, or the header, says how many columns there are
    text = header + table(rows)
    complaint = rf"(line {line}: \d columns where \d are expected|the header names|found \d columns)"
    refused(tmp_path, text, complaint)


def test_lines_are_counted_in_the_file(tmp_path):
    text = "# made by hand\n\n  \nx,y,z\n// two rows\n" + table() + "\n% the end\n! really\n1.5,two,3.5\n"
    refused(tmp_path, text, "line 13, column 2: 'two' is not a number")
    for end in ("\r\n", "\r"):
        refused(tmp_path, text.replace("\n", end), "line 13, column 2: 'two' is not a number")
    assert read(tmp_path, text.replace("two", "2")).shape == (5, 3)


@pytest.mark.parametrize(
    "header",
    [
        "x,y,z\n",
        "X, Y, Z\n",
        "X [ m ],Y [ m ],Z (m)\n",
        "# x y z\n",
        "//X,Y,Z\n",
        "% made by a program\n%x y z\n",
        "# x, y, z\n# another comment of six words altogether\n",
        "length,width,height\n",
        "easting,northing,elevation\n",
        "E,N,Z\n",
        "east,north,up\n",
        "x,y,h\n",
        "sep=,\nx,y,z\n",
        "lon,lat,depth\n",
        "Points:0,Points:1,Points:2\n",
        '"Points_0","Points_1","Points_2"\n',
        "x,y,altitude\n",
        "Größe,Höhe,Länge\n",
        "x,y,z,\n",
        "x y z\n",
    ],
)
def test_headers(tmp_path, header):
    np.testing.assert_array_equal(read(tmp_path, header + table()), POINTS)
    assert read(tmp_path, header + table()[: -len(CELLS[-1][-1]) - 1] + "6.75").shape == (4, 3)


@pytest.mark.parametrize(
    ("header", "front", "back"),
    [
        ("id,x,y,z", ["7"], []),
        ("Name,X,Y,Z", ["a b"], []),
        (",x,y,z", ["0"], []),
        (",0,1,2", ["0"], []),
        ("x,y,z,q", [], ["0.5"]),
        ("x,y,z,2theta", [], ["0.5"]),
        ("time,x,y,z", ["2024-01-01 12:00:00"], []),
        ("T,Points:0,Points:1,Points:2,Points:Magnitude", ["1.5"], ["9"]),
        ("//X,Y,Z,R,G,B", [], ["1", "2", "3"]),
        ("id,easting,northing,elevation,code", ["7"], ["TREE"]),
        ("nx,ny,nz,x,y,z", ["0", "0", "1"], []),
        ("x,y,z,remark", [], [""]),
        ("x,y,h,temperature", [], ["300"]),
    ],
)
def test_named_columns_are_found_among_others(tmp_path, header, front, back):
    rows = [[*front, *cells, *back] for cells in CELLS]
    for delimiter in ",;\t":
        text = header.replace(",", delimiter) + "\n" + table(rows, delimiter)
        np.testing.assert_array_equal(read(tmp_path, text), POINTS)
    rows[2] = [*front, CELLS[2][0], "", CELLS[2][2], *back]
    refused(tmp_path, header + "\n" + table(rows), rf"line 4, column {len(front) + 2}: a value is missing")


@pytest.mark.parametrize(
    ("header", "complaint"),
    [
        ("x,y,z,x", r"the header calls columns 1 \(x\), 4 \(x\) the coordinate x"),
        ("x,y,z,X [mm]", r"the header calls columns 1 \(x\), 4 \(X \[mm\]\) the coordinate x"),
        ("a,b,c,d", "found columns a, b, c, d; expected three, or a header that names x, y and z"),
        ("x,y,z", "4 columns, but the header names 3: x, y, z"),
        ("x,y,z,i,j", "4 columns, but the header names 5: x, y, z, i, j"),
    ],
)
def test_headers_that_do_not_say_which_columns(tmp_path, header, complaint):
    refused(tmp_path, header + "\n" + table([[*cells, "5"] for cells in CELLS]), complaint)


def test_two_sets_of_coordinates(tmp_path):
    text = "x,y,z,Points:0,Points:1,Points:2\n" + table([cells * 2 for cells in CELLS])
    refused(tmp_path, text, "the header names x, y, z and Points:0, Points:1, Points:2; rename all but one")
    np.testing.assert_array_equal(read(tmp_path, text.replace("x,y,z", "u,v,w")), POINTS)


def test_names_of_rows_as_r_writes_them(tmp_path):
    text = '"x" "y" "z"\n' + "".join(f'"row {k}" {" ".join(cells)}\n' for k, cells in enumerate(CELLS))
    np.testing.assert_array_equal(read(tmp_path, text, ".txt"), POINTS)
    text = "x,y,z\n" + table([[f"p{k}", *cells] for k, cells in enumerate(CELLS)])
    np.testing.assert_array_equal(read(tmp_path, text), POINTS)
    # names that are too few for another reason
    for header in ("x;y", "y;z", "name;x;y"):
        rows = [[f"p{k}", *cells][4 - header.count(";") - 2 :] for k, cells in enumerate(CELLS)]
        text = header + "\n" + table(rows, ";").replace(".", ",")
        refused(tmp_path, text, f"but the header names {header.count(';') + 1}: ")


def test_the_columns_numbers_of_pandas_are_a_header_behind_an_index_and_a_question_elsewhere(tmp_path):
    index = ",0,1,2\n" + table([[str(k), *cells] for k, cells in enumerate(CELLS)])
    np.testing.assert_array_equal(read(tmp_path, index), POINTS)
    refused(tmp_path, "0,1,2\n" + table(), r"line 1: 0,1,2 may be a header \(pandas writes such\) or a point")
    # both ways out
    np.testing.assert_array_equal(read(tmp_path, table()), POINTS)
    assert read(tmp_path, "0.0,1.0,2.0\n" + table())[0].tolist() == [0, 1, 2]
    # where integers stand in other rows, it is a row like them
    assert len(read(tmp_path, "0,1,2\n3,4,5\n6,7,8\n")) == 3


@pytest.mark.parametrize("width", [4, 6, 7])
def test_more_columns_without_names_are_refused_and_the_message_says_how_to_name_them(tmp_path, width):
    text = table([cells + ["0.5", "1", "2", "3"][: width - 3] for cells in CELLS], " ")
    names = "# x y z " + " ".join(f"c{k}" for k in range(4, width + 1))
    complaint = f"found {width} columns; expected three, or a header .*, such as '{names}'"
    refused(tmp_path, text, complaint, ".txt")
    np.testing.assert_array_equal(read(tmp_path, names + "\n" + text, ".txt"), POINTS)
    for extension in (".xyz", ".asc", ".pts"):  # formats that start with x y z
        np.testing.assert_array_equal(read(tmp_path, text, extension), POINTS)


@pytest.mark.parametrize("extension", [".xyz", ".asc", ".pts"])
@pytest.mark.parametrize("start", [0, 1])
def test_an_index_is_not_taken_for_x(tmp_path, extension, start):
    text = table([[str(k + start), *cells] for k, cells in enumerate(CELLS)], " ")
    refused(tmp_path, text, "the first of 4 columns counts the rows; .* '# x y z c4'", extension)
    np.testing.assert_array_equal(read(tmp_path, "# id x y z\n" + text, extension), POINTS)


def test_two_columns_are_points_in_the_plane(tmp_path):
    rows = [cells[:2] for cells in CELLS]
    turned = "y,x\n" + table([cells[::-1] for cells in rows])
    for text in (table(rows), "x,y\n" + table(rows), "# x y\n" + table(rows, " "), turned):
        np.testing.assert_array_equal(read(tmp_path, text), POINTS[:, :2])
        with pytest.raises(ValueError, match=r"found \(4, 2\).*dimension=2"):
            read_points(tmp_path / "a.csv")
        np.testing.assert_array_equal(read(tmp_path, text, dimension=2), POINTS[:, :2])
    named = "id,x,y\n" + table([["7", *cells[:2]] for cells in CELLS])
    np.testing.assert_array_equal(read(tmp_path, named), POINTS[:, :2])


@pytest.mark.parametrize("mark", ["#", "//", "%", "!"])
def test_comments_stand_anywhere(tmp_path, mark):
    lines = table(delimiter=" ").splitlines()
    text = "\n".join([f"{mark} 1 2 3", lines[0], "", f"  {mark}4 5 6", *lines[1:], f"{mark} end", ""])
    np.testing.assert_array_equal(read(tmp_path, text, ".txt"), POINTS)


def test_a_remark_behind_numbers_needs_a_blank_before_it(tmp_path):
    text = table(delimiter=" ").replace("-2.5\n", "-2.5 # the first\n")
    np.testing.assert_array_equal(read(tmp_path, text, ".txt"), POINTS)
    refused(tmp_path, text.replace(" # the", "# the"), "line 1", ".txt")
    refused(tmp_path, with_cell(2, 0, "1.#QNAN", " "), "line 3, column 1: '1.#QNAN' is not a number", ".txt")


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-32"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_encodings_and_line_ends(tmp_path, encoding, end):
    text = "x,y,z\n" + table()
    path = write(tmp_path / "a.csv", text.replace("\n", end), encoding)
    np.testing.assert_array_equal(read_points(path), POINTS)


def test_utf_16_that_does_not_say_so_or_is_cut_off(tmp_path):
    path = write(tmp_path / "a.csv", table(), "utf-16-le")
    with pytest.raises(ValueError, match=r"a\.csv, line 1: a NUL character.*UTF-16"):
        read_points(path)
    path.write_bytes(table().encode("utf-16")[:-1])
    with pytest.raises(ValueError, match=r"a\.csv starts as UTF-16 but is not: truncated data"):
        read_points(path)


def test_latin_letters_in_names_and_comments_do_not_matter(tmp_path):
    path = write(tmp_path / "a.csv", "Länge,Höhe,Maß\n# größer\n" + table(), "latin-1")
    np.testing.assert_array_equal(read_points(path), POINTS)


@pytest.mark.parametrize("delimiter", [";", "\t", "  "])
def test_decimal_commas(tmp_path, delimiter):
    text = table(delimiter=delimiter).replace(".", ",")
    for header in ("", delimiter.join("xyz") + "\n"):
        np.testing.assert_array_equal(read(tmp_path, header + text, ".txt"), POINTS)
    # commas elsewhere do not matter
    named = "time;x;y;z\n" + table([["12,5", *cells] for cells in CELLS], ";")
    np.testing.assert_array_equal(read(tmp_path, named, ".txt"), POINTS)
    mixed = text.replace("5,5", "5.5")
    refused(tmp_path, mixed, "line 4, column 2: '5.5' has a decimal point, while other numbers", ".txt")


@pytest.mark.parametrize("delimiter", ["\t", " "])
def test_a_comma_that_may_separate_thousands_is_a_question(tmp_path, delimiter):
    text = table([["1,234", "2,500", "3"], ["4", "5", "6"]], delimiter)
    refused(tmp_path, text, "line 1, column 1: '1,234' may be 1.234 or 1234; write one of these", ".txt")
    # both ways out, and a cell elsewhere that tells
    assert read(tmp_path, text.replace(",", "."), ".txt")[0].tolist() == [1.234, 2.5, 3]
    assert read(tmp_path, text.replace(",", ""), ".txt")[0].tolist() == [1234, 2500, 3]
    for proof in ("0,234", "1234,567", "1,2", "1,2345"):
        points = read(tmp_path, f"{text}{proof}{delimiter}5{delimiter}6\n", ".txt")
        assert points[[0, 2]].tolist() == [[1.234, 2.5, 3], [float(proof.replace(",", ".")), 5, 6]]
    refused(tmp_path, text.replace("4", "1,234,567"), "has thousands' commas; write numbers without", ".txt")


@pytest.mark.parametrize("cell", ["1,234.5", "1.234,5", "1,234,567"])
@pytest.mark.parametrize("delimiter", [",", ";"])
def test_separators_of_thousands_are_never_read_as_something_else(tmp_path, cell, delimiter):
    refused(tmp_path, with_cell(1, 1, f'"{cell}"', delimiter), f"line 2, column 2: '{cell}'")
    refused(tmp_path, with_cell(0, 0, f'"{cell}"', delimiter), f"line 1, column 1: '{cell}'")


def test_quotes(tmp_path):
    rows = [[f'"{cell}"' for cell in cells] for cells in CELLS]
    np.testing.assert_array_equal(read(tmp_path, table(rows)), POINTS)
    np.testing.assert_array_equal(read(tmp_path, table(rows, " ; ")), POINTS)
    np.testing.assert_array_equal(read(tmp_path, table(rows, "  "), ".txt"), POINTS)
    refused(tmp_path, with_cell(2, 1, '"2.5'), "line 3: quotes that do not match")
    refused(tmp_path, with_cell(0, 1, '"2.5'), "line 1: quotes that do not match")
    refused(tmp_path, with_cell(2, 1, '"2"5'), "line 3: quotes that do not match")


def test_a_delimiter_behind_each_row_and_behind_some(tmp_path):
    trailing = table().replace("\n", ",\n")
    np.testing.assert_array_equal(read(tmp_path, trailing), POINTS)
    np.testing.assert_array_equal(read(tmp_path, "x,y,z\n" + trailing), POINTS)
    refused(tmp_path, trailing + "7,5,8,5\n", "line 5: a value behind the last column: '7,5,8,5'")
    refused(tmp_path, "x,y,z,\n" + trailing + "7,5,8,5\n", "line 6: a value behind the last column")
    refused(tmp_path, "1.5,2.5,\n" + table(), "line 1, column 3: a value is missing")
    refused(tmp_path, table() + "1.5,2.5,3.5,\n", "line 5: 4 columns where 3 are expected")


def test_fortran_exponents(tmp_path):
    text = "1.0D+00 2.5d-3 -1.D2\n.5E1 1e-5 3\n"
    assert read(tmp_path, text, ".txt").tolist() == [[1, 0.0025, -100], [5, 1e-5, 3]]
    refused(tmp_path, "1.0 2.0 3.0\n1.0 1.0-100 2.0\n", "line 2, column 2: '1.0-100' is not a number", ".txt")


def test_nan_and_infinity_that_are_written_are_returned(tmp_path):
    points = read(tmp_path, "1,nan,2\ninf,-Infinity,NaN\n3.5,4,5\n")
    np.testing.assert_array_equal(points, [[1, np.nan, 2], [np.inf, -np.inf, np.nan], [3.5, 4, 5]])


@pytest.mark.parametrize("delimiter", [",", " "])
def test_integers_that_double_precision_does_not_hold_are_errors(tmp_path, delimiter):
    rows = [[str(2**53), str(2**55), "0"], [str(10**22), "-7", str(2**63)], ["1", "2", "3"]]
    points = read(tmp_path, table(rows, delimiter), ".txt")
    assert points.tolist() == [[2**53, 2**55, 0], [1e22, -7, 2**63], [1, 2, 3]]
    rows[2][1] = str(-(2**53) - 1)
    text = table(rows, delimiter)
    refused(tmp_path, text, "line 3, column 2: '-9007199254740993' is an integer .* not hold exactly", ".txt")
    # as a decimal fraction it is rounded as all are
    assert read(tmp_path, text.replace("993", "993.0"), ".txt")[2, 1] == -(2**53)


@pytest.mark.parametrize("cell", ["1e309", "-1.0D+400", "9" * 400])
def test_numbers_beyond_the_range_of_double_precision_are_errors(tmp_path, cell):
    refused(tmp_path, with_cell(2, 0, cell), "line 3, column 1: .* is beyond the range of float64")


@pytest.mark.parametrize("text", ["4\n", "3 rbox 4 D3\n4\n", "3\n4\n"])
def test_a_count_before_the_rows(tmp_path, text):
    np.testing.assert_array_equal(read(tmp_path, text + table(delimiter=" "), ".txt"), POINTS)
    wrong = text[: text.rindex("4")] + "5\n"
    refused(tmp_path, wrong + table(delimiter=" "), r"line \d: '5' rows are promised, but 4 follow", ".txt")


def test_tabs_that_only_align(tmp_path):
    for delimiter in ("\t", " \t"):
        np.testing.assert_array_equal(read(tmp_path, "x y z\n" + table(delimiter=delimiter), ".txt"), POINTS)
    mixed = table(delimiter="\t").replace("\t", " ", 3)
    np.testing.assert_array_equal(read(tmp_path, mixed, ".txt"), POINTS)


def test_an_empty_cell_between_tabs_does_not_shift_the_row(tmp_path):
    text = "x\ty\tz\ti\n" + table([[*cells, "9"] for cells in CELLS], "\t") + "1.5\t\t3.5\t9\n"
    refused(tmp_path, text, "line 6, column 2: a value is missing", ".tsv")


def test_lines_of_text_before_the_rows(tmp_path):
    text = "Exported by a tool 4.2\n" + table(delimiter=" ")
    refused(tmp_path, text, "line 1, column 1: 'Exported' is not a number; .* must start with '#'", ".txt")
    np.testing.assert_array_equal(read(tmp_path, "# " + text, ".txt"), POINTS)


@pytest.mark.parametrize("text", ["# nothing\n\n", "\n\n  \n", "\ufeff"])
def test_files_without_rows(tmp_path, text):
    refused(tmp_path, text, "holds only comments|is empty")
