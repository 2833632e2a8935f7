"""`dt3d experiment eta` on few sites."""

import csv

import numpy as np
import pytest
from rich.console import Console

import dt3d
from dt3d.experiments import sets
from dt3d.experiments.questions.eta import attempt, depth, eta, faults


def test_faults_by_hand():
    # a cube: any two ways to cut it are right, since its corners are cospherical
    points = sets.cube(2)
    right = dt3d.Delaunay(points).simplices
    corner = np.array([[0, 1, 2, 4]])
    assert faults(points, corner, right) == (0, 0, 0)
    assert faults(points, np.array([[0, 1, 2, 3]]), right) == (0, 1, 0)
    # a site in the middle is sqrt(3) / 2 inside that sphere
    points = np.concatenate([points, [[0.5, 0.5, 0.5]]])
    wrong, flat, deepest = faults(points, corner, dt3d.Delaunay(points).simplices)
    assert (wrong, flat) == (1, 0)
    assert deepest == pytest.approx(3**0.5 / 2)


def test_depth_of_a_site_that_rounding_hides():
    corners = np.array([[1.0, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0]])
    sites = np.array([[0, -1 + 2.0**-50, 0], [0, 0, -1 + 2.0**-40]])
    assert depth(corners, sites) == pytest.approx(2.0**-40, rel=1e-9)
    assert depth(corners, sites[:1]) == pytest.approx(2.0**-50, rel=1e-9)


@pytest.fixture(scope="module")
def cube():
    points = sets.cube(4)
    return points, dt3d.Delaunay(points).simplices


@pytest.mark.parametrize(
    ("dtype", "exponent", "ending"),
    [("float64", -30, "Delaunay"), ("float32", -12, "Delaunay"), ("float32", -30, "given up")],
)
def test_single_precision_needs_a_larger_eta(cube, dtype, exponent, ending):
    points, right = cube
    trial = attempt(points, "cube", dtype, exponent, right)
    assert trial.ending == ending
    assert (trial.tetrahedra is None) == (ending == "given up")
    assert trial.faults.wrong == 0


def test_a_large_eta_is_wrong_without_a_word():
    points = sets.rand(250)
    right = dt3d.Delaunay(points).simplices
    small, large = (attempt(points, "rand.250", "float64", e, right) for e in (-30, -4))
    assert small.proven
    assert small.faults == (0, 0, 0)
    assert large.silent
    assert large.ending == "wrong, unnoticed"
    assert large.faults.wrong > 50
    assert 2**-4 < large.faults.deepest < 1  # large spheres magnify how far sites are moved


@pytest.mark.slow
def test_eta_on_the_papers_sets(tmp_path):
    with open(tmp_path / "screen", "w") as file:
        trials = eta(tmp_path, Console(width=200, file=file), most_sites=500, step=12)
    ended = {(t.name, t.dtype, t.exponent): t.ending for t in trials}
    assert {e for (name, dtype, _), e in ended.items() if (name, dtype) == ("cube", "float64")} == {
        "Delaunay"
    }
    assert ended["cube", "float32", -28] == ended["torus", "float32", -28] == "given up"
    assert ended["cube", "float32", -4] == "Delaunay"
    assert ended["rand.500", "float64", -4] == "wrong, unnoticed"
    with open(tmp_path / "eta.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(trials) == 3 * 2 * 4
    assert {r["ending"] for r in rows} <= {"Delaunay", "given up", "wrong, unnoticed", "warning"}
