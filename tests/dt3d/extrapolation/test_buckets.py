"""Buckets: sites in order, cells where they are even."""

import numpy as np
import pytest

from dt3d.extrapolation.boxes import cell_of
from dt3d.extrapolation.buckets import bucket, morton_code
from dt3d.extrapolation.points import Point

from .searching import MACHINE, RNG, SETS, in_order


@pytest.mark.parametrize("name", SETS)
def test_buckets(name, load):
    points = SETS[name]
    buckets = load(points)
    np.testing.assert_array_equal(in_order(buckets), points[buckets.origin.to_numpy()])
    assert sorted(buckets.origin.to_numpy().tolist()) == list(range(len(points)))
    if buckets.cells is None:
        return
    grid, starts, counts = buckets.cells[0], buckets.cells.starts.to_numpy(), buckets.cells.counts.to_numpy()
    assert len(counts) == grid.nx * grid.ny * grid.nz
    assert counts.sum() == len(points)
    cells = MACHINE.map(cell_of, buckets.sites, grid).to_numpy()
    for cell in np.flatnonzero(counts):
        assert (cells[starts[cell] : starts[cell] + counts[cell]] == cell).all()


def test_sites_that_fill_space_evenly_get_cells():
    sets = SETS | {
        "plane": np.c_[RNG.random((3000, 2)), np.zeros(3000)],
        "normal": RNG.standard_normal((3000, 3)),
    }
    even = {
        name: bucket(Point(*(MACHINE.vector(c.copy()) for c in points.T))).cells is not None
        for name, points in sets.items()
    }
    assert even["uniform"]
    assert even["plane"]  # the cells are squares
    assert not even["clusters"]


def test_morton_codes():
    i, j, k = (
        MACHINE.vector(np.array(v))
        for v in ([1, 0, 0, 5, 2**21 - 1], [0, 1, 0, 0, 2**21 - 1], [0, 0, 1, 0, 2**21 - 1])
    )
    assert MACHINE.map(morton_code, i, j, k).to_numpy().tolist() == [1, 2, 4, 0b1000001, 2**63 - 1]


def test_sites_with_equal_codes_get_finer_ones():
    cluster = RNG.random((200, 3)) * 2.0**-40
    points = np.concatenate([cluster, cluster + 1])
    buckets = bucket(Point(*(MACHINE.vector(c.copy()) for c in points.T)))
    ordered = in_order(buckets)
    # a curve through a cluster is far shorter than a walk in no order
    steps = np.linalg.norm(np.diff(ordered[:200], axis=0), axis=1)
    assert steps.sum() < 0.5 * np.linalg.norm(np.diff(points[:200], axis=0), axis=1).sum()
