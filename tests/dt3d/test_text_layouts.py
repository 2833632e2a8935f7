"""Tables of the same points in every layout: each is read as the points, or asks the one question it must."""

import numpy as np
import pytest

from dt3d.files import read_points

DELIMITERS = [",", ", ", ";", " ; ", "\t", " ", "  "]
HEADERS = ["none", "axes", "index", "extra", "other names", "pandas", "labels", "comment", "comment, extra"]
QUESTION = "may be .* or .*; write one of these"


def column_names(header):
    return {
        "none": None,
        "axes": ["x", "y", "z"],
        "index": ["id", "X", "Y", "Z"],
        "extra": ["x", "y", "z", "w"],
        "other names": ["length", "width", "height"],
        "pandas": ["", "x", "y", "z"],
        "labels": ["name", "x", "y", "z"],
        "comment": ["# x", "y", "z"],
        "comment, extra": ["# x", "y", "z", "w"],
    }[header]


def layout(generator, points, delimiter, header):
    """The text of a table, whose details are drawn: notation, decimal commas, quotes, line ends, remarks."""
    write = [str, repr, "{:.17g}".format, "{:.17e}".format][generator.integers(4)]
    rows = [[write(value) for value in row] for row in points.tolist()]
    if delimiter.strip() in (";", "") and generator.random() < 0.4:
        rows = [[cell.replace(".", ",") for cell in row] for row in rows]
    front = {"index": "{}", "pandas": "{}", "labels": "p{}"}.get(header)
    if front:
        rows = [[front.format(k), *row] for k, row in enumerate(rows)]
    if header.endswith("extra"):
        rows = [[*row, "NA"] for row in rows]
    if generator.random() < 0.2:
        rows = [[f'"{cell}"' for cell in row] for row in rows]
    names = column_names(header)
    lines = [delimiter.join(row) for row in ([names] if names else []) + rows]
    if delimiter.strip() and generator.random() < 0.2:
        lines = [line + delimiter.strip() for line in lines]
    if not names and generator.random() < 0.2:
        lines.insert(0, str(len(points)))
    if generator.random() < 0.3:
        lines.insert(generator.integers(len(lines) + 1), generator.choice(["", "# a remark", "// so", "  "]))
    return generator.choice(["\n", "\r\n", "\r"]).join(lines) + "\n"


@pytest.mark.parametrize("header", HEADERS)
@pytest.mark.parametrize("delimiter", DELIMITERS)
def test_every_layout_gives_the_points(tmp_path, delimiter, header):
    if header == "pandas" and delimiter.isspace() and delimiter != "\t":
        return  # between blanks, a name that is empty is not there
    path = tmp_path / "a.txt"
    generator = np.random.default_rng([DELIMITERS.index(delimiter), HEADERS.index(header)])
    for _ in range(12):
        n = generator.integers(1, 7)
        points = [
            generator.integers(-3, 5, (n, 3)).astype(float),
            generator.integers(0, 5000, (n, 3)) / 1000,
            generator.uniform(-9, 9, (n, 3)).round(generator.integers(0, 16)),
        ][generator.integers(3)]
        text = layout(generator, points, delimiter, header)
        path.write_text(text, encoding="utf-8", newline="")
        # a few sites, all with three digits behind a comma
        if delimiter.isspace() and "," in text:
            try:
                found = read_points(path)
            except ValueError as error:
                with pytest.raises(ValueError, match=QUESTION):
                    raise error
                continue
        else:
            found = read_points(path)
        np.testing.assert_array_equal(found, points, err_msg=text)
