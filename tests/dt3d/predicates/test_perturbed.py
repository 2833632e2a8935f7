"""Ties, compiled and in JAX, against heights that are as good as infinitesimal; and JAX forms when mapped."""

import jax
import numpy as np
import pytest

import scanvec as sv
from dt3d.predicates.traced import in_sphere, one_case, orient2d, orient3d, perturbed, perturbed2d, work_array
from dt3d.predicates.traced.digits import limbs_of

from .oracle import inside_perturbed


def simplices(d, side, count, seed=0):
    """A lattice in lexicographic order, and positive simplices of it with one more site, int (m, d + 2)."""
    axes = np.meshgrid(*[np.arange(side)] * d, indexing="ij")
    points = np.stack(axes, -1).reshape(-1, d).astype(float)
    rng = np.random.default_rng(seed)
    rows = np.array([rng.choice(len(points), d + 2, replace=False) for _ in range(count)])
    sign = [orient2d, orient3d][d - 2](*(points[rows[:, k]] for k in range(d + 1)))
    rows[sign < 0, :2] = rows[sign < 0, 1::-1]
    return points, rows[sign != 0]


@pytest.mark.parametrize(("d", "module"), [(2, perturbed2d), (3, perturbed)])
def test_ties_go_as_infinitesimal_heights_do(d, module):
    points, rows = simplices(d, 3, 800)
    w = work_array(points)
    order = [np.arange(len(points))] if d == 2 else []  # in space coordinates are compared
    got = [module.inside(points, *order, tuple(row[:-1].tolist()), int(row[-1]), w) for row in rows]
    assert got == [inside_perturbed(points[row], row) for row in rows]
    assert 0.2 < np.mean(got) < 0.8


def inside(vertices, ranks, site, rank):
    return one_case.inside(vertices, ranks, site, rank)


def as_points(digits, rows, vector):
    """The digits (L, n, 3) of the sites in rows (m, k), as k points of vectors."""
    return tuple(
        tuple(tuple(vector(np.ascontiguousarray(x[rows[:, k], c])) for x in digits) for c in range(3))
        for k in range(rows.shape[1])
    )


@pytest.mark.parametrize("machine", [sv.Simulated(processors=4), sv.Device()], ids=["simulated", "device"])
def test_inside_in_a_map(machine):
    points, rows = simplices(3, 4, 1500)
    w = work_array(points)
    want = [perturbed.inside(points, tuple(row[:-1].tolist()), int(row[-1]), w) for row in rows]
    sites = as_points(limbs_of(points), rows, machine.vector)
    ranks = [machine.vector(np.ascontiguousarray(rows[:, k])) for k in range(5)]
    got = machine.map(inside, sites[:4], tuple(ranks[:4]), sites[4], ranks[4])
    assert np.asarray(got).tolist() == want


def test_long_arrays_go_in_blocks():
    points, rows = simplices(3, 4, 300)
    many = np.concatenate([rows] * 40)  # more than a block, and not a multiple of one
    sites = as_points(limbs_of(points), many, np.asarray)
    with jax.enable_x64(True):
        got = np.asarray(jax.jit(jax.vmap(one_case.in_sphere))(*sites))
    want = in_sphere(*(points[rows[:, k]] for k in range(5)))
    np.testing.assert_array_equal(got, np.tile(want, 40))


def test_64_bits_are_asked_for():
    point = ((1,), (2,))
    with pytest.raises(ValueError, match=r"use `with jax.enable_x64\(True\):`"):
        one_case.orient2d(point, point, point)
