"""The box of a cap has every site that is above a face and in its sphere."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from dt3d.extrapolation.boxes import cell_coordinates
from dt3d.extrapolation.buckets import cubic_grid
from dt3d.extrapolation.caps import Plane, cap_box
from dt3d.extrapolation.points import Point, dot, sub
from dt3d.extrapolation.signed_distance import circumsphere, frame


@pytest.mark.slow
def test_sites_of_the_cap_are_in_its_box():
    rng = np.random.default_rng(0)
    sites = rng.random((400, 3))
    with jax.enable_x64(True):
        grid = cubic_grid(sites.min(axis=0).tolist(), sites.max(axis=0).tolist(), 100, np.float64)
        every = Point(*(jnp.asarray(x) for x in sites.T))
        zero = jnp.float64(0)
        for distance in (-0.2, 0.0, 0.3):
            a, b, c = (Point(*map(jnp.float64, p)) for p in rng.random((3, 3)))
            face = frame(a, b, c)
            plane = Plane(face.origin, face.normal, Point(zero, zero, zero))
            box = cap_box(plane, face.centre, jnp.float64(distance), zero, grid)
            centre, squared = circumsphere(face, jnp.float64(distance))
            offset = sub(every, centre)
            within = (dot(sub(every, a), face.normal) > 0) & (dot(offset, offset) < squared)
            i, j, k = cell_coordinates(every, grid)
            inside = (box.x0 <= i) & (i <= box.x1) & (box.y0 <= j) & (j <= box.y1)
            inside &= (box.z0 <= k) & (k <= box.z1)
            assert bool(within.any())
            assert not bool((within & ~inside).any())
