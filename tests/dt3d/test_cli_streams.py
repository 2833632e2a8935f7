"""The command line between other programs: standard input and output, JSON, silence, and bars."""

import io
import json
import os
import pty
import subprocess
import sys

import numpy as np
import pytest
from rich.console import Console

import dt3d
from dt3d import cli
from dt3d.cli.steps import Steps
from dt3d.cli.streams import STREAM, Formats, formats_of
from dt3d.files import read_mesh, write_mesh

POINTS = np.random.default_rng(8).random((50, 3))
CSV = "x,y,z\n" + "".join(f"{x!r},{y!r},{z!r}\n" for x, y, z in POINTS.tolist())
DT3D = [sys.executable, "-m", "dt3d"]


def dt3d_of(*words, given=b""):
    return subprocess.run([*DT3D, *map(str, words)], input=given, capture_output=True, check=False)


def test_points_come_and_tetrahedra_go_through_streams(tmp_path):
    done = dt3d_of("triangulate", "-", "-o", "-", "--format", "csv,npz", given=CSV.encode())
    assert done.returncode == 0, done.stderr
    with np.load(io.BytesIO(done.stdout)) as found:
        np.testing.assert_array_equal(found["simplices"], dt3d.Delaunay(POINTS).simplices)
    assert "50 points from standard input" in done.stderr.decode()
    assert "wrote standard output" in done.stderr.decode()
    verified = dt3d_of("verify", "-", "--format", "npz", given=done.stdout)
    assert verified.stdout.decode().endswith("standard input: a Delaunay triangulation\n")


def test_one_stream_and_one_file(tmp_path):
    (tmp_path / "a.csv").write_text(CSV)
    done = dt3d_of("triangulate", tmp_path / "a.csv", "-o", "-", "--format", ".vtu", "--quiet")
    assert (done.returncode, done.stderr) == (0, b"")
    (tmp_path / "a.vtu").write_bytes(done.stdout)
    np.testing.assert_array_equal(read_mesh(tmp_path / "a.vtu").simplices, dt3d.Delaunay(POINTS).simplices)
    done = dt3d_of(
        "triangulate", "-", "--format", "csv", "-o", tmp_path / "b.vtu", "--quiet", given=CSV.encode()
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, b"", b"")
    assert (tmp_path / "b.vtu").read_bytes() == (tmp_path / "a.vtu").read_bytes()


@pytest.mark.parametrize(
    ("words", "given", "message"),
    [
        (["-", "-o", "a.vtu"], CSV, "what comes by standard input, as in --format csv; got none"),
        (["a.csv", "-o", "-"], "", "what goes to standard output, as in --format vtu; got none"),
        (["-", "-o", "-", "--format", "csv"], CSV, "two formats here, as in --format csv,vtu; got csv"),
        (["-", "-o", "a.vtu", "--format", "csv,vtu"], CSV, "must be the format of what comes"),
        (["a.csv", "-o", "a.vtu", "--format", "csv"], "", "--format is for - (standard input or output)"),
        (["-", "-o", "a.vtu", "--format", "doc"], CSV, "from standard input: unknown extension '.doc'"),
        (["a.csv", "-o", "-", "--format", "doc"], "", "to standard output: unknown extension '.doc'"),
        (["-", "-o", "a.vtu", "--format", "csv"], "1,2,3\n4,5\n", "standard input, line 2: "),
        (["-", "-o", "a.vtu", "--format", "csv"], "", "standard input is empty"),
        (["a.csv", "-o", "-", "--format", "vtu", "--json"], "", "--json prints to standard output, where"),
    ],
)  # fmt: skip
def test_what_is_wrong_with_streams_is_one_line(tmp_path, words, given, message):
    (tmp_path / "a.csv").write_text(CSV)
    done = subprocess.run(
        [*DT3D, "triangulate", *words], input=given, capture_output=True, text=True, cwd=tmp_path, check=False
    )
    assert (done.returncode, done.stdout) == (2, "")
    assert message in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "a.vtu").exists()


def test_a_reader_that_leaves_is_no_fault():
    words = [*DT3D, "triangulate", "-", "-o", "-", "--format", "csv,vtk", "--quiet"]
    with subprocess.Popen(
        words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        process.stdout.close()
        process.stdin.write(CSV.encode())
        process.stdin.close()
        assert process.stderr.read() == b""
    assert process.returncode == 141


def test_formats():
    assert formats_of(None, "a.csv", "b.vtu") == Formats("", "")
    assert formats_of("csv", STREAM) == Formats(".csv", "")
    assert formats_of(".csv, .vtu", STREAM, STREAM) == Formats(".csv", ".vtu")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.save("points.npy", np.vstack([POINTS, POINTS[:1]]))
    np.save("plane.npy", POINTS[:, :2])
    return tmp_path


def test_json_of_a_triangulation(folder, capsys):
    assert (
        cli.main(["triangulate", "points.npy", "-o", "a.npz", "--json", "--verify", "--picture", "a.png"])
        == 0
    )
    out, err = capsys.readouterr()
    assert (out.count("\n"), err) == (1, "")
    found, tri = json.loads(out), dt3d.Delaunay(np.load("points.npy"))
    assert found["source"], found["output"] == ("points.npy", "a.npz")
    assert (found["sites"], found["duplicates"], found["simplices"]) == (51, 1, len(tri.simplices))
    assert (found["dimension"], found["hull_facets"], found["verified"]) == (3, len(tri.convex_hull), True)
    assert found["picture"] == "a.png"
    assert found["statistics"].keys() >= {"walked", "tested", "created", "threads", "deferred"}
    assert found["seconds"].keys() >= {"reading", "verifying", "writing", "drawing", "insertion", "total"}


@pytest.mark.parametrize("words", [["plane.npy"], ["points.npy", "--method", "extrapolation"]])
def test_json_of_other_methods(folder, capsys, words):
    assert cli.main(["triangulate", *words, "-o", "a.npz", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["dimension"] == (2 if "plane.npy" in words else 3)
    assert found["statistics"]["method" if "plane.npy" in words else "tetrahedra_per_iteration"]


def test_json_of_a_proof(folder, capsys):
    tri = dt3d.Delaunay(POINTS)
    write_mesh(tri, "good.npz")
    assert cli.main(["verify", "good.npz", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["file"], found["delaunay"]) == ("good.npz", True)
    assert [one["broken"] for one in found["invariants"]] == [0] * len(found["invariants"])
    np.savez("bad.npz", points=POINTS, simplices=tri.simplices[1:])
    assert cli.main(["verify", "bad.npz", "--json"]) == 1
    found = json.loads(capsys.readouterr().out)
    assert not found["delaunay"]
    assert any(one["broken"] for one in found["invariants"])
    assert cli.main(["verify", "bad.npz", "--quiet"]) == 1
    assert capsys.readouterr() == ("", "")


def test_quiet_says_nothing_but_what_is_wrong(folder, capsys):
    assert cli.main(["triangulate", "points.npy", "-o", "a.npz", "--quiet", "--method", "extrapolation"]) == 0
    assert capsys.readouterr() == ("", "")
    assert cli.main(["triangulate", "none.npy", "-o", "a.npz", "--quiet"]) == 2
    assert capsys.readouterr().err == "dt3d: there is no file none.npy\n"


def test_compressed_files_are_smaller(folder):
    for words in ([], ["--compress"]):
        assert cli.main(["triangulate", "points.npy", "-o", f"{len(words)}.vtu", "--quiet", *words]) == 0
    assert os.path.getsize("1.vtu") < 0.9 * os.path.getsize("0.vtu")
    np.testing.assert_array_equal(read_mesh("0.vtu").simplices, read_mesh("1.vtu").simplices)


def test_bars_on_a_terminal_say_what_is_left():
    text = io.StringIO()
    console = Console(file=text, force_terminal=True, width=100)
    with Steps(console, ["reading", "triangulating", "writing"]) as steps:
        with steps.step("reading"):
            pass
        with steps.step("triangulating", counts=True) as done:
            done(1, 4)
            steps._bars.refresh()
            assert "writing" in text.getvalue()  # what is still to come
            assert "left" in text.getvalue()
            assert " 25%" in text.getvalue()
        with steps.step("writing"):
            pass
    assert list(steps.seconds) == ["reading", "triangulating", "writing"]


def test_no_bars_where_nobody_looks():
    for options in ({"force_terminal": False}, {"force_terminal": True, "quiet": True}):
        text, quiet = io.StringIO(), options.pop("quiet", False)
        with Steps(Console(file=text, **options), ["a"], quiet=quiet) as steps, steps.step("a"):
            steps._bars.refresh()
        assert text.getvalue().strip() == ""


def test_a_mesh_does_not_go_to_a_terminal(folder):
    ours, theirs = pty.openpty()
    words = [*DT3D, "triangulate", "points.npy", "-o", "-", "--format", "vtu"]
    done = subprocess.run(words, stdout=theirs, stderr=subprocess.PIPE, text=True, check=False)
    os.close(theirs), os.close(ours)
    assert done.returncode == 2
    assert done.stderr.startswith("dt3d: a mesh is not for a terminal")
