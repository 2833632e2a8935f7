"""Determinants of a simplex's sides with pairs of doubles."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from functools import partial

from .._numba.cores import available_cores
from .._numba.kernel_cache import cached_njit
from .._numba.threads import run_short_tasks
from ..predicates import double_double as dd

# A determinant of pairs is relied on if its magnitude is above this part of the product of the extents: with
# the bounds of `dt3d.predicates` for pairs, 160 * 2^-106, the relative error is then below 2^-53.
RELIABLE = 2.0**-45
LEAST_ROWS = 2048  # worth a thread


@cached_njit
def shrinking(points, row, origin):
    """A power of two that takes the differences of points[row[k]] and the origin below 1."""
    m = 0.0
    for v in row:
        for i in range(points.shape[1]):
            m = max(m, abs(points[v, i] - origin[i]))
    return math.ldexp(1.0, -math.frexp(m)[1])


@cached_njit
def side(point, origin, i, shrink):
    """Coordinate i of point - origin, times a power of two, as a pair; exact."""
    s, r = dd.two_sum(point[i], -origin[i])
    return s * shrink, r * shrink


@cached_njit
def sides_in_plane(point, origin, shrink):
    """The vector from origin to point in the plane, as pairs."""
    return side(point, origin, 0, shrink), side(point, origin, 1, shrink)


@cached_njit
def sides_in_space(point, origin, shrink):
    """The vector from origin to point in space, as pairs."""
    return side(point, origin, 0, shrink), side(point, origin, 1, shrink), side(point, origin, 2, shrink)


@cached_njit
def cross(p, q):
    """The cross product of two vectors of pairs in space."""
    return (
        dd.subtract(dd.multiply(p[1], q[2]), dd.multiply(p[2], q[1])),
        dd.subtract(dd.multiply(p[2], q[0]), dd.multiply(p[0], q[2])),
        dd.subtract(dd.multiply(p[0], q[1]), dd.multiply(p[1], q[0])),
    )


@cached_njit
def dot(p, q):
    """The scalar product of two vectors of pairs in space."""
    return dd.add(dd.add(dd.multiply(p[0], q[0]), dd.multiply(p[1], q[1])), dd.multiply(p[2], q[2]))


@cached_njit
def extent(vectors, i):
    """The greatest magnitude of coordinate i."""
    m = 0.0
    for v in vectors:
        m = max(m, abs(v[i][0]))
    return m


def in_pieces(work: Callable[[int, int], object], n: int, least: int = LEAST_ROWS) -> None:
    """Call work(begin, end) for pieces of n rows, by threads where there are ``least`` rows for each."""
    pieces = max(1, min(available_cores(), n // least))
    bounds = [n * k // pieces for k in range(pieces + 1)]
    run_short_tasks([partial(work, begin, end) for begin, end in itertools.pairwise(bounds)])
