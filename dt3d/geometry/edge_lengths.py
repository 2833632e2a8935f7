"""The longest edge of each simplex."""

from __future__ import annotations

import math

import numpy as np

from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from .measures import scaled_sites
from .pairs import in_pieces

LEAST_SQUARE = 2.0**-900  # squares of shorter edges may underflow


@cached_njit(nogil=True)
def _longest(points, simplices, begin, end, out):
    """Write the length of the longest edge of each simplex; coordinates are 1 at most."""
    points, simplices = unowned(points), unowned(simplices)
    corners, d = simplices.shape[1], points.shape[1]
    for t in range(begin, end):
        longest = 0.0
        for i in range(corners):
            for j in range(i):
                a, b = simplices[t, i], simplices[t, j]
                square = 0.0
                for k in range(d):
                    difference = points[a, k] - points[b, k]
                    square += difference * difference
                longest = max(longest, square)
        if longest >= LEAST_SQUARE:
            out[t] = math.sqrt(longest)
            continue
        length = 0.0
        for i in range(corners):
            for j in range(i):
                a, b = simplices[t, i], simplices[t, j]
                edge = 0.0
                for k in range(d):
                    edge = math.hypot(edge, points[a, k] - points[b, k])
                length = max(length, edge)
        out[t] = length


def longest_edges(points: np.ndarray, simplices: np.ndarray) -> np.ndarray:
    """The length of the longest edge of each simplex, float64 (m,).

    Parameters
    ----------
    points : float64 (n, d)
        Finite.
    simplices : int32 (m, d + 1)
        Rows of points.
    """
    if not len(simplices):
        return np.zeros(0)
    sites, unit = scaled_sites(points)
    out = np.empty(len(simplices))
    in_pieces(lambda begin, end: _longest(sites, simplices, begin, end, out), len(simplices))
    with np.errstate(over="ignore", under="ignore"):
        out *= unit
    return out
