"""Points against NumPy."""

import jax
import jax.numpy as jnp
import numpy as np

from dt3d.extrapolation import points
from dt3d.extrapolation.points import Point


def test_products_are_those_of_numpy():
    p, q, r = np.random.default_rng(0).random((3, 3))
    with jax.enable_x64(True):
        a, b, c = (Point(*map(jnp.float64, x)) for x in (p, q, r))
        np.testing.assert_allclose(points.cross(a, b), np.cross(p, q))
        np.testing.assert_allclose(points.dot(a, b), p @ q)
        np.testing.assert_allclose(points.norm(points.sub(a, b)), np.linalg.norm(p - q))
        np.testing.assert_allclose(points.add(a, points.scale(2.0, b)), p + 2 * q)
        low, high = points.bounding_box(a, b, c)
        np.testing.assert_array_equal(low, np.min([p, q, r], axis=0))
        np.testing.assert_array_equal(high, np.max([p, q, r], axis=0))
        assert points.epsilon(a.x) == 2.0**-53
