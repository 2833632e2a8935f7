"""The command line: what it writes, what it prints, and how it fails."""

import re
import subprocess
import sys
import warnings
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

import dt3d
from dt3d import cli, samples
from dt3d._mesh_plane import write_plane_mesh
from dt3d.cli.all_experiments import QUICK
from dt3d.cli.report import table_of
from dt3d.files import read_mesh, write_mesh


@pytest.fixture
def points(tmp_path):
    """A file of 60 random sites, the first of them twice."""
    sites = np.random.default_rng(5).random((60, 3))
    path = tmp_path / "sites.npy"
    np.save(path, np.vstack([sites, sites[:1]]))
    return path


def fails(capsys, *words):
    """Runs a command that must fail with status 2 and one line; returns the line."""
    assert cli.main([str(word) for word in words]) == 2
    out, err = capsys.readouterr()
    assert err.startswith("dt3d: ")
    assert err.count("\n") == 1
    assert "Traceback" not in out + err
    return err


def row(out, name):
    """The value in the printed table's row of that name."""
    return re.search(rf"│ {re.escape(name)} +│ +([\d,.]+) │", out)[1]


def test_triangulate_writes_a_mesh_and_prints_its_counts(points, tmp_path, capsys):
    mesh, picture = tmp_path / "mesh.npz", tmp_path / "mesh.png"
    words = ["triangulate", points, "-o", mesh, "--picture", picture, "--method", "extrapolation"]
    assert cli.main([str(word) for word in words]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert picture.read_bytes().startswith(b"\x89PNG")

    tri = dt3d.Delaunay(np.load(points), method="extrapolation")
    written = read_mesh(mesh)
    np.testing.assert_array_equal(written.simplices, tri.simplices)
    assert row(out, "sites") == "61"
    assert row(out, "duplicates") == "1"
    assert row(out, "tetrahedra") == f"{len(tri.simplices):,}"
    assert row(out, "iterations") == str(tri.stats.iterations)
    assert row(out, "face expansions") == f"{tri.stats.face_expansions:,}"
    assert row(out, "expansions per tetrahedron") == f"{tri.stats.face_expansions / len(tri.simplices):.2f}"
    assert row(out, "inconsistencies") == "0"
    assert row(out, "decided exactly") == str(tri.stats.exact_decisions)
    for phase in tri.stats.seconds:
        assert float(row(out, f"seconds: {phase}")) >= 0
    # a line for each iteration, the last of which has all tetrahedra and no open face
    growth = re.findall(r"^ +(\d+) +([\d,]+) +([\d,]+) +[\d.]+$", out, re.MULTILINE)
    assert [int(line[0]) for line in growth] == list(range(1, tri.stats.iterations + 1))


def test_triangulate_inserts_unless_told_otherwise(points, tmp_path, capsys):
    mesh = tmp_path / "mesh.npz"
    assert cli.main(["triangulate", str(points), "-o", str(mesh)]) == 0
    out = capsys.readouterr().out
    tri = dt3d.Delaunay(np.load(points), method="insertion")
    np.testing.assert_array_equal(read_mesh(mesh).simplices, tri.simplices)
    assert re.search(r"│ method +│ +insertion │", out)
    assert row(out, "tetrahedra") == f"{len(tri.simplices):,}"
    assert "per site" not in out
    assert (
        cli.main(["triangulate", str(points), "-o", str(mesh), "--details", "--verify", "--threads", "1"])
        == 0
    )
    out = capsys.readouterr().out
    assert "verified: a Delaunay triangulation\n" in out
    assert row(out, "tetrahedra tested per site") == f"{tri.stats.tested / 61:.2f}"
    assert float(row(out, "seconds: verifying")) >= 0


def test_simulated_machine_prints_its_ledger(points, tmp_path, capsys):
    words = ["triangulate", points, "-o", tmp_path / "a.npz", "--machine", "simulated", "--processors", "4"]
    assert cli.main([str(word) for word in words]) == 0
    out = capsys.readouterr().out
    assert "Steps of the simulated machine" in out
    steps, elements = re.search(r"│ in all +│ +([\d,]+) │ +([\d,]+) │", out).groups()
    assert int(steps.replace(",", "")) > 0
    assert int(elements.replace(",", "")) > 0


def test_options_reach_the_triangulation(points, tmp_path, monkeypatch):
    seen = {}

    def spy(sites, *, callback, **options):
        seen.update(options)
        msg = "enough"
        raise dt3d.InconsistencyError(msg, 3)

    monkeypatch.setattr(dt3d, "Delaunay", spy)
    words = ["triangulate", str(points), "-o", str(tmp_path / "a.npz"), "--seed", "7", "--dtype", "float32"]
    words += ["--robustness", "perturb"]
    assert cli.main([*words, "--machine", "simulated"]) == 2
    assert (seen["seed"], seen["dtype"], seen["machine"].processors) == (7, "float32", 32)
    assert (seen["method"], seen["robustness"]) == ("auto", "perturb")
    assert cli.main([*words, "--machine", "device"]) == 2
    assert type(seen["machine"]).__name__ == "Device"
    assert cli.main([*words, "--threads", "3"]) == 2
    assert (seen["machine"], seen["threads"]) == (None, 3)


def test_demo_on_fewer_sites(tmp_path, monkeypatch, capsys):
    some = samples.mtor()[:80]
    monkeypatch.setattr(samples, "mtor", lambda: some)
    assert cli.main(["demo", "--out", str(tmp_path / "new" / "out")]) == 0
    assert row(capsys.readouterr().out, "sites") == "80"
    assert len(read_mesh(tmp_path / "new" / "out" / "mtor.vtu").points) == 80
    assert (tmp_path / "new" / "out" / "mtor.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.slow
def test_demo(tmp_path, capsys):
    assert cli.main(["demo", "--out", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    assert row(out, "sites") == "22,194"
    assert row(out, "tetrahedra") == "149,469"  # what Qhull finds, too
    assert row(out, "inconsistencies") == "0"


def test_view_draws_without_a_screen(cube, tmp_path, capsys):
    write_mesh(cube, tmp_path / "cube.npz")
    words = ["view", tmp_path / "cube.npz", "--screenshot", tmp_path / "cube.png"]
    words += ["--html", tmp_path / "cube.html", "--scalar", "iteration", "--cut", "0.2", "--longest", "inf"]
    assert cli.main([*map(str, words), "--azimuth", "-20"]) == 0
    assert (tmp_path / "cube.png").read_bytes().startswith(b"\x89PNG")
    page = (tmp_path / "cube.html").read_text()
    assert '"scalar": "iteration", "cut": 0.2' in page
    assert '"azimuth": -20.0' in page
    assert capsys.readouterr().out.count("wrote") == 2


def test_view_shows_the_plane(tmp_path, capsys):
    write_plane_mesh(dt3d.Delaunay(np.random.default_rng(0).random((20, 2))), tmp_path / "a.vtu")
    assert cli.main(["view", str(tmp_path / "a.vtu"), "--html", str(tmp_path / "a.html")]) == 0
    assert '"kind": "triangles"' in (tmp_path / "a.html").read_text()
    np.savez(tmp_path / "bad.npz", points=np.zeros((3, 2)), triangles=[[0, 1, 7]])
    line = fails(capsys, "view", tmp_path / "bad.npz", "--html", tmp_path / "b.html")
    assert "bad.npz is damaged: triangles name sites 0 to 7, but there are 3 points" in line


def test_view_refuses_what_cannot_be(cube, tmp_path, capsys):
    write_mesh(cube, tmp_path / "cube.npz")
    words = ["view", tmp_path / "cube.npz", "--html", tmp_path / "a.html"]
    assert "cut must be from 0" in fails(capsys, *words, "--cut", "3")
    assert "scalars must be one of" in fails(capsys, *words, "--scalar", "colour")
    assert "leaves nothing" in fails(capsys, *words, "--longest", "0.1")
    assert "unknown extension '.pdf'" in fails(capsys, *words[:2], "--html", tmp_path / "a.pdf")
    assert not (tmp_path / "a.html").exists()


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere there is always a screen")
def test_view_without_a_screen_says_so(cube, tmp_path, monkeypatch, capsys):
    write_mesh(cube, tmp_path / "cube.npz")
    monkeypatch.delenv("DISPLAY", raising=False)
    assert "use --screenshot FILE.png, or --html" in fails(capsys, "view", tmp_path / "cube.npz")
    monkeypatch.setenv("DISPLAY", ":4711")
    assert "DISPLAY=:4711 does not answer; use --s" in fails(capsys, "view", tmp_path / "cube.npz")


def test_errors_are_one_line(points, tmp_path, capsys):
    good = tmp_path / "a.npz"
    flat = tmp_path / "flat.csv"
    flat.write_text("x,y,z\n" + "\n".join(f"{i},{i * i},0" for i in range(9)))
    assert "there is no file" in fails(capsys, "triangulate", tmp_path / "none.npy", "-o", good)
    assert "unknown extension '.foo'" in fails(capsys, "triangulate", tmp_path / "a.foo", "-o", good)
    assert "unknown extension '.foo'" in fails(capsys, "triangulate", points, "-o", tmp_path / "a.foo")
    assert "no folder" in fails(capsys, "triangulate", points, "-o", tmp_path / "no" / "a.vtu")
    assert "unknown extension '.gif'" in fails(
        capsys, "triangulate", points, "-o", good, "--picture", tmp_path / "a.gif"
    )
    assert "goes with --machine simulated" in fails(
        capsys, "triangulate", points, "-o", good, "--processors", "4"
    )
    assert "processors must be a positive integer" in fails(
        capsys, "triangulate", points, "-o", good, "--machine", "simulated", "--processors", "0"
    )
    assert "there is no file" in fails(
        capsys, "view", tmp_path / "none.vtu", "--screenshot", tmp_path / "a.png"
    )
    assert "plane" in fails(capsys, "triangulate", flat, "-o", good)
    assert not good.exists()


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["triangulate"], '"triangulate" parameter --source requires an argument'),
        (["triangulate", "a.npy", "-o", "b.npz", "--bogus"], "Unknown option: --bogus"),
        (
            ["triangulate", "a.npy", "-o", "b.npz", "--seed", "x"],
            "Invalid value for --seed: unable to convert",
        ),
        (["what"], 'Unknown command "what". Available commands: demo, triangulate,'),
    ],
)
def test_wrong_words_have_status_2_and_one_line(words, text, capsys):
    line = fails(capsys, *words)
    # some versions of Cyclopts put names in quotes
    assert text.replace('"', "") in line.replace('"', "")
    assert line.endswith("(dt3d --help has the words)\n")


def test_ctrl_c_has_status_130(points, tmp_path, monkeypatch, capsys):
    def interrupt(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(dt3d, "Delaunay", interrupt)
    assert cli.main(["triangulate", str(points), "-o", str(tmp_path / "a.npz")]) == 130
    assert capsys.readouterr().err == "interrupted\n"


def test_warnings_are_one_line(points, tmp_path, monkeypatch, capsys):
    def warn(*_, **__):
        warnings.warn("the result has holes", RuntimeWarning, stacklevel=1)
        msg = "enough"
        raise ValueError(msg)

    monkeypatch.setattr(dt3d, "Delaunay", warn)
    with warnings.catch_warnings():
        warnings.simplefilter("default")
        assert cli.main(["triangulate", str(points), "-o", str(tmp_path / "a.npz")]) == 2
    assert capsys.readouterr().err == "dt3d: warning: the result has holes\ndt3d: enough\n"


def test_experiments_are_looked_up_and_get_their_options(tmp_path, monkeypatch, capsys):
    seen = {}

    def growth(out, console, *, sites=10, exact="no"):
        """Tetrahedra found in each iteration.

        More.
        """
        seen.update(out=out, sites=sites, exact=exact)
        console.print("grown")

    module = ModuleType("dt3d.experiments")
    module.EXPERIMENTS = {"growth": growth}
    monkeypatch.setitem(sys.modules, "dt3d.experiments", module)

    assert cli.main(["experiment"]) == 0
    growth, every = capsys.readouterr().out.splitlines()
    assert growth.split(maxsplit=1) == ["growth", "Tetrahedra found in each iteration."]
    assert every.split(maxsplit=1) == ["all", "All of these, one after the other."]
    assert cli.main(["experiment", "growth", "--out", str(tmp_path / "x"), "--sites", "20"]) == 0
    assert seen == {"out": tmp_path / "x", "sites": 20, "exact": "no"}
    assert (tmp_path / "x").is_dir()
    assert capsys.readouterr().out == "grown\n"
    assert "there is no experiment 'decay'; there are growth" in fails(capsys, "experiment", "decay")
    assert cli.main(["experiment", "growth", "--out", str(tmp_path / "x"), "--quick", "--exact", "yes"]) == 0
    assert seen == {"out": tmp_path / "x", "sites": QUICK["sites"], "exact": "yes"}
    assert "takes the options sites, exact; got size" in fails(capsys, "experiment", "growth", "--size", "3")


def test_version(capsys):
    assert cli.main(["--version"]) == 0
    assert re.fullmatch(r"\d+\.\d+\.\d+\n", capsys.readouterr().out)


def test_python_runs_the_package():
    command = [sys.executable, "-m", "dt3d", "--version"]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert out == f"{dt3d.__version__}\n"


def test_no_numbers_are_divided_by_nothing():
    stats = dt3d.Statistics(
        iterations=0,
        face_expansions=0,
        sites_searched=0,
        exact_decisions=0,
        tetrahedra_per_iteration=(),
        inconsistencies=0,
        seconds={},
        ledger=None,
    )
    arrays = dict.fromkeys(["points", "simplices", "convex_hull", "duplicates"], ())
    table = table_of(SimpleNamespace(**arrays, stats=stats, ndim=3), "nothing")
    assert list(table.columns[1].cells).count("-") == 2


def test_importing_dt3d_loads_nothing_heavy_but_jax():
    heavy = "{'pyvista', 'vtk', 'matplotlib', 'meshio', 'numba', 'rich', 'cyclopts'}"
    code = f"import sys, dt3d; print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_the_help_loads_nothing_that_computes():
    heavy = "{'numpy', 'numba', 'jax', 'scipy'}"
    code = f"import sys, dt3d.cli as cli; cli.main(['--help']); print(sorted({heavy} & set(sys.modules)))"
    # a frame is drawn in letters that the locale may not have
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, encoding="utf-8", check=True)
    assert done.stdout.splitlines()[-1] == "[]"
