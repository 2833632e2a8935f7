"""Vectors of three numbers, or of three pairs of doubles, with the magnitudes of what their products sum.

In the plane the third component is 0. The scale is a power of two for each simplex, by which its greatest
edge component comes to about 1, so that products over- or underflow in extreme simplices only.
"""

from __future__ import annotations

import math

from .._numba.kernel_cache import cached_njit
from ..predicates import double_double as dd

COARSE = 2.0**-10  # a double this small beside its terms has lost some digits: then pairs
LEAST = 2.0**-800  # terms below which underflow counts
GREATEST_EXPONENT = 1000


@cached_njit
def edge_scale(points, simplices, t):
    """A power of two, about the greatest component of an edge at the first vertex of t."""
    greatest = 0.0
    a = simplices[t, 0]
    for k in range(1, simplices.shape[1]):
        b = simplices[t, k]
        for j in range(points.shape[1]):
            # a quarter, since the difference of the greatest doubles overflows
            greatest = max(greatest, abs(0.25 * points[b, j] - 0.25 * points[a, j]))
    exponent = math.frexp(greatest)[1] + 2
    return math.ldexp(1.0, min(max(exponent, -GREATEST_EXPONENT), GREATEST_EXPONENT))


@cached_njit
def vector_between(a, b, factor):
    """The vector from a to b, rows of coordinates, times a power of two."""
    x = factor * b[0] - factor * a[0]
    y = factor * b[1] - factor * a[1]
    z = factor * b[2] - factor * a[2] if len(a) == 3 else 0.0
    return x, y, z


@cached_njit
def vector_between_of_pairs(a, b, factor):
    """The same, exact: three pairs."""
    x = dd.two_sum(factor * b[0], -factor * a[0])
    y = dd.two_sum(factor * b[1], -factor * a[1])
    z = dd.two_sum(factor * b[2], -factor * a[2]) if len(a) == 3 else (0.0, 0.0)
    return x, y, z


@cached_njit
def dot(p, q):
    """p . q."""
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


@cached_njit
def cross(p, q):
    """p x q."""
    return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]


@cached_njit
def magnitudes(p):
    """The magnitude of each component."""
    return abs(p[0]), abs(p[1]), abs(p[2])


@cached_njit
def cross_terms(p, q):
    """The sums of the magnitudes of the terms of p x q."""
    p, q = magnitudes(p), magnitudes(q)
    return p[1] * q[2] + p[2] * q[1], p[2] * q[0] + p[0] * q[2], p[0] * q[1] + p[1] * q[0]


@cached_njit
def dot_of_pairs(p, q):
    """p . q of vectors of pairs."""
    return dd.add(dd.add(dd.multiply(p[0], q[0]), dd.multiply(p[1], q[1])), dd.multiply(p[2], q[2]))


@cached_njit
def cross_of_pairs(p, q):
    """p x q of vectors of pairs."""
    return (
        dd.minor((p[1], p[2]), (q[1], q[2])),
        dd.minor((p[2], p[0]), (q[2], q[0])),
        dd.minor((p[0], p[1]), (q[0], q[1])),
    )
