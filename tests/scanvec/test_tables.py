"""The ledger added up, printed, and as CSV."""

import csv

import numpy as np
import pytest

import scanvec as sv

from .cases import (
    program,
)


@pytest.fixture
def cm():
    return sv.Simulated(processors=4)


@pytest.fixture
def v(cm):
    return cm.vector(np.arange(8))


def test_tables(cm, v):
    with cm.phase("a"):
        sv.split(v, v > 3)
    with cm.phase("b"):
        _ = v + 1
    by_primitive = {row.primitive: row for row in cm.ledger.table("primitive")}
    assert list(by_primitive) == ["map", "scan", "send"]
    # > and the conversion, the indices and the targets of split, and +
    assert by_primitive["map"] == sv.Row("", "", "map", 5, 40, 10, 2, 0, 0)
    assert by_primitive["scan"] == sv.Row("", "", "scan", 1, 8, 2, 2, 3, 1)
    assert [(row.phase, row.steps) for row in cm.ledger.table("phase")] == [("a", 6), ("b", 1)]
    assert [(r.phase, r.operation, r.steps) for r in cm.ledger.table("operation", "phase")] == [
        ("a", "map", 1),
        ("a", "split", 5),
        ("b", "map", 1),
    ]
    # without keys: by operation and primitive, which is what is printed
    assert [(r.operation, r.primitive) for r in cm.ledger.table()] == [
        ("map", "map"),
        ("split", "map"),
        ("split", "scan"),
        ("split", "send"),
    ]
    lines = str(cm.ledger).splitlines()
    assert lines[0].split()[:5] == ["operation", "primitive", "steps", "elements", "vp_steps"]
    assert lines[1].split() == ["map", "map", "2", "16", "4", "2", "0", "0"]
    assert len({len(line) for line in lines}) == 1
    with pytest.raises(ValueError, match="by 'bytes'; use phase, operation, primitive"):
        cm.ledger.table("bytes")


def test_an_empty_ledger_prints_its_head(cm):
    assert str(cm.ledger).split()[0] == "operation"


def test_csv(tmp_path):
    cm = sv.Simulated(4, model=sv.CM5)
    program(cm)
    cm.ledger.to_csv(tmp_path / "ledger.csv")
    with open(tmp_path / "ledger.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == cm.ledger.steps
    assert sum(int(r["messages"]) for r in rows) == cm.ledger.messages
    assert sum(float(r["seconds"]) for r in rows) == pytest.approx(cm.ledger.seconds)
    assert [r["phase"] for r in rows] == [e.phase for e in cm.ledger.entries]
