"""The compiled execution finds what insertion and a simulated machine do."""

import numpy as np
import pytest

import dt3d
import scanvec as sv
from dt3d.extrapolation.compiled import tables

from ...families import LARGE, tetrahedra
from .steps import assert_equal_to_insertion, compiled, random_set


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


@pytest.mark.slow
def test_a_simulated_machine_gives_equal_arrays():
    points = random_set(2500)
    ours = dt3d.Delaunay(points, machine=sv.Device())
    theirs = dt3d.Delaunay(points, machine=sv.Simulated(processors=8))
    np.testing.assert_array_equal(ours.simplices, theirs.simplices)
    np.testing.assert_array_equal(ours.neighbors, theirs.neighbors)


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
