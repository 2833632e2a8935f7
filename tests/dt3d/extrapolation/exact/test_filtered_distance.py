"""Bounds of signed distances, against integers."""

import numpy as np
import pytest

import scanvec as sv
from dt3d.extrapolation.exact.expansion import FILTERED, open_face
from dt3d.extrapolation.faces import Face

from ...exact import integers, orient
from .modes import MACHINE, SETS, exact_sites, lexicographic


def signed_distances(points, a, b, c, d):
    """Numerator and denominator of s(d), times |N|^2, in Python integers; arrays over d."""
    p = integers(points)
    u, v, w = p[b] - p[a], p[c] - p[a], p[d] - p[a]
    normal = np.cross(u, v)
    area = normal @ normal
    centre = np.cross((u @ u) * v - (v @ v) * u, normal)  # 2 |N|^2 o
    return (w * (w * area - centre)).sum(axis=-1), (w @ normal) * area


@pytest.mark.parametrize("name", SETS)
def test_bounds_hold_the_signed_distance(name):
    """Every certain comparison of two sites above a face is right in exact arithmetic."""
    points = lexicographic(SETS[name])
    exact = exact_sites(points)
    n = len(points)
    rng = np.random.default_rng(1)
    faces = np.array([rng.permutation(n)[:3] for _ in range(40)], np.int32)
    rank = exact.rank.to_numpy()
    index = np.argsort(rank).astype(np.int32)  # where each row of `points` went
    compared = 0
    for a, b, c in faces:
        face = Face(*(MACHINE.vector(np.full(n, index[v], np.int32)) for v in (a, b, c)))
        corners = (sv.get(exact.buckets.sites, v) for v in face)
        query = MACHINE.map(open_face, face, *corners, exact.lattice)
        bounds = MACHINE.map(FILTERED.score, query, exact.buckets.sites, MACHINE.iota(n))
        low, high = (v.to_numpy() for v in bounds)
        others = np.setdiff1d(np.arange(n), [a, b, c])
        p = integers(points)
        sign = orient(p[a], p[b], p[c], p[others])
        low, high = low[index[others]], high[index[others]]
        above = sign > 0
        assert np.isinf(high[~above]).all()
        top, bottom = signed_distances(points, a, b, c, others[above])
        low, high = low[above], high[above]
        # s_i = top_i / bottom_i, bottom > 0: certain order of the bounds must be that of the fractions
        certain = high[:, None] < low
        wrong = (top[:, None] * bottom >= top * bottom[:, None]).astype(bool)
        assert not (certain & wrong).any()
        compared += certain.sum()
    assert compared > (0 if name == "an ulp" else 1000)
