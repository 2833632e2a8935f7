"""`dt3d experiment cells` on few sites."""

import csv

import numpy as np
import pytest
from rich.console import Console

import dt3d
import scanvec as sv
from dt3d.experiments.questions.cells import RULES, cells, measure, needed
from dt3d.experiments.runs import points_of
from dt3d.extrapolation.buckets import cube_of_cells


def test_needed_cells_by_hand():
    grid = cube_of_cells([0.0] * 3, [8.0] * 3, 8**3, np.float64)
    assert (grid.side, grid.nx) == (1, 8)
    # a sphere of radius 1 about the middle of cell (3, 3, 3), whose corner at 0.87 it just swallows
    middle = np.array([3.5, 3.5, 3.5])
    corners = middle + np.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    found = needed(corners[None], grid)
    # above z = 3.5 the half-space has two layers: 3 x 3 cells without a cell missing, and 3 x 3 above
    assert found.sphere == 27
    assert found.box == 18
    assert found.cap == 9 + 9
    assert found.inner
    # a sphere of the same kind at the rim is cut by the grid, and reaches out of it
    found = needed(corners[None] - [0, 0, 3], grid)
    assert found.sphere == found.box == found.cap == 18
    assert not found.inner


def test_a_smaller_sphere_misses_the_cells_at_its_corners():
    grid = cube_of_cells([0.0] * 3, [8.0] * 3, 8**3, np.float64)
    directions = np.array([[1.0, 0, 0], [0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    found = needed((3.5 + 0.6 * directions)[None], grid)
    # 0.6 reaches the six neighbours, not those across edges, at 0.71; the one below is behind the face
    assert (found.cap, found.box, found.sphere) == (6, 18, 27)


@pytest.fixture(scope="module")
def size():
    return measure(points_of("rand.250"))


def test_the_counts_are_those_of_the_runs(size):
    for rule in RULES:
        tri = dt3d.Delaunay(
            points_of("rand.250"),
            method="extrapolation",
            machine=sv.Device(),
            robustness="perturb",
            search=rule,
            cells="uniform",
        )
        s = tri.stats
        assert size.expansions == s.face_expansions
        assert size.cells(rule) == pytest.approx(s.cells_opened / s.face_expansions)
        assert size.searched(rule) == pytest.approx(s.sites_searched / s.face_expansions)
        assert size.soon(rule) == pytest.approx(sum(s.search_rounds[:2]) / s.face_expansions)


def test_what_is_needed_is_opened(size):
    for part in (size.inner, size.rim):
        assert 1 <= part.cap <= part.box <= part.sphere
        assert part.box <= 1.5 * part.cap
        assert part.cells("boxes") > part.cells("caps") > part.cap
    assert size.inner.ratio("caps") < size.inner.ratio("boxes") < 2
    assert np.isnan(size.hull.cap)


@pytest.mark.slow
def test_inside_the_ratio_is_bounded_and_at_the_rim_it_grows(tmp_path):
    with open(tmp_path / "screen", "w") as file:
        sizes = cells(tmp_path, Console(width=200, file=file), most_sites=4000)
    assert [s.sites for s in sizes] == [1000, 2000, 4000]
    for rule in RULES:
        inner, rim = ([s.parts[name].ratio(rule) for s in sizes] for name in ("inner", "rim"))
        assert max(inner) < 1.1 * min(inner)
        assert rim[-1] > 1.2 * rim[0]
        assert all(s.soon(rule) > 0.9 for s in sizes)
    with open(tmp_path / "cells.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 3 * 3 * 2
