"""Depths counted in a finished triangulation are those of the algorithm, and grow as the experiment says."""

import csv
import io

import numpy as np
import pytest
from rich.console import Console

import dt3d
import scanvec as sv
from dt3d.experiments import sets
from dt3d.experiments.questions import depth as module
from dt3d.experiments.questions.depth import EACH_LEAST, EACH_RANDOM, LINES, ONE, UNIFORM, fits, means, run
from dt3d.experiments.questions.levels import depths, facets_of, growth, least_circle, random_facets


def test_rounds_and_face_expansions_are_those_of_the_algorithm():
    points = sets.rand(120, 5)
    ran = dt3d.Delaunay(points, preset="teng1993", machine=sv.Device()).stats
    tri = dt3d.Delaunay(points)
    facets = facets_of(tri.simplices, tri.neighbors)
    first = least_circle(points, facets)
    found = growth(tri.neighbors, facets, first)
    assert (found.rounds, found.face_expansions) == (ran.iterations, ran.face_expansions)
    depth = depths(tri.neighbors, facets.tetrahedra[first].reshape(-1))
    counts = np.bincount(depth, minlength=ran.iterations + 1)[1:]
    assert tuple(counts) == ran.tetrahedra_per_iteration
    assert found.depth == depth.max()


def test_facets_of_the_sites():
    points = sets.rand(200, 1)
    tri = dt3d.Delaunay(points)
    facets = facets_of(tri.simplices, tri.neighbors)
    assert len(facets.vertices) == (4 * len(tri.simplices) + len(tri.convex_hull)) / 2
    some = random_facets(200, facets, np.random.default_rng(0))
    for rows in (some, least_circle(points, facets)):
        assert (facets.vertices[rows] == np.arange(200)[:, None]).any(axis=1).all()
    with pytest.raises(ValueError, match="1 sites have no first facet"):
        random_facets(201, facets, np.random.default_rng(0))


def test_random_facets_bound_the_depth_of_uniform_sites_only():
    rows = [row for n in (500, 4000) for row in run(UNIFORM, n, 3)]
    least, random, one = (means(rows, UNIFORM, start) for start in (EACH_LEAST, EACH_RANDOM, ONE))
    assert random[500] < least[500]
    assert random[4000] < least[4000] < one[4000] / 4
    assert random[4000] - random[500] <= 1
    assert one[4000] > 1.5 * one[500]
    rows = [row for n in (100, 800) for row in run(LINES, n, 3)]
    assert [row.tetrahedra for row in rows[::5]] == [49**2, 399**2]
    least, random = (means(rows, LINES, start) for start in (EACH_LEAST, EACH_RANDOM))
    assert least[800] > 6 * least[100]
    assert 2 * random[100] < random[800] < least[800] / 2


def test_the_nearest_form_is_first():
    n = [100, 1000, 10000, 100000]
    assert fits(n, [1 + 2 * np.log2(k) for k in n])[0][:1] == ("log2 n",)
    near = fits(n, [3 + 0.5 * k ** (1 / 3) for k in n])[0]
    assert near.form == "n^(1/3)"
    assert near[1:] == pytest.approx((3, 0.5, 0), abs=1e-9)


def test_the_experiment(tmp_path):
    console = Console(file=io.StringIO(), width=80)
    rows = module.depth(tmp_path, console, most_sites=500, sets=1)
    with open(tmp_path / "depth.csv", newline="") as file:
        assert [int(line["depth"]) for line in csv.DictReader(file)] == [row.depth for row in rows]
    printed = " ".join(console.file.getvalue().split())
    assert "two lines, random of each site: the depth grows like a power of the sites." in printed
