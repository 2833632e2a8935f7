"""Constants of the paper's search: they change what is searched, not what is found."""

import numpy as np
import pytest

import dt3d
from dt3d._extrapolation_options import search_options
from dt3d.extrapolation.search_options import PAPER_SEARCH, SITES_PER_CELL, SearchOptions

POINTS = np.random.default_rng(7).random((400, 3))
CLUSTERS = np.random.default_rng(8).normal(size=(400, 3)) ** 5


def test_the_paper_s_values():
    assert SITES_PER_CELL == PAPER_SEARCH.sites_per_cell == PAPER_SEARCH.sites_per_warrant == 8
    assert PAPER_SEARCH.whole_boxes
    assert PAPER_SEARCH.uniform_cells
    assert not SearchOptions().whole_boxes
    assert (PAPER_SEARCH.preset_limit, SearchOptions().preset_limit) == (3, 8)
    for given, want in (
        ({"preset": "teng1993"}, PAPER_SEARCH),
        ({"search": "boxes"}, PAPER_SEARCH),
        ({}, SearchOptions()),
    ):
        assert search_options(given, exact=False) == want


@pytest.mark.parametrize(
    "options",
    [
        {"sites_per_cell": 16, "sites_per_warrant": 3},
        pytest.param({"sites_per_cell": 2}, marks=pytest.mark.slow),
        pytest.param({"sites_per_cell": 32}, marks=pytest.mark.slow),
        pytest.param({"preset_limit": 1}, marks=pytest.mark.slow),
        pytest.param({"search": "caps"}, marks=pytest.mark.slow),
        pytest.param({"search": "caps", "cells": "auto"}, marks=pytest.mark.slow),
    ],
)
def test_constants_change_the_work_alone(options):
    plain = dt3d.Delaunay(POINTS, preset="teng1993")
    other = dt3d.Delaunay(POINTS, preset="teng1993", **options)
    found = [{tuple(sorted(t)) for t in tri.simplices.tolist()} for tri in (plain, other)]
    assert found[0] == found[1]
    assert plain.stats.sites_searched != other.stats.sites_searched


@pytest.mark.parametrize("options", [{"sites_per_cell": 3}, {"cells": "uniform"}, {"preset_limit": 2}])
def test_constants_of_exact_cells(options):
    plain = dt3d.Delaunay(CLUSTERS)
    other = dt3d.Delaunay(CLUSTERS, method="extrapolation", **options)
    assert {frozenset(t) for t in plain.simplices.tolist()} == {
        frozenset(t) for t in other.simplices.tolist()
    }


def test_uneven_sites_in_uniform_cells():
    tree = dt3d.Delaunay(CLUSTERS, robustness="perturb")
    cells = dt3d.Delaunay(CLUSTERS, robustness="perturb", cells="uniform")
    assert tree.stats.cells_opened == 0 < cells.stats.cells_opened
    assert {frozenset(t) for t in tree.simplices.tolist()} == {frozenset(t) for t in cells.simplices.tolist()}


def test_eta_moves_the_sites():
    grid = np.stack(np.meshgrid(*[np.arange(4.0)] * 3), -1).reshape(-1, 3)
    small, large = (dt3d.Delaunay(grid, preset="teng1993", eta=eta) for eta in (2.0**-30, 2.0**-3))
    assert len(small.simplices) == len(large.simplices) == 162  # 27 cubes of six
    assert small.stats.inconsistencies == 0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"preset": "teng"}, "preset must be 'teng1993' or None, got 'teng'"),
        ({"search": "box", "robustness": "perturb"}, "search must be 'caps' or 'boxes', got 'box'"),
        ({"cells": "tree", "robustness": "perturb"}, "cells must be 'auto' or 'uniform', got 'tree'"),
        ({"search": "boxes", "method": "extrapolation"}, "search='boxes' goes with robustness='perturb'"),
        ({"eta": 0.1, "method": "extrapolation"}, "eta=0.1 goes with robustness='perturb'"),
        ({"preset": "teng1993", "eta": 0}, "eta must be a number between 0 and 1, such as .*, got 0"),
        ({"preset": "teng1993", "eta": float("nan")}, "eta must be a number between 0 and 1"),
        ({"preset": "teng1993", "cells": "auto"}, "search='boxes' .* goes with cells='uniform', got 'auto'"),
        ({"preset": "teng1993", "sites_per_cell": 0}, "sites_per_cell must be a positive integer, got 0"),
        ({"preset": "teng1993", "preset_limit": 2.5}, "preset_limit must be a positive integer, got 2.5"),
        ({"preset": "teng1993", "method": "insertion"}, "method='insertion' is exact"),
        ({"sites_per_cell": 4}, "sites_per_cell=4 goes with method='extrapolation'"),
    ],
)
def test_options_that_do_not_go_together(options, message):
    with pytest.raises(ValueError, match=message):
        dt3d.Delaunay(POINTS, **options)


def test_an_option_that_there_is_not():
    with pytest.raises(TypeError, match="no option 'site_per_cell'; did you mean 'sites_per_cell'"):
        dt3d.Delaunay(POINTS, preset="teng1993", site_per_cell=4)
    with pytest.raises(TypeError, match="no option 'joggle'; there are also"):
        dt3d.Delaunay(POINTS, joggle=True)
