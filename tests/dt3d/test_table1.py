"""The Table 1 experiment, on its smaller sets, and the sets themselves."""

import csv

import numpy as np
import pytest
from rich.console import Console

from dt3d.experiments import EXPERIMENTS, sets
from dt3d.experiments.paper import TABLE1
from dt3d.experiments.table1 import rows


def test_small_rows_agree_with_the_paper(tmp_path):
    console = Console(record=True, width=160, file=open(tmp_path / "screen", "w"))  # noqa: SIM115
    with console.file:
        measured = EXPERIMENTS["table1"](tmp_path, console, most_sites=500, other_sets=2)
    assert [r.paper.name for r in measured] == [
        "rand.125", "rand.250", "rand.500", "dodecahedron", "cube",
    ]  # fmt: skip
    for row in measured:
        if row.paper.name.startswith("rand."):
            assert abs(row.ours.tetrahedra / row.paper.tetrahedra - 1) < 0.01
            assert abs(row.ours.depth - row.paper.depth) <= 1
            assert 1.45 <= row.ours.per_tetrahedron <= 1.65
            assert len(row.others) == 2
        assert row.ours.searched <= row.paper.searched
        assert row.ours.inconsistencies == 0
    assert measured[-1].ours.tetrahedra == measured[-1].paper.tetrahedra == 1296

    with open(tmp_path / "table1.csv", newline="") as file:
        table = list(csv.DictReader(file))
    assert [int(r["ours_tetrahedra"]) for r in table] == [r.ours.tetrahedra for r in measured]
    assert (tmp_path / "table1.png").read_bytes()[:4] == b"\x89PNG"
    text = console.export_text()
    assert "1296 / 1296" in text
    assert "not published" in text


@pytest.mark.slow
def test_all_rows_agree_with_the_paper():
    for row in rows(other_sets=0):
        if row.paper.name.startswith("rand."):
            assert abs(row.ours.tetrahedra / row.paper.tetrahedra - 1) < 0.01
            assert abs(row.ours.depth - row.paper.depth) <= 1
            assert 1.45 <= row.ours.per_tetrahedron <= 1.65
        assert row.ours.searched <= row.paper.searched
        assert row.ours.inconsistencies == 0


def test_the_sets():
    assert sets.rand(50).shape == (50, 3)
    assert not np.array_equal(sets.rand(50), sets.rand(50, 1))
    assert len(sets.cube()) == 343
    solid = sets.dodecahedron()
    distances = np.sort(np.linalg.norm(solid[:, None] - solid, axis=2), axis=1)
    np.testing.assert_allclose(np.linalg.norm(solid, axis=1), 3**0.5, rtol=1e-15)
    np.testing.assert_allclose(distances[:, 1:4], distances[0, 1], rtol=1e-14)  # three edges a vertex
    assert (distances[:, 4] > 1.5 * distances[0, 1]).all()
    assert [p.sites for p in TABLE1[:8]] == [125 * 2**k for k in range(8)]
