"""Tetrahedra of a site: those of a Poisson process inside, fewer in small sets."""

import csv
import io

import numpy as np
import pytest
from rich.console import Console

import dt3d
from dt3d.experiments import sets
from dt3d.experiments.paper import RANDOM
from dt3d.experiments.questions import degrees as module
from dt3d.experiments.questions.degrees import MARGIN, POISSON, SAID, run, shortfall, sites_with


def test_inner_sites_have_the_poisson_mean_and_even_numbers():
    rows, counts = [], []
    for seed in range(2):
        row, count, distance = run(16000, seed)
        rows.append(row)
        counts.append(count[distance > MARGIN])
        assert row.mean == pytest.approx(4 * row.tetrahedra / row.sites)
    inner = np.concatenate(counts)
    assert not (inner % 2).any()
    error = inner.std() / np.sqrt(len(inner))
    assert abs(inner.mean() - POISSON) < 4 * error < 0.25
    # far from the paper's 24, and so are all sites
    assert inner.mean() - SAID > 20 * error
    assert all(SAID < row.mean < POISSON for row in rows)
    assert run(250, 0)[0].mean < SAID


def test_counts_are_those_of_the_tetrahedra():
    count, distance = module.tetrahedra_of_sites(100, 2)
    points = sets.rand(100, 2)
    simplices = dt3d.Delaunay(points).simplices
    assert count[7] == (simplices == 7).any(axis=1).sum()
    assert distance[7] == pytest.approx(min(points[7].min(), (1 - points[7]).min()) * 100 ** (1 / 3))


def test_shortfall_and_where_a_mean_is():
    n = [100, 1000, 10000]
    assert shortfall(n, [POISSON - 20 * k**-0.5 for k in n]) == pytest.approx((20, -0.5))
    means = [4 * row.tetrahedra / row.sites for row in RANDOM]
    assert 250 < sites_with(SAID, [row.sites for row in RANDOM], means) < 500
    assert sites_with(27, n, [20, 22, 26]) is None


def test_the_experiment(tmp_path):
    console = Console(file=io.StringIO(), width=80)
    rows = module.degrees(tmp_path, console, most_sites=1000, sets=2)
    with open(tmp_path / "degrees.csv", newline="") as file:
        assert [int(line["tetrahedra"]) for line in csv.DictReader(file)] == [row.tetrahedra for row in rows]
    assert "of our sets is 24 at about" in " ".join(console.file.getvalue().split())
