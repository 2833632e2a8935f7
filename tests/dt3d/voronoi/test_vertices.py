"""Circumcenters of simplices of every shape, beside rational numbers."""

import numpy as np
import pytest

import dt3d
from dt3d.geometry.circumcenters import circumcenters

from .oracle import Fraction, dot, minus, solve

RNG = np.random.default_rng(3)


def exact(corners):
    first, *others = [tuple(map(Fraction, c)) for c in corners.tolist()]
    edges = [minus(c, first) for c in others]
    return [x + y for x, y in zip(first, solve(edges, [dot(e, e) / 2 for e in edges]), strict=True)]


def lattice(k, d):
    return np.stack(np.meshgrid(*[np.arange(float(k))] * d, indexing="ij"), -1).reshape(-1, d)


SETS = {
    "uniform": lambda d: RNG.random((500, d)),
    "offset": lambda d: RNG.random((500, d)) + 1e6,
    "small": lambda d: RNG.random((300, d)) * 1e-150,
    "large": lambda d: RNG.random((300, d)) * 1e150,
    "cluster": lambda d: np.concatenate([RNG.random((50, d)), 0.3 + 1e-8 * RNG.random((200, d))]),
    "tiny cluster": lambda d: np.concatenate([RNG.random((50, d)), 1e-160 * RNG.random((50, d))]),
    "noisy lattice": lambda d: lattice(5, d) + 1e-15 * RNG.normal(size=(5**d, d)),
    "turned lattice": lambda d: lattice(5, d) @ np.linalg.qr(RNG.normal(size=(d, d)))[0],
    "flat": lambda d: RNG.random((300, d)) * [1, 1e-9, 1][:d],
    "all exponents": lambda d: RNG.random((100, d)) * 10.0 ** -RNG.integers(0, 300, (100, d)),
}


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("name", SETS)
def test_they_are_right_to_a_few_units_in_the_last_place(name, d):
    tri = dt3d.Delaunay(SETS[name](d))
    found, radii = circumcenters(tri.points, tri.simplices)
    for t in RNG.choice(len(found), min(len(found), 150), replace=False):
        corners = tri.points[tri.simplices[t]]
        center = exact(corners)
        scale = max(*map(abs, center), Fraction(1, 10**300))
        if scale > 10**308:
            assert np.isinf(found[t]).any()
            continue
        square = sum((x - Fraction(y)) ** 2 for x, y in zip(center, corners[0].tolist(), strict=True))
        assert abs(Fraction(radii[t]) ** 2 - square) <= Fraction(1e-12) * square
        off = max(abs(Fraction(x) - y) for x, y in zip(found[t].tolist(), center, strict=True))
        assert off <= 1e-14 * scale
