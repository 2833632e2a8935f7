"""`dt3d experiment cell-size` on few sites."""

import csv

import pytest
from rich.console import Console

import scanvec as sv
from dt3d.experiments.questions.cell_size import PAPER, balances, cell_size, pairs, run
from dt3d.experiments.runs import points_of


def test_pairs_are_alike_or_have_the_papers_size():
    assert list(pairs(4, 2)) == [(2, 2), (4, 4)]
    few = [(2, 2), (4, 4), (8, 8), (16, 16), (8, 4), (8, 16), (4, 8), (16, 8)]
    assert list(pairs(16, 2)) == few
    assert set(pairs(16, 4)) - set(few) == {(8, 2), (2, 8)}


@pytest.fixture(scope="module")
def runs():
    points = points_of("rand.125")
    return {pair: run(points, *pair, nodes=(32,)) for pair in ((2, 2), (2, 16), (16, 16))}


@pytest.mark.slow
def test_the_options_change_what_is_counted(runs):
    small, wide, large = runs.values()
    # cells decide which sites are looked at, warrants only how
    assert (small.cells, small.searched) == (wide.cells, wide.searched)
    assert small.cells > 2 * large.cells
    assert small.searched < large.searched
    # a warrant of 16 sites has as many steps, most of which do nothing in cells of 2
    few, many = (r.ledgers[32].steps for r in (small, wide))
    assert many > few
    assert small.seconds(sv.CM5, 32) < wide.seconds(sv.CM5, 32)
    assert large.really == pytest.approx(125 / 8)


@pytest.mark.slow
def test_the_best_is_the_least_of_all(runs):
    found = balances(list(runs.values()))
    assert {b.processors for b in found} == {32}
    for b in found:
        assert b.best_seconds <= b.alike_seconds <= b.paper_seconds
        assert b.alike.per_cell == b.alike.per_warrant


@pytest.mark.slow
def test_eight_sites_are_near_the_balance(tmp_path):
    with open(tmp_path / "screen", "w") as file:
        console = Console(record=True, width=200, file=file)
        found = cell_size(tmp_path, console, sites=1000)
    alike = {r.per_cell: r.seconds(sv.CM5, 32) for r in found if r.per_cell == r.per_warrant}
    assert min(alike, key=alike.get) == PAPER
    assert alike[2] > 1.05 * alike[PAPER]
    assert alike[32] > 1.05 * alike[PAPER]
    with open(tmp_path / "cell-size.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(found) == 9
    assert float(rows[2]["CM5_32"]) == alike[8]
    assert "8 sites per cell and warrant are best of sizes that are alike" in " ".join(
        console.export_text().split()
    )
