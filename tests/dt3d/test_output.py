"""Tables and pictures: nothing is cut at 80 columns or in a pipe, and pictures can be printed."""

import io
import os
import re
import struct
import subprocess
import sys

import numpy as np
import pytest
from rich.console import Console

from dt3d._output import DPI, LABEL, LINE, MOST_VECTORS, SMALL, new_figure, publish, style, written
from dt3d._table import Sheet

COLUMNS = ["points", "method", *(f"paper column {k}" for k in range(9))]
ROWS = [[f"{n:,}", "circum-circle", *(f"{n / 7 + k:.4f}" for k in range(9))] for n in (1000, 10_000, 100_000)]


@pytest.fixture
def sheet():
    made = Sheet(
        "Kohout et al. 2004, Table [1]: a title that is by far longer than 80 columns " * 2,
        COLUMNS,
        {"method"},
    )
    for row in ROWS:
        made.add_row(*row)
    return made


def shown(sheet, width, terminal, through="show"):
    console = Console(file=io.StringIO(), width=width, force_terminal=terminal, color_system=None)
    if through == "show":
        sheet.show(console)
    else:
        console.print(sheet)
    return re.sub(r"\x1b\[[0-9;]*m", "", console.file.getvalue())


def cells(text):
    """The words of all lines, by line."""
    return [line.split() for line in text.splitlines()]


@pytest.mark.parametrize("width", [30, 80, 120])
@pytest.mark.parametrize(("terminal", "through"), [(True, "show"), (True, "print"), (False, "print")])
def test_a_table_is_split_where_a_screen_is_narrow(sheet, width, terminal, through):
    text = shown(sheet, width, terminal, through)
    assert "…" not in text
    assert all(len(line) <= width for line in text.split("\n", 3)[3].splitlines())
    for row in ROWS:
        lines = [line for line in cells(text) if line and line[0] == row[0]]
        assert len(lines) > 1  # each block repeats the first column
        assert [word for line in lines for word in line[1:]] == row[1:]
    for column in COLUMNS[1:]:
        assert text.count(column) == 1


@pytest.mark.parametrize("width", [30, 80])
def test_a_table_in_a_pipe_is_in_one_piece(sheet, width):
    text = shown(sheet, width, terminal=False)
    assert "…" not in text
    assert text.splitlines()[0].rstrip() == sheet.title.rstrip()
    assert "  ".join(COLUMNS).split() in cells(text)
    for row in ROWS:
        assert row in cells(text)


def test_what_is_wider_than_the_screen_by_itself_is_whole(sheet):
    text = shown(sheet, 12, terminal=True)
    assert "…" not in text
    for row in ROWS:
        for cell in row:
            assert cell in text


def test_several_columns_can_be_repeated():
    made = Sheet("t", ["set", "scheme", "a", "b"], {"set", "scheme"}, keep=2)
    made.add_row("uniform", "warrants", "1" * 8, "2" * 8)
    made.add_section()
    lines = cells(shown(made, 35, terminal=True))
    assert ["uniform", "warrants", "1" * 8] in lines
    assert ["uniform", "warrants", "2" * 8] in lines
    assert made.row_count == 1
    with pytest.raises(ValueError, match="the table has 4 columns, got 1 cells"):
        made.add_row("alone")


@pytest.mark.parametrize(
    "words", [["kohout-queue", "--points", "1000,2000"], ["kohout-phases", "--points", "2000"]]
)
def test_a_piped_experiment_is_whole(tmp_path, words):
    """The command itself, in a process whose output is a pipe 80 columns wide."""
    command = "import sys; from dt3d.cli import main; sys.exit(main(sys.argv[1:]))"
    done = subprocess.run(
        [sys.executable, "-c", command, "experiment", *words, "--out", str(tmp_path)],
        capture_output=True, text=True, encoding="utf-8", check=True,
        env=os.environ | {"COLUMNS": "80", "PYTHONIOENCODING": "utf-8"},
    )  # fmt: skip
    assert "…" not in done.stdout
    header = (tmp_path / f"{words[0]}.csv").read_text().splitlines()[0]
    assert header.replace(",", " ").split() in cells(done.stdout)
    for end in ("csv", "png", "pdf"):
        assert f"{words[0]}.{end}" in done.stdout


def test_a_figure_is_published_for_print(tmp_path):
    figure = new_figure(4, 3)
    axes = figure.add_subplot()
    (line,) = axes.plot([1, 2], [3, 4], "o-", label="a")
    (wide,) = axes.plot([1, 2], [4, 3], lw=5, ms=9, label="b")
    (long,) = axes.plot(np.arange(MOST_VECTORS + 1), label="c")
    axes.set(xlabel="sites", ylabel="seconds")
    axes.legend()
    publish(Console(file=io.StringIO()), tmp_path, "a", ["x"], [[1]], figure)
    table, png, pdf = written(tmp_path, "a")
    assert table.read_text().split() == ["x", "1"]
    width, height = struct.unpack(">II", png.read_bytes()[16:24])
    assert (width, height) == (4 * DPI, 3 * DPI)
    assert DPI >= 150
    assert pdf.read_bytes().startswith(b"%PDF")
    assert line.get_linewidth() == LINE
    assert (wide.get_linewidth(), wide.get_markersize()) == (5, 9)
    assert long.get_rasterized()
    assert not line.get_rasterized()
    assert axes.xaxis.label.get_fontsize() == LABEL
    assert axes.get_legend().get_texts()[0].get_fontsize() == SMALL


def test_a_pdf_is_the_same_again(tmp_path):
    for name in ("a", "b"):
        figure = new_figure(2, 2)
        figure.add_subplot().plot([1, 2])
        figure.legend(["x"])
        style(figure)
        publish(Console(file=io.StringIO()), tmp_path, name, ["x"], [], figure)
    assert (tmp_path / "a.pdf").read_bytes() == (tmp_path / "b.pdf").read_bytes()
