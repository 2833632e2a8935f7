"""The fuzzer: its oracle refuses what is wrong, its processes see hangs and deaths; and some fuzzing."""

import os
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

import dt3d
from dt3d import threaded2d
from dt3d.files import read_points

from . import oracle
from .__main__ import point_sets, run_again
from .families import ALL, draw
from .files import CORRUPTIONS, _require_prefix, command_trial, file_trial, samples, sites
from .minimise import minimise
from .misbehave import misbehave
from .worker import Worker

ROOT = Path(__file__).parents[2]


def fuzz(*arguments):
    command = [sys.executable, "-W", "ignore", "-m", "tests.fuzz", *map(str, arguments)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True)


@pytest.mark.filterwarnings("ignore::dt3d.QuadraticSearchWarning")
def test_nothing_is_found_in_some_seconds():
    seed = int.from_bytes(os.urandom(4), "little")
    until = float("inf")
    tried = 0
    for case in point_sets(seed):
        try:
            case.function(*case.arguments)
        except Exception as error:
            points, k = case.arguments
            msg = f"{case.family}, number {k} of seed {seed}, fails: {error!r}; points:\n{points.tolist()}"
            raise AssertionError(msg) from error
        tried += 1
        if tried == 4:  # now most is compiled
            until = time.monotonic() + 4
        if time.monotonic() > until:
            break
    assert tried > 4


@pytest.mark.slow
def test_nothing_is_found_in_a_minute(tmp_path):
    run = fuzz("--seconds", 60, "--out", tmp_path)
    assert run.returncode == 0, run.stdout + run.stderr
    assert " 0 failures" in run.stdout
    assert int(run.stdout.splitlines()[-1].split()[0].replace(",", "")) > 100


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("family", ALL)
def test_families_are_finite_and_repeat(family, d):
    for seed in range(3):
        points = draw(np.random.default_rng(seed), family, d, 20)
        assert points.ndim == 2
        assert points.shape[1] == d
        assert np.isfinite(points).all()
        np.testing.assert_array_equal(points, draw(np.random.default_rng(seed), family, d, 20))


def test_what_was_saved_can_be_repeated(tmp_path):
    np.savez(tmp_path / "points.npz", points=np.eye(4, 3), seed=3)
    assert "verify" in run_again(tmp_path / "points.npz")


def test_a_file_that_lost_rows_in_the_middle_is_noticed():
    whole = sites()
    _require_prefix(whole[:5], whole)
    with pytest.raises(oracle.Refuted, match="first points"):
        _require_prefix(np.delete(whole, 2, axis=0), whole)


def test_files_are_whole_before_they_are_broken(tmp_path):
    for name, (data, points) in samples().items():
        (tmp_path / name).write_bytes(data)
        np.testing.assert_array_equal(read_points(tmp_path / name), points, err_msg=name)


def test_broken_files_are_points_or_one_line():
    seed = int.from_bytes(os.urandom(4), "little")
    worker = Worker(file_trial, patience=120.0, warming=[])
    try:
        for name in samples():
            for k in range(seed, seed + len(CORRUPTIONS)):
                outcome, what = worker.run(name, k)
                assert outcome == "done", f"{name}, number {k}: {what}"
    finally:
        worker.end()


@pytest.mark.slow
def test_forty_broken_files_of_every_kind_through_the_command_line():
    seed = int.from_bytes(os.urandom(4), "little")
    worker = Worker(command_trial, patience=120.0, warming=[("table.csv", 0)])
    ended = Counter()
    try:
        for name in samples():
            for k in range(seed, seed + 40):
                outcome, what = worker.run(name, k)
                assert outcome == "done", f"{name}, number {k}: {what}"
                ended[what[1]] += 1
    finally:
        worker.end()
    print(f"{len(samples())} kinds of file: {dict(ended)}")
    assert ended["refused"] > ended["read"] > 0


def right(d):
    """Points with a copy; their simplices, neighbors and duplicates, which can be written to."""
    points = np.random.default_rng(3).random((12, d))
    points = np.concatenate([points, points[:1]])
    tri = dt3d.Delaunay(points) if d == 3 else threaded2d.Delaunay(points)
    simplices = tri.simplices if d == 3 else tri.triangles
    return [np.array(x) for x in (points, simplices, tri.neighbors, tri.duplicates)]


@pytest.mark.parametrize("d", [2, 3])
def test_the_oracle_accepts_what_is_right(d):
    oracle.check(*right(d))


def swap_vertices(points, simplices, neighbors, duplicates):
    simplices[0, :2] = simplices[0, 1::-1]
    neighbors[0, :2] = neighbors[0, 1::-1]


def lose_a_duplicate(points, simplices, neighbors, duplicates):
    duplicates[0, 1] = 1


def name_another_neighbor(points, simplices, neighbors, duplicates):
    t, k = np.argwhere(neighbors >= 0)[0]
    neighbors[t, k] = (neighbors[t, k] + 1) % len(simplices)


def move_a_site_into_a_sphere(points, simplices, neighbors, duplicates):
    t, k = np.argwhere(neighbors >= 0)[0]
    u = neighbors[t, k]
    far = simplices[u][neighbors[u] == t][0]
    points[points.shape[0] - 1] = points[0]
    points[far] = 0.999 * points[simplices[t]].mean(axis=0) + 0.001 * points[far]


def move_a_site_out_of_the_hull(points, simplices, neighbors, duplicates):
    t, k = np.argwhere(neighbors < 0)[0]
    facet = np.delete(simplices[t], k)
    points[facet[0] if facet[0] else facet[1]] += 0.9 * (points.mean(axis=0) - points[facet].mean(axis=0))


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize(
    "fault",
    [
        swap_vertices,
        lose_a_duplicate,
        name_another_neighbor,
        move_a_site_into_a_sphere,
        move_a_site_out_of_the_hull,
    ],
)
def test_the_oracle_refuses(fault, d):
    result = right(d)
    fault(*result)
    with pytest.raises(oracle.Refuted):
        oracle.check(*result)


def test_the_oracle_refuses_a_pentagram():
    angle = 2 * np.pi * np.arange(5) / 5
    points = np.concatenate([np.c_[np.cos(angle), np.sin(angle)], [[0.0, 0.0]]])
    triangles = np.array([[5, i, (i + 2) % 5] for i in range(5)])
    neighbors = np.array([[-1, (i + 2) % 5, (i - 2) % 5] for i in range(5)])
    with pytest.raises(oracle.Refuted, match="no site lies beyond the hull"):
        oracle.check(points, triangles, neighbors, np.empty((0, 2), int))


def test_the_oracle_refuses_what_covers_the_hull_twice():
    points, simplices, neighbors, duplicates = right(3)
    # the same tetrahedra on copies of all sites: two sheets, each right
    twice = np.concatenate([simplices, simplices])
    beside = np.where(neighbors < 0, -1, neighbors + len(simplices))
    with pytest.raises(oracle.Refuted):
        oracle.check(points, twice, np.concatenate([neighbors, beside]), duplicates)
    exact = oracle.integers(points)
    with pytest.raises(oracle.Refuted, match="once"):
        oracle._check_covered_once(exact, twice)


def test_the_oracle_refuses_the_other_diagonal_of_a_square():
    points = np.array([[0.0, 0], [1, 0], [0, 1], [1, 1]])
    none = np.empty((0, 2), int)
    tri = threaded2d.Delaunay(points)
    oracle.check(points, tri.triangles, tri.neighbors, none)
    joined = set(tri.triangles[0]) & set(tri.triangles[1])
    a, b = [0, 3] if joined == {1, 2} else [1, 2]
    c, e = sorted(joined)
    turned = [[a, b, v] if oracle.orient([*points[[a, b, v]]]) > 0 else [b, a, v] for v in (c, e)]
    with pytest.raises(oracle.Refuted, match="perturbation"):
        oracle.check(points, np.array(turned), np.array([[-1, -1, 1], [-1, -1, 0]]), none)


@pytest.mark.parametrize(
    ("points", "dimension"),
    [
        ([[1, 2, 3]] * 3, 0),
        ([[0, 0, 0], [1, 2, 3], [2, 4, 6]], 1),
        ([[0, 0, 0], [1, 2, 3], [2, 4, 6], [0, 0, 1e-300]], 2),
        (np.eye(4, 3).tolist(), 3),
    ],
)
def test_the_oracle_knows_the_dimension(points, dimension):
    assert oracle.dimension(np.array(points, float)) == dimension


def test_minimising_keeps_what_fails():
    points = np.arange(100.0)[:, None]
    least = minimise(points, lambda p: {17.0, 60.0} <= set(p[:, 0]), seconds=60)
    assert least[:, 0].tolist() == [17.0, 60.0]


def test_a_worker_sees_errors_hangs_and_deaths():
    worker = Worker(misbehave, patience=20.0, warming=[("warm",)])
    try:
        assert worker.run("fine") == ("done", "fine")
        outcome, what = worker.run("raise")
        assert outcome == "failed"
        assert what.startswith("ValueError: it is wrong")
        assert worker.run("die") == ("dies", "the process ended with status 7")
        assert worker.run("fine") == ("done", "fine")
        worker.patience = 0.5
        assert worker.run("hang")[0] == "hangs"
        worker.patience = 20.0
        assert worker.run("fine") == ("done", "fine")
    finally:
        worker.end()
