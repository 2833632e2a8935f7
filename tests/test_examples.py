"""Every example runs, on few sites, and writes into a temporary folder."""

import runpy
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[1] / "examples"

# The words after each example's name, and the files that it then writes into the current folder.
RUNS = {
    "alpha_surface.py": [(["--points", "400", "--write", "surface.png"], ["surface.png"])],
    "atom_volumes.py": [(["--cells", "4", "--write", "atoms.png"], ["atoms.png"])],
    "even_triangles.py": [(["--sites", "30", "--steps", "3", "--write", "even.png"], ["even.png"])],
    "from_scipy.py": [(["300", "--write", "flat.png"], ["flat.png"])],
    "inside_the_hull.py": [(["--size", "2", "--write", "hull.png"], ["hull.png"])],
    "ledger_of_a_run.py": [(["--sites", "40", "--write", "ledger.png"], ["ledger.png"])],
    "lidar_tile.py": [(["--points", "2000", "--write", "tile.png"], ["tile.png"])],
    "many_small_sets.py": [(["--sets", "4", "--write", "sets.png"], ["sets.png"])],
    "protein_voids.py": [(["--atoms", "2000", "--write", "voids.png"], ["voids.png"])],
    "scattered_heights.py": [(["--kept", "200", "--step", "8", "--write", "map.png"], ["map.png"])],
    "scan_primitives.py": [(["--write", "scans.png"], ["scans.png"])],
    "write_your_own_algorithm.py": [(["--side", "12", "--write", "graph.png"], ["graph.png"])],
    "cm5_scaling.py": [(["--sites", "60", "--folder", "."], ["cm5_scaling.png"])],
    "cut_open.py": [(["--sites", "60", "--size", "200", "--write", "new/cut.png"], ["new/cut.png"])],
    "first_triangulation.py": [
        (["60"], []),
        (["60", "--write", "sites.vtu"], ["sites.vtu"]),
        (["60", "--write", "sites.png"], ["sites.png"]),
    ],
    "threads_in_the_plane.py": [
        (["300"], []),
        (["300", "--threads", "2", "--subdivision", "distance", "--write", "threads.png"], ["threads.png"]),
    ],
    "virtual_time.py": [(["--sites", "300", "--write", "virtual.png"], ["virtual.png"])],
    "watch_it_grow.py": [
        (["--sites", "60", "--size", "200", "--write", "growth.png"], ["growth.png"]),
        (["--sites", "60", "--size", "200", "--whole", "--write", "new/growth.png"], ["new/growth.png"]),
    ],
}

SLOW = {
    "ledger_of_a_run.py",
    "virtual_time.py",
}  # compile for 13 s; cm5_scaling.py and the experiments do what they do


def test_every_example_is_run():
    assert sorted(RUNS) == sorted(path.name for path in EXAMPLES.glob("*.py"))


@pytest.mark.parametrize(
    ("name", "words", "written"),
    [
        pytest.param(name, *run, marks=[pytest.mark.slow] if name in SLOW else [])
        for name, runs in RUNS.items()
        for run in runs
    ],
)
def test_example(name, words, written, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    run = runpy.run_path(str(EXAMPLES / name))["main"]
    run(words)
    assert capsys.readouterr().out
    for file in written:
        assert (tmp_path / file).stat().st_size > 0
