"""Many cases at once, in blocks."""

import jax
import numpy as np
import pytest

from dt3d.predicates import in_sphere
from dt3d.predicates.traced import mapped, one_case
from dt3d.predicates.traced.digits import limbs_of

from ..simplices import simplices
from .points import as_points


def test_long_arrays_go_in_blocks():
    points, rows = simplices(3, 4, 300)
    many = np.concatenate([rows] * 40)  # more than a block, and not a multiple of one
    sites = as_points(limbs_of(points), many, np.asarray)
    with jax.enable_x64(True):
        got = np.asarray(jax.jit(jax.vmap(one_case.in_sphere))(*sites))
    want = in_sphere(*(points[rows[:, k]] for k in range(5)))
    np.testing.assert_array_equal(got, np.tile(want, 40))


@pytest.mark.parametrize("count", [0, 1, 5])
def test_any_number_of_cases_has_as_many_signs(count):
    cases = np.tile(np.array([[0.0, 0], [1, 0], [0, 1]]), (count, 1, 1))
    signs = mapped.signs("orient2d", cases)
    assert signs.dtype == np.int8
    assert signs.tolist() == [1] * count
