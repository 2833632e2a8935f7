"""Predicates of one case inside mapped code."""

import numpy as np
import pytest

import scanvec as sv
from dt3d.predicates import space, work_array
from dt3d.predicates.traced import one_case
from dt3d.predicates.traced.digits import limbs_of

from ..simplices import simplices
from .points import as_points


def inside(vertices, ranks, site, rank):
    return one_case.inside(vertices, ranks, site, rank)


@pytest.mark.parametrize("machine", [sv.Simulated(processors=4), sv.Device()], ids=["simulated", "device"])
def test_inside_in_a_map(machine):
    points, rows = simplices(3, 4, 1500)
    w = work_array(points)
    want = [space.inside(points, tuple(row[:-1].tolist()), int(row[-1]), w) for row in rows]
    sites = as_points(limbs_of(points), rows, machine.vector)
    ranks = [machine.vector(np.ascontiguousarray(rows[:, k])) for k in range(5)]
    got = machine.map(inside, sites[:4], tuple(ranks[:4]), sites[4], ranks[4])
    assert np.asarray(got).tolist() == want


def test_64_bits_are_asked_for():
    point = ((1,), (2,))
    with pytest.raises(ValueError, match=r"use `with jax.enable_x64\(True\):`"):
        one_case.orient2d(point, point, point)
