"""The paper's boxes find what pruned cells find, and open every cell of a box."""

import numpy as np
import pytest

import dt3d
import scanvec as sv
from dt3d.extrapolation.buckets import bucket
from dt3d.extrapolation.expansion import expand_perturbed
from dt3d.extrapolation.faces import Face
from dt3d.extrapolation.points import Point
from dt3d.extrapolation.search_options import PAPER_SEARCH
from dt3d.extrapolation.whole_boxes import WHOLE_BOXES

from .searching import MACHINE, RNG, SETS, fourth_vertex, in_order


@pytest.mark.parametrize("name", SETS)
def test_whole_boxes_find_the_fourth_vertices(name):
    buckets = bucket(Point(*(MACHINE.vector(c.copy()) for c in SETS[name].T)), PAPER_SEARCH)
    sites = in_order(buckets)
    chosen = np.array([RNG.permutation(len(sites))[:3] for _ in range(60)], np.int32)
    faces = Face(*(MACHINE.vector(f.copy()) for f in chosen.T))
    answer = expand_perturbed(buckets, faces, WHOLE_BOXES)
    np.testing.assert_array_equal(answer.best.site.to_numpy(), [fourth_vertex(sites, *f) for f in chosen])


def test_every_cell_of_a_box_is_searched():
    points = np.random.default_rng(3).random((1000, 3))
    boxes = dt3d.Delaunay(points, preset="teng1993")
    caps = dt3d.Delaunay(points, robustness="perturb")
    np.testing.assert_array_equal(boxes.simplices, caps.simplices)
    s, pruned = boxes.stats, caps.stats
    # 1000 sites in 5^3 cells: eight in a cell, and none of the opened ones is left out
    assert 0.9 < s.sites_searched / (8 * s.cells_opened) < 1.1
    assert pruned.sites_searched < 0.85 * s.sites_searched
    assert sum(s.search_rounds) == s.face_expansions == sum(pruned.search_rounds)


def test_most_searches_end_within_two_rounds():
    s = dt3d.Delaunay(np.random.default_rng(4).random((1000, 3)), preset="teng1993").stats
    assert sum(s.search_rounds[:2]) > 0.9 * s.face_expansions  # "most": Teng et al. 1993, section 7


@pytest.mark.slow
def test_the_preset_is_the_same_on_simulated_processors():
    points = np.random.default_rng(5).random((300, 3))
    here = dt3d.Delaunay(points, preset="teng1993")
    there = dt3d.Delaunay(points, preset="teng1993", machine=sv.Simulated(4))
    np.testing.assert_array_equal(here.simplices, there.simplices)
    assert here.stats.search_rounds == there.stats.search_rounds
