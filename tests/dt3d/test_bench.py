"""The benchmark: what it triangulates, how it takes what libraries do, and what it writes."""

import csv
import io

import numpy as np
import pytest
from rich.console import Console

import dt3d
from dt3d import bench, cli
from dt3d._output import write_csv
from dt3d.bench.report import HEADER, by_set, csv_rows, ratio, table
from dt3d.bench.worker import Ended, Run, Worker, verified

from .families import grid

UNIFORM = np.random.default_rng(3).random((300, 3))


def measured(library, runs, **other):
    known = {"tetrahedra": 2000, "memory": 60_000, "verified": None, "ended": ""}
    return bench.Measured("uniform", 300, library, tuple(runs), **(known | other))


@pytest.mark.parametrize("name", bench.DISTRIBUTIONS)
def test_distributions_are_what_they_are_called(name):
    points = bench.generated(name, 1000).points
    assert points.shape == (1000, 3)
    np.testing.assert_array_equal(points, bench.generated(name, 1000).points)
    distance = np.linalg.norm(points, axis=1)
    extent = np.ptp(points, axis=0)
    holds = {
        "uniform": (extent <= 1).all() and extent.min() > 0.9,
        "gauss": abs(points.std() - 1) < 0.1,
        "clusters": len(np.unique(np.round(points, 1), axis=0)) < 200,
        "sphere": np.allclose(distance, 1, atol=1e-12),
        "thin-sphere": distance.min() >= 1 - 1e-12 and 0.0009 < np.ptp(distance) < 0.0011,
        "ball": distance.max() <= 1 and abs((distance < 0.5).mean() - 1 / 8) < 0.04,
        "grid": len(np.unique(points)) == 10,
        "slab": extent[2] < 2e-3 * extent[0],
    }
    assert holds[name]


@pytest.mark.parametrize(("name", "n", "words"), [("ring", 10, "uniform"), ("uniform", 3, "at least four")])
def test_sets_that_there_are_not(name, n, words):
    with pytest.raises(ValueError, match=words):
        bench.generated(name, n)


def test_dt3d_and_scipy_are_compared(tmp_path):
    np.save(tmp_path / "some.npy", UNIFORM)
    said = []
    rows = bench.compare(
        bench.from_file(tmp_path / "some.npy"),
        ["scipy", "dt3d"],
        [1, 2],
        bench.Limits(repeats=3, seconds=60),
        verify=True,
        say=said.append,
    )
    assert [row.label for row in rows] == ["dt3d, 1 thread", "dt3d, 2 threads", "scipy"]
    assert {(row.set_name, row.sites, row.verified, row.ended) for row in rows} == {("some", 300, True, "")}
    assert {row.tetrahedra for row in rows} == {len(dt3d.Delaunay(UNIFORM).simplices)}
    assert all(len(row.runs) == 3 and sorted(row.runs)[1] == row.seconds > 0 for row in rows)
    assert ratio(rows[2], rows) == rows[2].seconds / rows[0].seconds
    assert said[0] == "some, 300 sites: dt3d, 1 thread warms up"
    # a round has every library once
    rounds = [text for text in said if "round" in text]
    assert [text.rpartition(" ")[2] for text in rounds] == [*"111222333"]


def test_what_takes_too_long_is_ended():
    (row,) = bench.compare(bench.Sites("a", UNIFORM), [], [1], bench.Limits(repeats=3, seconds=1e-7))
    assert (row.runs, row.seconds, row.ended) == ((), None, "> 1e-07 s")


def test_who_used_up_the_time_gets_no_more_rounds(monkeypatch):
    class Slow:
        def __init__(self, *_):
            self.asked = 0

        def ready(self):
            return None

        def run(self, limit):
            self.asked += 1
            return Run(4.0, 10, None)

        def end(self):
            pass

    monkeypatch.setattr("dt3d.bench.rounds.Worker", Slow)
    (row,) = bench.compare(bench.Sites("a", UNIFORM), [], [None], bench.Limits(repeats=9, seconds=10))
    assert row.runs == (4.0, 4.0, 4.0)


def test_a_worker_says_what_was_raised_and_goes_on():
    worker = Worker("dt3d", 1, np.vstack([UNIFORM, [[np.nan] * 3]]))
    try:
        assert worker.ready() is None
        for _ in range(2):
            answer = worker.run(60)
            assert isinstance(answer, Ended)
            assert answer.why.startswith("ValueError: points must be finite")
        worker.process.kill()
        assert worker.run(60) == Ended("crashed")
    finally:
        worker.end()


def test_proofs_take_any_orientation_and_no_gaps():
    tri = dt3d.Delaunay(UNIFORM)
    turned = tri.simplices.copy()
    turned[::2] = turned[::2, [1, 0, 2, 3]]
    assert verified(UNIFORM, turned)
    assert not verified(UNIFORM, turned[1:])
    # two flat tetrahedra in the place of nothing
    cube = grid(2)
    flat = np.concatenate([dt3d.Delaunay(cube).simplices, [[0, 1, 2, 3]]])
    assert not verified(cube, flat)


def test_libraries_that_are_not_there():
    with pytest.raises(ValueError, match="'qhull' is not among the libraries that are installed here: dt3d"):
        bench.compare(bench.Sites("a", UNIFORM), ["qhull"], [None], bench.Limits())


def test_files_and_table(tmp_path):
    rows = [
        measured("dt3d", [0.2, 0.1, 0.9], verified=True),
        measured("scipy", [2.0], ended="> 60 s", verified=False),
        measured("vtk", [], ended="crashed", tetrahedra=0, memory=None),
    ]
    write_csv(tmp_path / "a.csv", HEADER, csv_rows(rows))
    with (tmp_path / "a.csv").open() as file:
        written = list(csv.DictReader(file))
    assert [line["ratio"] for line in written] == ["1.0", "10.0", ""]
    assert [line["median seconds"] for line in written] == ["0.2", "2.0", ""]
    assert [line["ended"] for line in written] == ["", "> 60 s", "crashed"]
    assert written[0]["runs"] == "0.200000 0.100000 0.900000"
    assert len(by_set([*rows, measured("dt3d", [1.0], verified=None)])) == 1

    console = Console(file=io.StringIO(), width=200)
    console.print(table(rows))
    lines = [line.split() for line in console.file.getvalue().split("\n")]
    assert ["0.2", "1.00", "2,000", "0.01", "200", "yes", "3"] in [line[-7:] for line in lines]
    assert ["2", "10.00", "2,000", "0.00", "200", "NO", "1,", ">", "60", "s"] in [
        line[-10:] for line in lines
    ]
    assert ["vtk", "crashed", "0"] in [line[-3:] for line in lines]


def test_command(tmp_path, capsys):
    out = tmp_path / "new"
    words = [
        "bench",
        "--sizes",
        "200",
        "3e2",
        "--distributions",
        "grid",
        "--against",
        "scipy",
        "--repeats",
        "1",
    ]
    assert cli.main([*words, "--out", str(out)]) == 0
    with (out / "bench.csv").open() as file:
        written = list(csv.DictReader(file))
    assert [(line["sites"], line["library"]) for line in written] == [
        ("216", "dt3d"), ("216", "scipy"), ("343", "dt3d"), ("343", "scipy"),
    ]  # fmt: skip
    assert (out / "bench.png").read_bytes().startswith(b"\x89PNG")
    assert (out / "bench.pdf").read_bytes().startswith(b"%PDF")
    assert "Delaunay triangulation in space" in capsys.readouterr().out


def test_command_refuses_what_it_does_not_know(tmp_path, capsys):
    assert cli.main(["bench", "--distributions", "ring", "--out", str(tmp_path)]) == 2
    assert "there is no distribution 'ring'" in capsys.readouterr().err
