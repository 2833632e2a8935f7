"""The compiled steps for a device: the same triangulation as insertion's, and as a simulated machine's."""

import jax
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import dt3d
import scanvec as sv
from dt3d._input import exactly_scaled, first_copies
from dt3d.extrapolation.compiled import loop, stages, tables
from dt3d.extrapolation.compiled.windows import cells_of, grid_of, windows_of
from dt3d.extrapolation.exact.canonical import canonical, in_canonical_order
from dt3d.verification import verify

from ..families import LARGE, body_centred, box, grid, jittered, random_integers, tetrahedra


def random_set(n):
    return np.random.default_rng(n).random((n, 3))


def compiled(points, **sizes):
    """What the compiled steps alone make of a set, as the public class would have it, and the run."""
    used, _ = first_copies(points)
    with jax.enable_x64(True):
        run = loop.Loop(sv.Device(), exactly_scaled(points[used]), **sizes)
        found = in_canonical_order(run.run(None))
    found.simplices = used[found.simplices].astype(np.int32)
    return found, run


def assert_equal_to_insertion(points, found):
    want = dt3d.Delaunay(points, method="insertion")
    found.points = points
    np.testing.assert_array_equal(tetrahedra(found), tetrahedra(want))
    report = verify(
        points, found.simplices, neighbors=found.neighbors, duplicates=want.duplicates, perturbed=True
    )
    assert report, report


def test_uniform_sites():
    points = random_set(3000)
    tri = dt3d.Delaunay(points, machine=sv.Device())
    want = dt3d.Delaunay(points, method="insertion")
    np.testing.assert_array_equal(tetrahedra(tri), tetrahedra(want))
    assert tri.verify(), tri.verify()
    assert sum(tri.stats.tetrahedra_per_iteration) == len(tri.simplices)
    np.testing.assert_array_equal(
        np.bincount(tri.iteration, minlength=tri.stats.iterations + 1)[1:], tri.stats.tetrahedra_per_iteration
    )


def test_a_simulated_machine_gives_equal_arrays():
    points = random_set(2500)
    ours = dt3d.Delaunay(points, machine=sv.Device())
    theirs = dt3d.Delaunay(points, machine=sv.Simulated(processors=8))
    np.testing.assert_array_equal(ours.simplices, theirs.simplices)
    np.testing.assert_array_equal(ours.neighbors, theirs.neighbors)


TIED = {
    "grid": grid(9),
    "slab": box(20, 20, 3),
    "body-centred lattice": body_centred(7),
    "tenths": grid(9) * 0.1,
    "jitter 1e-15": jittered(9, 1e-15),
    "random integers": random_integers(2000, 12),
}


@pytest.mark.parametrize(
    "name", ["grid", *(pytest.param(name, marks=pytest.mark.slow) for name in list(TIED)[1:])]
)
def test_sets_with_ties(name):
    found, run = compiled(TIED[name])
    assert_equal_to_insertion(TIED[name], found)
    assert found.counts.exact_decisions > 0


@pytest.mark.slow
@pytest.mark.parametrize("name", [n for n, p in LARGE.items() if len(p) > tables.FEWEST_SITES])
def test_large_families(name):
    tri = dt3d.Delaunay(LARGE[name], machine=sv.Device())
    want = dt3d.Delaunay(LARGE[name], method="insertion")
    np.testing.assert_array_equal(tetrahedra(tri), tetrahedra(want))


def test_capacities_grow():
    points = random_set(2100)
    found, run = compiled(points, tetrahedra_per_site=1)
    assert_equal_to_insertion(points, found)
    assert len(run.mesh.corners) > 4 * run.layout.capacity


def test_faces_that_no_other_stage_settles_go_to_the_vectors(monkeypatch):
    monkeypatch.setitem(stages.WIDER_STAGE, stages.Stage.WINDOW, stages.Stage.VECTORS)
    points = random_set(2000)
    found, run = compiled(points)
    assert_equal_to_insertion(points, found)
    assert found.counts.exact_decisions > 0


def test_windows_hold_the_sites_of_their_cells():
    sites = random_set(500) * [1, 2, 0.1]
    cells = grid_of(sites, 1.5)
    windows = windows_of(sites, cells, 512)
    number = cells_of(sites, cells)
    i, j, k = number % cells.nx, number // cells.nx % cells.ny, number // (cells.nx * cells.ny)
    for z, y, x in np.ndindex(windows.nz, windows.ny, windows.nx):
        w = x + windows.nx * (y + windows.ny * z)
        members = windows.members[windows.starts[w] : windows.starts[w + 1]]
        inside = (abs(i - x - 1) <= 1) & (abs(j - y - 1) <= 1) & (abs(k - z - 1) <= 1)
        np.testing.assert_array_equal(np.sort(members), np.flatnonzero(inside))


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1), st.sampled_from([6, 2**23]))
def test_canonical_order_does_not_depend_on_the_order_found(seed, most):
    """Tetrahedra of a real triangulation, numbered and turned at random."""
    rng = np.random.default_rng(seed)
    tri = dt3d.Delaunay(rng.random((8, 3)), method="insertion")
    names = np.sort(rng.choice(max(most, 8), 8, replace=False)).astype(np.int32)
    first = canonical(names[tri.simplices], tri.neighbors, tri.iteration)
    m = len(tri.simplices)
    order = rng.permutation(m)
    place = np.append(np.argsort(order), -1)
    turns = np.array([[0, 1, 2, 3], [1, 2, 0, 3], [3, 2, 1, 0], [1, 0, 3, 2], [2, 0, 1, 3]])[
        rng.integers(5, size=m)
    ]
    simplices = np.take_along_axis(names[tri.simplices][order], turns, 1)
    neighbors = np.take_along_axis(place[tri.neighbors][order], turns, 1)
    again = canonical(simplices, neighbors, tri.iteration[order])
    for x, y in zip(first, again, strict=True):
        np.testing.assert_array_equal(x, y)
