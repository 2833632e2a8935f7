"""The experiments on small sets: their tables, files and the paper's values."""

import csv
import sys

import numpy as np
import pytest
from rich.console import Console

from dt3d.experiments import EXPERIMENTS
from dt3d.experiments.kohout import paper, relief, sets
from dt3d.threaded2d import Delaunay

SMALL = {
    "phases": {"points": 1000},
    "queue": {"points": "1000,2000"},
    "batch": {"points": 1000, "repeats": 1, "data": "crater"},
    "circumcircle": {"points": 1000, "repeats": 1},
    "preset": {"points": 1000, "repeats": 1, "distributions": "uniform,arc"},
    "arc": {"points": 500},
    "subdivision": {"points": 1000, "seeds": 2, "elements": "2,8"},
    "wrong": {"points": "1000", "seeds": 1, "elements": "4,16"},
    "helping": {"points": "1000,3000"},
    "interleave": {"points": 1000, "repeats": 1, "searches": "1,8"},
    "batch-end": {"points": 2000, "elements": "2,8"},
    "costs": {"points": "500", "repeats": 1},
    "table4": {"points": 1000, "repeats": 1},
    "crater": {"points": 1000, "repeats": 1},
}


def test_all_are_here():
    assert {f"kohout-{name}" for name in SMALL} == {name for name in EXPERIMENTS if name.startswith("kohout")}


SLOW = ("preset", "interleave", "crater")


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] * (name in SLOW)) for name in SMALL]
)
def test_experiment(name, tmp_path):
    with open(tmp_path / "screen", "w") as file:
        console = Console(file=file, record=True, width=200)
        rows = EXPERIMENTS[f"kohout-{name}"](tmp_path, console, **SMALL[name])
        text = console.export_text()
    with open(tmp_path / f"kohout-{name}.csv", newline="") as file:
        table = list(csv.DictReader(file))
    assert len(table) == len(rows) >= 1
    assert set(table[0]) == set(rows[0])
    assert (tmp_path / f"kohout-{name}.png").read_bytes()[:4] == b"\x89PNG"
    assert (tmp_path / f"kohout-{name}.pdf").read_bytes()[:4] == b"%PDF"
    assert "Kohout et al. 2004" in text or name == "costs"
    if name == "batch-end":
        assert all(1 < row["best"] < 1.05 * row["bound"] for row in rows)
    virtual = [v for row in rows for c, v in row.items() if "virtual" in c and v is not None]
    assert all(0.1 < v < 16 for v in virtual)


def test_the_values_of_the_paper():
    assert paper.TABLE4["batch"] == (2.42, 3.81)
    assert paper.BATCH[100_000][2] == pytest.approx(paper.TABLE4["batch"][0], abs=0.005)
    assert paper.CIRCUMCIRCLE[100_000][2] == 2.399


@pytest.mark.parametrize(
    "name",
    ["arc", "subdivision", "wrong", *(pytest.param(n, marks=pytest.mark.slow) for n in ("helping", "queue"))],
)
def test_virtual_tables_are_the_same_twice(name, tmp_path):
    tables = []
    for k in range(2):
        with open(tmp_path / "screen", "w") as file:
            EXPERIMENTS[f"kohout-{name}"](tmp_path / str(k), Console(file=file, width=200), **SMALL[name])
            tables.append((tmp_path / str(k) / f"kohout-{name}.csv").read_text())
    assert tables[0] == tables[1]


@pytest.mark.parametrize("name", sets.DISTRIBUTIONS)
def test_the_sets(name):
    points = sets.DISTRIBUTIONS[name](500)
    assert points.shape == (500, 2)
    assert np.isfinite(points).all()
    assert len(np.unique(points, axis=0)) == 500
    np.testing.assert_array_equal(points, sets.DISTRIBUTIONS[name](500))


@pytest.fixture(scope="module")
def terrain():
    rng = np.random.default_rng(0)
    x, y = rng.random((2, 2000)) * 100
    return np.column_stack([x, y, 50 * np.sin(x / 20) + 1000])


def test_a_relief_has_the_threads_colours_and_no_margins(terrain):
    pytest.importorskip("pyvista")
    tri = Delaunay(terrain[:, :2], method="circumcircle", threads=2, subdivision="x-slabs")
    picture = relief.render(tri, terrain[:, 2], spacing=30.0, width=300)
    assert picture.dtype == np.uint8
    assert picture.shape[2] == 3
    drawn = (picture < 255).any(axis=2)
    assert drawn.any(axis=0)[10]  # all but ten pixels of the white is cut off
    assert not drawn.any(axis=0)[:10].any()
    blue, orange = (
        np.count_nonzero(colour)
        for colour in (
            picture[..., 2] > picture[..., 0].astype(int) + 20,
            picture[..., 0] > picture[..., 2].astype(int) + 20,
        )
    )
    assert min(blue, orange) > 0.02 * drawn.size


def test_without_pyvista_the_terrain_is_seen_from_above(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with open(tmp_path / "screen", "w") as file:
        console = Console(file=file, record=True, width=200)
        EXPERIMENTS["kohout-crater"](tmp_path, console, points=500, repeats=1)
        text = console.export_text()
    assert "a relief needs PyVista" in text
    assert "The picture is one seen from above." in text
    assert (tmp_path / "kohout-crater.png").read_bytes()[:4] == b"\x89PNG"
