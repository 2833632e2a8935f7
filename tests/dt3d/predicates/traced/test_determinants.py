"""Exact signs of arrays of cases in JAX against Python integers; ties against infinitesimal heights."""

import jax
import numpy as np
import pytest

from dt3d.predicates.traced import determinants
from dt3d.predicates.traced.digits import limbs_of

from ..oracle import DIMENSION, POINTS, inside_perturbed, sign
from ..simplices import simplices


def as_cases(points):
    """The digits int32 (L, k, d, n) of cases float64 (n, k, d)."""
    n, k, d = points.shape
    limbs = limbs_of(points.reshape(-1, d))
    return np.moveaxis(limbs.reshape(len(limbs), n, k, d), 1, -1)


@pytest.mark.parametrize("predicate", list(POINTS))
def test_signs(predicate):
    cases = np.random.default_rng(0).integers(-2, 3, (60, POINTS[predicate], DIMENSION[predicate])) * 0.5
    with jax.enable_x64(True):
        got = np.asarray(getattr(determinants, predicate)(as_cases(cases)))
    assert got.tolist() == [sign(predicate, case) for case in cases]


def test_ties():
    points, rows = simplices(3, 3, 200)
    with jax.enable_x64(True):
        got = np.asarray(determinants.inside(as_cases(points[rows]), rows.T))
    assert got.tolist() == [inside_perturbed(points[row], row) for row in rows]
