"""Centers and radii of circumscribed circles and spheres."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from .._numba.kernel_cache import cached_njit
from ..predicates import double_double as dd
from .measures import as_float, cross_product, determinant, fractions, scaled_sites
from .pairs import RELIABLE, cross, dot, extent, in_pieces, shrinking, sides_in_plane, sides_in_space


@cached_njit(nogil=True)
def _circumcenters(points, simplices, begin, end, base, centers, radii):
    """Write centers from the first vertex plus ``base`` times it, and radii, NaN where pairs leave them open.

    From the first vertex the center is (|p|^2 q' - |q|^2 p') / (2 p x q) in the plane, where (x, y)' is
    (y, -x), and (|u|^2 v x w + |v|^2 w x u + |w|^2 u x v) / (2 u . v x w) in space.
    """
    for t in range(begin, end):
        row = simplices[t]
        origin = points[row[0]]
        shrink = shrinking(points, row, origin)
        squares = 0.0
        if points.shape[1] == 2:
            p = sides_in_plane(points[row[1]], origin, shrink)
            q = sides_in_plane(points[row[2]], origin, shrink)
            det = dd.minor(p, q)
            if not abs(det[0]) > RELIABLE * (extent((p, q), 0) * extent((p, q), 1)):
                radii[t] = np.nan
                continue
            pp, qq = dd.square(p), dd.square(q)
            for i in range(2):
                j, sign = 1 - i, 1.0 - 2.0 * i
                c = dd.subtract(dd.multiply(pp, q[j]), dd.multiply(qq, p[j]))
                x = sign * (c[0] / det[0]) / 2.0
                squares += x * x
                centers[t, i] = base * origin[i] + x / shrink
        else:
            u = sides_in_space(points[row[1]], origin, shrink)
            v = sides_in_space(points[row[2]], origin, shrink)
            w = sides_in_space(points[row[3]], origin, shrink)
            vw, wu, uv = cross(v, w), cross(w, u), cross(u, v)
            det = dot(u, vw)
            product = extent((u, v, w), 0) * extent((u, v, w), 1) * extent((u, v, w), 2)
            if not abs(det[0]) > RELIABLE * product:
                radii[t] = np.nan
                continue
            uu, vv, ww = dd.square(u), dd.square(v), dd.square(w)
            for i in range(3):
                c = dd.add(dd.add(dd.multiply(uu, vw[i]), dd.multiply(vv, wu[i])), dd.multiply(ww, uv[i]))
                x = (c[0] / det[0]) / 2.0
                squares += x * x
                centers[t, i] = base * origin[i] + x / shrink
        radii[t] = math.sqrt(squares) / shrink


def circumcenters(points: np.ndarray, simplices: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The center and the radius of the circumscribed sphere of each simplex: float64 (m, d) and (m,).

    Relative to the radius the center is right but for some units in the last place, slivers included; the
    coordinates are rounded besides. Infinite where they are too great for float64.

    Parameters
    ----------
    points : float64 (n, d)
        Finite; d is 2 or 3.
    simplices : int32 (m, d + 1)
        Rows of points. A flat simplex has a NaN center and an infinite radius.
    """
    sites, unit = scaled_sites(points)
    m, d = len(simplices), points.shape[1]
    centers, radii = np.empty((m, d)), np.empty(m)
    in_pieces(lambda begin, end: _circumcenters(sites, simplices, begin, end, 1.0, centers, radii), m)
    for t in np.flatnonzero(np.isnan(radii)):
        centers[t], radii[t] = _by_fractions(sites[simplices[t]])
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        centers *= unit
        radii *= unit
    return centers, radii


def offsets_of_centers(points: np.ndarray, simplices: np.ndarray) -> np.ndarray:
    """The center of each simplex's sphere less its first vertex, float64 (m, d).

    They are not rounded as coordinates are. The points are scaled already, and none of the simplices is flat.
    """
    m, d = len(simplices), points.shape[1]
    offsets, radii = np.empty((m, d)), np.empty(m)
    in_pieces(lambda begin, end: _circumcenters(points, simplices, begin, end, 0.0, offsets, radii), m)
    for t in np.flatnonzero(np.isnan(radii)):
        offsets[t] = _by_fractions(points[simplices[t]], 0)[0]
    return offsets


def _by_fractions(corners: np.ndarray, base: int = 1) -> tuple[list[float], float]:
    """The center, plus ``base`` times the first vertex, and the radius of one simplex, from exact numbers."""
    sides = fractions(corners)
    squares = [sum((x * x for x in side), Fraction(0)) for side in sides]
    det = determinant(sides)
    if det == 0:  # in a mesh of others
        return [math.nan] * len(sides), math.inf
    if len(sides) == 2:
        p, q = sides
        normals = [[q[1], -q[0]], [-p[1], p[0]]]
    else:
        u, v, w = sides
        normals = [cross_product(v, w), cross_product(w, u), cross_product(u, v)]
    from_first = [
        sum((s * normal[i] for s, normal in zip(squares, normals, strict=True)), Fraction(0)) / (2 * det)
        for i in range(len(sides))
    ]
    center = [as_float(base * Fraction(x) + y) for x, y in zip(corners[0].tolist(), from_first, strict=True)]
    square = sum((x * x for x in from_first), Fraction(0))
    # the root of a fraction whose numerator and denominator are beyond float64
    half = (square.numerator.bit_length() - square.denominator.bit_length()) // 2
    root = math.sqrt(square / Fraction(4) ** half)
    return center, math.ldexp(root, half) if half < 1024 else math.inf
