"""The model's time split by constants adds up; no fixed cost explains the paper's of rand.4000."""

import csv
import io

import pytest
from rich.console import Console

import scanvec as sv
from dt3d.experiments import calibration
from dt3d.experiments.paper import TABLE2
from dt3d.experiments.questions import gain as module
from dt3d.experiments.questions.gain import EXTRA, NODES, FixedAndShared, loads, parts, refit, tally
from dt3d.experiments.runs import SEED


@pytest.fixture(scope="module")
def measured():
    return loads(500, SEED)


@pytest.mark.slow
def test_parts_and_tallies_add_up(measured):
    for by in measured.values():
        for nodes in NODES:
            seconds = by[nodes].under(sv.CM5).seconds
            assert sum(parts(by[nodes], sv.CM5).values()) == pytest.approx(seconds)
            counts = tally(by[nodes])
            assert sum(sv.CM5.values[name] * counts[name] for name in module.PARTS) == pytest.approx(seconds)
    by = measured["rand.500"]
    assert tally(by[256])["P a step"] == 8 * tally(by[32])["P a step"] == 256 * by[32].steps
    assert parts(by[256], sv.CM5)["route"] < parts(by[32], sv.CM5)["route"] / 4


@pytest.mark.slow
def test_a_refit_finds_the_cost_that_was_there(measured, monkeypatch):
    """Times that a model makes, with 2 us a step and node on top, are found again."""
    tallies = {name: {n: tally(ledger) for n, ledger in by.items()} for name, by in measured.items()}

    def seconds(name, nodes):
        constants = {k: v for k, v in sv.CM5.values.items() if k in module.PARTS} | {"P a step": 2e-6}
        return sum(value * tallies[name][nodes][part] for part, value in constants.items())

    table1 = {name: type("Row", (), {"seconds": seconds(name, 32)}) for name in tallies}
    monkeypatch.setattr(module, "paper_row", table1.get)
    monkeypatch.setattr(module, "TABLE2", {n: {p: seconds(n, p) for p in (32, 128, 256)} for n in tallies})
    right, none = refit("P a step", tallies), refit(None, tallies)
    assert right.worst < 1e-6 < 0.01 < none.worst
    assert right.constants["P a step"] == pytest.approx(2e-6)
    assert right.gains["rand.500"] == pytest.approx(seconds("rand.500", 128) / seconds("rand.500", 256))
    assert set(EXTRA) <= set(tallies["rand.500"][32])


def test_no_fixed_cost_explains_the_papers_times():
    law = FixedAndShared.through((10, 7.0), (20, 4.5))
    assert law == pytest.approx((2, 50))
    assert law.seconds(50) == pytest.approx(3)
    for name, sign in (("rand.4000", 1), ("rand.16000", -1)):
        times = TABLE2[name]
        law = FixedAndShared.through((32, times[32]), (128, times[128]))
        assert sign * (times[256] / law.seconds(256) - 1) > 0.03


@pytest.mark.slow
def test_the_experiment(tmp_path, measured, monkeypatch):
    monkeypatch.setattr(module, "loads", lambda *arguments: measured)
    console = Console(file=io.StringIO(), width=80)
    module.gain(tmp_path, console, most_sites=500)
    with open(tmp_path / "gain.csv", newline="") as file:
        lines = list(csv.DictReader(file))
    whole = {int(row["nodes"]): float(row["seconds"]) for row in lines if row["part"] == "whole"}
    model = calibration.calibrated({name: by[32] for name, by in measured.items()})
    assert whole == {n: pytest.approx(measured["rand.500"][n].under(model).seconds) for n in NODES}
    assert "+34%" in console.file.getvalue()
