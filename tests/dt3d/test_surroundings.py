"""The whole package where it is installed in unfriendly places: containers, service users, updates in place.

A copy of the packages runs in processes of its own. What it compiles takes minutes, so most of this is slow;
`test_kernel_cache` has the same on three small functions.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import dt3d

ROOT = Path(dt3d.__file__).parents[1]

PLANE_AND_SPACE = """
import numpy as np, dt3d
from dt3d import threaded2d

points = np.random.default_rng(0).random((60, 3))
tri = dt3d.Delaunay(points)
flat = threaded2d.Delaunay(points[:, :2])
assert (tri.find_simplex(points) >= 0).all() and (flat.find_simplex(points[:, :2]) >= 0).all()
assert tri.verify() and flat.verify()
assert len(tri.vertex_neighbor_vertices[0]) == 61
extrapolated = dt3d.Delaunay(points, method="extrapolation")
assert set(map(frozenset, extrapolated.simplices.tolist())) == set(map(frozenset, tri.simplices.tolist()))
print("works")
"""

GRID = """
import itertools
import numpy as np, dt3d
tri = dt3d.Delaunay(np.array(list(itertools.product(range(3), repeat=3)), float))
print(sorted(map(sorted, tri.simplices.tolist())))
"""


@pytest.fixture
def installed(tmp_path):
    """A copy of the packages that has compiled nothing, and the environment to run it in."""
    for package in ("dt3d", "scanvec"):
        shutil.copytree(ROOT / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__"))
    keep = {k: v for k, v in os.environ.items() if k not in ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME")}
    return tmp_path, keep | {"PYTHONPATH": str(tmp_path), "PYTHONDONTWRITEBYTECODE": "1"}


def run(installed, program, **variables):
    folder, environment = installed
    return subprocess.run(
        [sys.executable, "-c", program], cwd=folder, env=environment | variables,
        capture_output=True, text=True, check=True,
    )  # fmt: skip


def close(folder):
    """No cache beside the sources can be written; files stop a root, too, whom permissions do not stop."""
    for package in (folder, *(p for p in folder.rglob("*") if p.is_dir())):
        (package / "__pycache__").write_text("")


@pytest.mark.slow
def test_without_a_folder_that_can_be_written_all_works_and_says_what_it_costs(installed, tmp_path):
    close(tmp_path / "dt3d")
    done = run(installed, PLANE_AND_SPACE, HOME="/dev/null/nowhere")
    assert done.stdout == "works\n"
    lines = done.stderr.splitlines()
    assert len(lines) == len(set(lines)) > 3  # one for each part
    for line in lines:
        assert re.match(r"compiling .*, some \d+ s, in every process, .* NUMBA_CACHE_DIR", line)
    # as the line advises
    chosen = str(tmp_path / "chosen")
    done = run(installed, GRID, HOME="/dev/null/nowhere", NUMBA_CACHE_DIR=chosen)
    assert "once" in done.stderr
    done = run(installed, GRID, HOME="/dev/null/nowhere", NUMBA_CACHE_DIR=chosen)
    assert done.stderr == ""


def test_a_folder_that_was_chosen_and_cannot_be_written_ends_no_import(installed, tmp_path):
    """Every module with kernels imports where nothing can be kept, as numba's own cache does not let it."""
    close(tmp_path / "dt3d")
    program = "import dt3d.location, dt3d.verification, dt3d.threaded2d, dt3d._vertices; print('works')"
    done = run(installed, program, HOME="/dev/null/nowhere", NUMBA_CACHE_DIR="/dev/null/chosen")
    assert (done.stdout, done.stderr) == ("works\n", "")


@pytest.mark.slow
def test_an_update_in_place_of_what_is_compiled_in_is_seen(installed, tmp_path):
    """The order of the perturbation is compiled into insertion; its file keeps its time."""
    before = run(installed, GRID).stdout
    again = run(installed, GRID)
    assert (again.stdout, again.stderr) == (before, "")  # nothing is compiled
    rule = tmp_path / "dt3d/predicates/lexicographic.py"
    text, time = rule.read_text(), rule.stat()
    # one coordinate in reverse; with all three a grid, which is its own mirror image, has the same tetrahedra
    right, mirrored = "return points[i, k] < points[j, k]", "return (points[i, k] < points[j, k]) == (k != 1)"
    changed = text.replace(right, mirrored)
    assert changed != text
    rule.write_text(changed)
    os.utime(rule, (time.st_atime, time.st_mtime))
    updated = run(installed, GRID)
    assert "compiling" in updated.stderr
    clean = run(installed, GRID, NUMBA_CACHE_DIR=str(tmp_path / "clean"))
    assert updated.stdout == clean.stdout != before


def test_every_kernel_has_the_cache_that_is_checked():
    plain = [
        f"{file.relative_to(ROOT)}: {line}"
        for file in sorted((ROOT / "dt3d").rglob("*.py"))
        for line in file.read_text().splitlines()
        if re.match(r"\s*@(numba\.)?njit\b.*cache=True", line)
    ]
    assert not plain, "use @cached_njit of dt3d/_numba/kernel_cache.py"
