"""Areas of triangles and volumes of tetrahedra."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from .._input import exactly_scaled
from .._numba.kernel_cache import cached_njit
from ..predicates import double_double as dd
from .pairs import RELIABLE, cross, dot, extent, in_pieces, shrinking, sides_in_plane, sides_in_space


@cached_njit(nogil=True)
def _measures(points, simplices, begin, end, out):
    """Write the determinants of the sides over d!, NaN where pairs leave them open."""
    for t in range(begin, end):
        row = simplices[t]
        origin = points[row[0]]
        shrink = shrinking(points, row, origin)
        if points.shape[1] == 2:
            p = sides_in_plane(points[row[1]], origin, shrink)
            q = sides_in_plane(points[row[2]], origin, shrink)
            det = dd.minor(p, q)[0]
            product = extent((p, q), 0) * extent((p, q), 1)
            out[t] = det / shrink / shrink / 2.0
        else:
            u = sides_in_space(points[row[1]], origin, shrink)
            v = sides_in_space(points[row[2]], origin, shrink)
            w = sides_in_space(points[row[3]], origin, shrink)
            det = dot(cross(u, v), w)[0]
            product = extent((u, v, w), 0) * extent((u, v, w), 1) * extent((u, v, w), 2)
            out[t] = det / shrink / shrink / shrink / 6.0
        if not abs(det) > RELIABLE * product:
            out[t] = np.nan


def measures(points: np.ndarray, simplices: np.ndarray) -> np.ndarray:
    """The signed area or volume of each simplex, float64 (m,): det[b - a, c - a, ...] / d!.

    Correct but for some units in the last place, with the right sign, unless it underflows.

    Parameters
    ----------
    points : float64 (n, d)
        Finite; d is 2 or 3.
    simplices : int32 (m, d + 1)
        Rows of points.
    """
    sites, unit = scaled_sites(points)
    out = np.empty(len(simplices))
    in_pieces(lambda begin, end: _measures(sites, simplices, begin, end, out), len(simplices))
    d = points.shape[1]
    for t in np.flatnonzero(np.isnan(out)):
        out[t] = as_float(determinant(fractions(sites[simplices[t]])) / math.factorial(d))
    with np.errstate(over="ignore", under="ignore"):
        for _ in range(
            d
        ):  # one power after the other, as all together may overflow where the result does not
            out *= unit
    return out


def scaled_sites(points: np.ndarray) -> tuple[np.ndarray, float]:
    """Points over a power of two, and this power; the greatest magnitude of the former is about 1.

    The points themselves and 1 where that is not exact.
    """
    sites = exactly_scaled(points)
    at = np.unravel_index(np.argmax(np.abs(points)), points.shape)
    return sites, float(points[at] / sites[at]) if sites[at] else 1.0


def fractions(corners: np.ndarray) -> list[list[Fraction]]:
    """The differences of corners (d + 1, d) from the first, exactly."""
    origin, *others = [[Fraction(x) for x in row] for row in corners.tolist()]
    return [[x - y for x, y in zip(row, origin, strict=True)] for row in others]


def determinant(rows: list[list[Fraction]]) -> Fraction:
    """Of a 2 x 2 or 3 x 3 matrix."""
    if len(rows) == 2:
        (a, b), (c, d) = rows
        return a * d - b * c
    u, v, w = rows
    return sum((x * y for x, y in zip(cross_product(u, v), w, strict=True)), Fraction(0))


def cross_product(u: list[Fraction], v: list[Fraction]) -> list[Fraction]:
    """Of two vectors in space."""
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def as_float(x: Fraction) -> float:
    """The nearest float64; infinite where it is too great."""
    try:
        return float(x)
    except OverflowError:
        return math.inf if x > 0 else -math.inf
