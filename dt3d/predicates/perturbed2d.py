"""stand-in"""
from __future__ import annotations

import numba

from numba.extending import intrinsic

from .filtered2d import in_circle, orient2d
from .outlined import call_outlined


@intrinsic
def _tied_slow(typingctx, points, a, b, c, d, w):
    return call_outlined(typingctx, _inside_tied, (points, a, b, c, d, w))


@numba.njit(cache=True)
def before(points, a, b):
    """Whether a comes before b in the lexicographic order of coordinates."""
    return points[a, 0] < points[b, 0] or (points[a, 0] == points[b, 0] and points[a, 1] < points[b, 1])


@numba.njit(cache=True)
def inside2d(points, a, b, c, d, w):
    sign = in_circle(points, a, b, c, d, w)
    if sign != 0:
        return sign > 0
    return _tied_slow(points, a, b, c, d, w)


@numba.njit(cache=True)
def _inside_tied(points, a, b, c, d, w):
    # of the four the first decides; no three of a circle are collinear
    first, k = d, 3
    if before(points, a, first):
        first, k = a, 0
    if before(points, b, first):
        first, k = b, 1
    if before(points, c, first):
        first, k = c, 2
    if k == 3:
        return False
    if k == 0:
        return orient2d(points, d, b, c, w) > 0
    if k == 1:
        return orient2d(points, a, d, c, w) > 0
    return orient2d(points, a, b, d, w) > 0
