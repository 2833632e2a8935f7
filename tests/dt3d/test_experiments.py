"""The experiments beside table1, on few sites; the full ones, which take minutes, are marked slow."""

import csv
import sys

import numpy as np
import pytest
from rich.console import Console

import dt3d
import scanvec as sv
from dt3d.experiments import EXPERIMENTS, calibration, sets, table2
from dt3d.experiments._output import panels
from dt3d.experiments.balance import SCHEMES, Work, shares, work
from dt3d.experiments.figure2 import break_even, cm2_seconds, exhaustive, figure2, growth, run
from dt3d.experiments.figure3 import figure3
from dt3d.experiments.machines import MODELS
from dt3d.experiments.machines import run as run_machines
from dt3d.experiments.paper import BREAK_EVEN, RANDOM, TABLE1, TABLE2, TABLE3
from dt3d.experiments.runs import cm5, measure, points_of
from dt3d.experiments.table3 import LARGER, TOO_MANY, table3


@pytest.fixture
def console(tmp_path):
    with open(tmp_path / "screen", "w") as file:
        yield Console(record=True, width=200, file=file)


def read(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def is_png(path):
    return path.read_bytes()[:4] == b"\x89PNG"


def test_every_experiment_is_listed_with_a_summary():
    assert list(EXPERIMENTS) == [
        "table1", "table2", "table3", "figure2", "figure3", "balance", "machines", "primitives",
        "depth", "seeds", "degrees", "cell-size", "eta", "cells", "weak-scaling", "gain",
        "kohout-phases", "kohout-queue", "kohout-batch", "kohout-circumcircle", "kohout-preset",
        "kohout-arc", "kohout-subdivision", "kohout-table4", "kohout-crater", "kohout-wrong",
        "kohout-helping", "kohout-interleave", "kohout-batch-end", "kohout-costs",
    ]  # fmt: skip
    assert all(function.__doc__ for function in EXPERIMENTS.values())


@pytest.fixture(scope="module")
def small_ledgers():
    return {
        f"rand.{n}": measure(points_of(f"rand.{n}"), cm5(also=(128, 256))).ledgers for n in (125, 250, 500)
    }


def test_calibration_meets_the_times_that_it_is_given(small_ledgers):
    ledgers = {name: by[32] for name, by in small_ledgers.items()}
    model = calibration.calibrated(ledgers)
    for row in RANDOM[:3]:
        assert ledgers[row.name].under(model).seconds == pytest.approx(row.seconds, rel=0.25)
    assert {n: c.origin for n, c in model.constants.items()} == {
        "issue": "calibrated", "element": "estimate", "route": "calibrated", "packet": "sourced",
        "packet_bytes": "sourced", "combine": "sourced",
    }  # fmt: skip
    assert "3 random sets, rand.125 to rand.500, on 32 nodes" in model.constants["issue"].source
    with pytest.raises(ValueError, match="at least 3 of Table 1's random sets, got 1"):
        calibration.calibrated({"rand.125": ledgers["rand.125"], "cube": ledgers["rand.125"]})


def test_predictions_of_other_nodes(small_ledgers, monkeypatch):
    module = sys.modules["dt3d.experiments.table2"]
    monkeypatch.setattr(module, "TABLE2", {"rand.500": {32: 7.0, 128: 3.5, 256: 2.0}})
    model, cells = module.predict(small_ledgers)
    assert [c.nodes for c in cells] == [32, 128, 256]
    assert [c.paper_speedup for c in cells] == [1, 2, 3.5]
    for c in cells:
        assert c.predicted == small_ledgers["rand.500"][c.nodes].under(model).seconds
        assert c.predicted_speedup == cells[0].predicted / c.predicted
    # free packets leave more to elements, which are shared out better
    _, free = module.predict(small_ledgers, 0.0)
    assert free[2].predicted_speedup > cells[2].predicted_speedup


def test_brute_force_finds_the_fourth_vertices():
    points = points_of("rand.125")
    tri = dt3d.Delaunay(points)
    # d is above (a, b, c), as the volume is positive
    above = exhaustive(sv.Simulated(4), points, tri.simplices[:, :3])
    assert np.array_equal(above, tri.simplices[:, 3])
    hull = exhaustive(sv.Device(), points, tri.convex_hull)
    assert (hull == -1).all()


@pytest.mark.slow
def test_brute_force_is_counted():
    size = run(125)
    assert (
        size.brute_force.elements > size.sites * measure(points_of("rand.125"), sv.Device()).face_expansions
    )
    assert size.brute_force.of("face expansion").messages == 0
    # the CM-2 is hardly used by so few sites, and does not see that they are twice as many
    assert 0 < size.cm2 < cm2_seconds(250) < 2 * size.cm2
    # three sizes of one ledger never cross
    assert break_even([size] * 3, sv.CM5) is None


def test_growth_is_the_slope_in_logarithms():
    assert growth([1.0, 2.0, 8.0], [10, 20, 40]) == pytest.approx([1, 2])


@pytest.mark.slow
def test_figure3(tmp_path, console):
    found = figure3(tmp_path, console, most_sites=250)
    rows = read(tmp_path / "figure3.csv")
    for name, m in found.items():
        assert sum(int(r["tetrahedra"]) for r in rows if r["set"] == name) == m.tetrahedra
        assert sum(m.per_iteration[:4]) > 0.95 * m.tetrahedra
    assert is_png(tmp_path / "figure3.png")


@pytest.mark.slow
def test_table3_on_torus_and_cube(tmp_path, console):
    outcomes = table3(tmp_path, console, most_sites=400)
    assert list(outcomes) == ["torus", "cube"]
    assert str(outcomes["cube"]["single"]) == TABLE3["cube"] == TOO_MANY
    assert not outcomes["cube"]["single"].finished
    # a perturbation that single precision can hold decides the cube
    assert outcomes["cube"][LARGER].tetrahedra == 1296
    assert outcomes["cube"]["double"].inconsistencies == 0
    assert outcomes["cube"]["double"].tetrahedra == outcomes["cube"]["exact"].tetrahedra == 1296
    assert outcomes["torus"]["double"].inconsistencies == outcomes["torus"]["exact"].inconsistencies == 0
    torus, cube = read(tmp_path / "table3.csv")
    assert (torus["paper_single"], torus["same"]) == ("27", "of the kind")
    assert (cube["paper_single"], cube["same"]) == (TOO_MANY, "yes")
    assert is_png(tmp_path / "table3.png")


@pytest.mark.parametrize(("count", "size"), [(1, (3, 3.8)), (2, (6, 3.8)), (3, (6, 7.6)), (4, (6, 7.6))])
def test_panels_are_two_in_a_row(count, size):
    figure, axes = panels(count, 3.0)
    assert tuple(figure.get_size_inches()) == size
    assert len(axes) == len(figure.axes) == count


def test_shares_by_hand():
    # two processors; face 0 searches cells of 20 and 1 sites, face 1 one of 9
    todo = Work(np.array([0, 0, 1]), np.array([20, 1, 9]), 2)
    assert [todo.items(s).tolist() for s in SCHEMES] == [[8, 8, 4, 1, 8, 1], [20, 1, 9], [21, 9]]
    warrants, requests, neither = shares(todo, processors=2)
    assert [s.loads.tolist() for s in (warrants, requests, neither)] == [[20, 10], [21, 9], [21, 9]]
    assert [s.lock_step for s in (warrants, requests, neither)] == [3 * 8, 2 * 20, 21]
    assert neither.busiest == 21 / 15


def test_the_work_of_faces_contains_their_spheres():
    points = sets.rand(200)
    tri = dt3d.Delaunay(points)
    todo = work(points, tri.simplices)
    assert todo.faces == len(tri.simplices) == todo.face[-1] + 1
    # each face looks into the cell of its own fourth vertex at least
    assert (np.bincount(todo.face, todo.sites) >= 1).all()
    assert (np.bincount(todo.face, todo.sites) <= 200).all()


@pytest.mark.slow
def test_balance(tmp_path, console):
    result = EXPERIMENTS["balance"](tmp_path, console, sites=200)
    for found, _ in result.values():
        assert found[0].in_step < found[1].in_step
        assert found[0].in_step < found[2].in_step
    assert len(read(tmp_path / "balance.csv")) == 6
    assert is_png(tmp_path / "balance.png")


@pytest.mark.slow  # small twins: the loads on further machines in tests/scanvec/test_models.py
def test_machines_reuse_one_run():
    ledgers = run_machines(125, (16, 64, 1024))
    again = measure(points_of("rand.125"), sv.Simulated(64, model=sv.EREW_PRAM)).ledgers[64]
    assert ledgers[64].entries == again.entries
    for model in MODELS[:3]:  # without a network, more processors are never slower
        seconds = [ledgers[p].under(model).seconds for p in (16, 64)]
        assert seconds[0] > seconds[1]
    assert ledgers[16].under(sv.EREW_PRAM).seconds > ledgers[16].under(sv.CRCW_PRAM).seconds
    assert ledgers[16].under(sv.CRCW_PRAM).seconds > ledgers[16].under(sv.SCAN).seconds


@pytest.mark.slow
def test_many_processors_find_what_a_device_does():
    points = points_of("rand.2000")
    options = {"method": "extrapolation", "robustness": "perturb"}
    many, few = sv.Simulated(16384, model=sv.CM2), sv.Simulated(32, model=sv.CM2, also=[16384])
    one, *others = (dt3d.Delaunay(points, machine=m, **options) for m in (sv.Device(), few, many))
    for other in others:
        for array in ("simplices", "neighbors", "convex_hull", "iteration"):
            np.testing.assert_array_equal(getattr(other, array), getattr(one, array))
    # and the loads that the smaller machine counts for the larger one are those of its own run
    assert few.ledgers[16384].entries == many.ledger.entries


def test_primitives_take_what_they_state():
    module = sys.modules["dt3d.experiments.primitives"]
    found = list(module.measurements((16, 128, 1000)))
    assert len(found) == 3 * len(module.CATALOGUE)
    assert all(m.holds for m in found)
    assert all(m.row.max_vp_ratio <= 2 * -(-m.n // module.PROCESSORS) for m in found)


@pytest.mark.slow
def test_table2_predicts_the_papers_times(tmp_path, console):
    cells = table2(tmp_path, console)
    assert len(cells) == sum(map(len, TABLE2.values()))
    for c in cells:
        assert c.calibrated or c.holds
    assert "All within 25% (seconds) and 20% (speed-ups)" in console.export_text()


@pytest.mark.slow
def test_figure2_breaks_even_near_the_papers_point(tmp_path, console):
    _, crossing = figure2(tmp_path, console)
    assert BREAK_EVEN / 2 <= crossing <= 2 * BREAK_EVEN


@pytest.mark.slow
def test_table3_finishes_exactly(tmp_path, console):
    outcomes = table3(tmp_path, console, most_sites=4700, other_sets=0)
    assert list(outcomes) == ["rand.4000", "torus", "cube", "spiral", "liss-5-8", "teapot", "polymer.932"]
    for by_mode in outcomes.values():
        assert by_mode["double"].inconsistencies == by_mode["exact"].inconsistencies == 0
        assert by_mode["exact"].finished
    assert outcomes["rand.4000"]["single"].inconsistencies <= 20
    assert {row.name for row in TABLE1} >= set(TABLE3)
    text = console.export_text()
    assert "fract2" in text  # what cannot be made is printed, too
    assert "phone1" in text


def test_titles_say_how_many_sets_are_made():
    for name, paper in (("table1", [row.name for row in TABLE1]), ("table3", list(TABLE3))):
        made = [row for row in paper if sets.can_be_made(row)]
        kind = [row for row in made if sets.of_the_kind(row)]
        assert f"{len(made)} of its" in EXPERIMENTS[name].__doc__
        assert f"of its {len(paper)} sets" in EXPERIMENTS[name].__doc__
        assert f", {len(kind)} " in EXPERIMENTS[name].__doc__
