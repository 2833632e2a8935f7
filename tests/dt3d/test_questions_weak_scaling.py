"""Scans that are no primitive cost something where a processor has one site, next to nothing elsewhere."""

import csv
import io

import numpy as np
import pytest
from rich.console import Console

import scanvec as sv
from dt3d.experiments.questions import weak_scaling as module
from dt3d.experiments.questions.weak_scaling import (
    MODELS,
    WITHOUT,
    cm5_by_messages,
    exponent,
    of_model,
    with_primitive_scans,
)


def step(primitive, processors):
    return sv.Entry("", primitive, primitive, processors, 1, processors, 1, 8)


def test_primitive_scans_make_the_scan_model_of_a_pram():
    bare = with_primitive_scans(sv.CRCW_PRAM)
    for primitive in ("map", "scan", "get", "send"):
        assert bare.seconds(step(primitive, 64), 64) == sv.SCAN.seconds(step(primitive, 64), 64)
    assert sv.CRCW_PRAM.seconds(step("scan", 64), 64) > bare.seconds(step("scan", 64), 64)
    tree = with_primitive_scans(sv.HYPERCUBE)
    assert tree.seconds(step("get", 64), 64) == sv.HYPERCUBE.seconds(step("get", 64), 64)


def test_scans_by_messages_take_a_packet_for_each_level():
    more = cm5_by_messages(64).seconds(step("scan", 64), 64) - sv.CM5.seconds(step("scan", 64), 64)
    assert more == pytest.approx(12 * sv.CM5.values["packet"] - sv.CM5.values["combine"])


def test_exponent():
    n = [64, 256, 1024]
    assert exponent(n, [5 * np.log2(k) ** 1.5 for k in n]) == pytest.approx(1.5)


@pytest.mark.slow
def test_the_experiment(tmp_path):
    console = Console(file=io.StringIO(), width=80)
    rows = module.weak_scaling(tmp_path, console, most_sites=256)
    with open(tmp_path / "weak-scaling.csv", newline="") as file:
        assert len(list(csv.DictReader(file))) == len(rows) == (2 + 3) * (len(MODELS) + 1)
    gain = {
        each: of_model(rows, each, "CRCW_PRAM")[-1].seconds / of_model(rows, each, "CRCW_PRAM")[-1].primitive
        for each in (1, 16, 64)
    }
    assert gain[1] > 1.02 > gain[16] > gain[64] > 1
    for each in (1, 16):
        own = {row.model: row for row in rows if (row.sites, row.each) == (256, each)}
        assert own["CRCW_PRAM"].primitive == pytest.approx(own["SCAN"].seconds)
        assert own["CM5"].seconds < own[WITHOUT].seconds < 1.05 * own["CM5"].seconds
    ratio = {
        name: np.divide(*[row.seconds for row in of_model(rows, 1, name)]) for name in ("SCAN", "MESH2D")
    }
    assert ratio["MESH2D"] < ratio["SCAN"] < 1  # the smaller set over the larger one
    assert "without its control network" in " ".join(console.file.getvalue().split())
