"""The loop finds the same tetrahedra from any first facets; from fewer, in more rounds and more time."""

import csv
import io

import numpy as np
import pytest
from rich.console import Console

import dt3d
from dt3d.experiments import sets
from dt3d.experiments.questions import seeds as module
from dt3d.experiments.questions.levels import facets_of, growth, random_facets
from dt3d.experiments.questions.seeds import NODES, RANDOM_EACH, expand, starts


@pytest.mark.slow
def test_random_facets_take_the_rounds_that_the_graph_says():
    points = sets.rand(80, 4)
    row, *_ = expand(RANDOM_EACH, points, starts(points, 4)[RANDOM_EACH])
    tri = dt3d.Delaunay(points)
    facets = facets_of(tri.simplices, tri.neighbors)
    random = growth(tri.neighbors, facets, random_facets(80, facets, np.random.default_rng([4, 80, 2])))
    assert row.tetrahedra == len(tri.simplices)
    assert (row.rounds, row.face_expansions) == (random.rounds, random.face_expansions)
    assert row.first_facets == random.first
    assert np.isnan(row.first_seconds)


@pytest.mark.slow
def test_the_experiment(tmp_path):
    console = Console(file=io.StringIO(), width=80)
    rows = module.seeds(tmp_path, console, sites=150, seed=4)
    with open(tmp_path / "seeds.csv", newline="") as file:
        assert [float(row["seconds"]) for row in csv.DictReader(file)] == [row.seconds for row in rows]
    assert {row.tetrahedra for row in rows} == {len(dt3d.Delaunay(sets.rand(150, 4)).simplices)}
    for nodes in NODES:
        own = {row.start: row for row in rows if row.nodes == nodes}
        assert own["n"].rounds < own["n/16"].rounds < own["one"].rounds
        assert own["n"].seconds < own["n/16"].seconds < own["one"].seconds
        assert own[RANDOM_EACH].rounds < own["n"].rounds
        assert np.isnan(own[RANDOM_EACH].first_seconds)
        assert own["one"].first_seconds < own["n"].first_seconds
