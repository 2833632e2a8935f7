"""Centers and radii of circumscribed circles and spheres.

By doubles for tetrahedra that are well shaped, by pairs of doubles for others and for triangles, and by
fractions for the few that are flatter than pairs can tell.
"""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from ..predicates import double_double as dd
from .measures import as_float, cross_product, determinant, fractions, scaled_sites
from .pairs import cross, dot, extent, in_pieces, shrinking, sides_in_plane, sides_in_space

# With the longest difference of about 1 a component of the numerator is at most 18, after 16 roundings, and
# the determinant at most 6 times the product of the extents. A rounding is at most 2^-53, or 5 * 2^-106 in
# pairs. If the determinant is above this part of that product, and it or the numerator is above this, the
# center is off by less than 2^-36 of the radius or the longest side, whichever is greater; as a rule by some
# 2^-50.
BY_DOUBLES = 2.0**-4
BY_PAIRS = 2.0**-60
LEAST = 2.0**-900  # product of extents that does not underflow


@cached_njit
def _by_doubles(points, row, base, center):
    """Write the center of a tetrahedron's sphere; its radius, or NaN where doubles cannot be relied on."""
    o, u, v, w = row[0], row[1], row[2], row[3]
    x, y, z = points[o, 0], points[o, 1], points[o, 2]
    ux, uy, uz = points[u, 0] - x, points[u, 1] - y, points[u, 2] - z
    vx, vy, vz = points[v, 0] - x, points[v, 1] - y, points[v, 2] - z
    wx, wy, wz = points[w, 0] - x, points[w, 1] - y, points[w, 2] - z
    mx, my = max(abs(ux), abs(vx), abs(wx)), max(abs(uy), abs(vy), abs(wy))
    mz = max(abs(uz), abs(vz), abs(wz))
    f = math.ldexp(1.0, min(-math.frexp(max(mx, my, mz))[1], 1000))
    ux, uy, uz, vx, vy, vz = ux * f, uy * f, uz * f, vx * f, vy * f, vz * f
    wx, wy, wz, product = wx * f, wy * f, wz * f, (mx * f) * (my * f) * (mz * f)
    px, py, pz = vy * wz - vz * wy, vz * wx - vx * wz, vx * wy - vy * wx
    qx, qy, qz = wy * uz - wz * uy, wz * ux - wx * uz, wx * uy - wy * ux
    rx, ry, rz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    uu, vv, ww = ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz, wx * wx + wy * wy + wz * wz
    cx, cy, cz = uu * px + vv * qx + ww * rx, uu * py + vv * qy + ww * ry, uu * pz + vv * qz + ww * rz
    det = ux * px + uy * py + uz * pz
    if not _reliable(det, product, max(abs(cx), abs(cy), abs(cz)), BY_DOUBLES):
        return math.nan
    half = 0.5 / det
    cx, cy, cz = cx * half, cy * half, cz * half
    center[0], center[1], center[2] = base * x + cx / f, base * y + cy / f, base * z + cz / f
    square = cx * cx + cy * cy + cz * cz
    return (math.sqrt(square) if square < 1e300 else math.hypot(math.hypot(cx, cy), cz)) / f


@cached_njit
def _reliable(det, product, numerator, part):
    """Whether both are great enough to be relied on."""
    return abs(det) > part * max(product, LEAST) and max(numerator, abs(det)) > part


@cached_njit(nogil=True)
def _circumcenters(points, simplices, begin, end, base, centers, radii):
    """Write centers from the first vertex plus ``base`` times it, and radii, NaN where pairs leave them open.

    From the first vertex the center is (|p|^2 q' - |q|^2 p') / (2 p x q) in the plane, where (x, y)' is
    (y, -x), and (|u|^2 v x w + |v|^2 w x u + |w|^2 u x v) / (2 u . v x w) in space.
    """
    points, simplices = unowned(points), unowned(simplices)
    for t in range(begin, end):
        row, center = simplices[t], centers[t]
        if points.shape[1] == 3:
            radii[t] = _by_doubles(points, row, base, center)
            if not math.isnan(radii[t]):
                continue
        origin = points[row[0]]
        shrink = shrinking(points, row, origin)
        greatest = radius = 0.0
        if points.shape[1] == 2:
            p = sides_in_plane(points[row[1]], origin, shrink)
            q = sides_in_plane(points[row[2]], origin, shrink)
            det = dd.minor(p, q)[0]
            pp, qq = dd.square(p), dd.square(q)
            product = extent((p, q), 0) * extent((p, q), 1)
            center[0] = dd.subtract(dd.multiply(pp, q[1]), dd.multiply(qq, p[1]))[0]
            center[1] = dd.subtract(dd.multiply(qq, p[0]), dd.multiply(pp, q[0]))[0]
        else:
            u = sides_in_space(points[row[1]], origin, shrink)
            v = sides_in_space(points[row[2]], origin, shrink)
            w = sides_in_space(points[row[3]], origin, shrink)
            vw, wu, uv = cross(v, w), cross(w, u), cross(u, v)
            det = dot(u, vw)[0]
            product = extent((u, v, w), 0) * extent((u, v, w), 1) * extent((u, v, w), 2)
            uu, vv, ww = dd.square(u), dd.square(v), dd.square(w)
            for i in range(3):
                c = dd.add(dd.multiply(uu, vw[i]), dd.multiply(vv, wu[i]))
                center[i] = dd.add(c, dd.multiply(ww, uv[i]))[0]
        for i in range(len(center)):
            greatest = max(greatest, abs(center[i]))
        if not _reliable(det, product, greatest, BY_PAIRS):
            radii[t] = math.nan
            continue
        for i in range(len(center)):
            x = center[i] / det / 2.0
            radius = math.hypot(radius, x)
            center[i] = base * origin[i] + x / shrink
        radii[t] = radius / shrink


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
