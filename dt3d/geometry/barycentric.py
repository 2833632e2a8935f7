"""Barycentric weights of points in simplices."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from .._numba.kernel_cache import cached_njit
from ..predicates import double_double as dd
from .measures import as_float, determinant, fractions, scaled_sites
from .pairs import RELIABLE, cross, dot, extent, in_pieces, shrinking, sides_in_plane, sides_in_space

# A determinant of doubles is relied on if it is above this part of the product of the extents: its relative
# error is then below 49 * 2^-53 * 2^10 (see `dt3d.predicates.space`).
WELL_SHAPED = 2.0**-10


@cached_njit
def plain_weights(points, row, x, out):
    """Write the weights of x by doubles; whether they can be relied on, for a simplex that is no sliver.

    Weights are the parts of the simplex opposite its vertices, over their sum.
    """
    if points.shape[1] == 2:
        ax, ay = points[row[0], 0] - x[0], points[row[0], 1] - x[1]
        bx, by = points[row[1], 0] - x[0], points[row[1], 1] - x[1]
        cx, cy = points[row[2], 0] - x[0], points[row[2], 1] - x[1]
        out[0], out[1], out[2] = bx * cy - cx * by, cx * ay - ax * cy, ax * by - bx * ay
        total = out[0] + out[1] + out[2]
        product = max(abs(ax), abs(bx), abs(cx)) * max(abs(ay), abs(by), abs(cy))
    else:
        ax, ay, az = points[row[0], 0] - x[0], points[row[0], 1] - x[1], points[row[0], 2] - x[2]
        bx, by, bz = points[row[1], 0] - x[0], points[row[1], 1] - x[1], points[row[1], 2] - x[2]
        cx, cy, cz = points[row[2], 0] - x[0], points[row[2], 1] - x[1], points[row[2], 2] - x[2]
        dx, dy, dz = points[row[3], 0] - x[0], points[row[3], 1] - x[1], points[row[3], 2] - x[2]
        abx, aby, abz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        cdx, cdy, cdz = cy * dz - cz * dy, cz * dx - cx * dz, cx * dy - cy * dx
        out[0] = bx * cdx + by * cdy + bz * cdz
        out[1] = -(ax * cdx + ay * cdy + az * cdz)
        out[2] = dx * abx + dy * aby + dz * abz
        out[3] = -(cx * abx + cy * aby + cz * abz)
        total = (out[0] + out[1]) + (out[2] + out[3])
        product = max(abs(ax), abs(bx), abs(cx), abs(dx)) * max(abs(ay), abs(by), abs(cy), abs(dy))
        product *= max(abs(az), abs(bz), abs(cz), abs(dz))
    if not abs(total) > WELL_SHAPED * product or product < 1e-250:
        return False
    for k in range(len(row)):
        out[k] /= total
    return True


@cached_njit
def weights_of_pairs(points, row, x, out):
    """The same by pairs of doubles, for slivers."""
    shrink = shrinking(points, row, x)
    if points.shape[1] == 2:
        p, q = sides_in_plane(points[row[0]], x, shrink), sides_in_plane(points[row[1]], x, shrink)
        r = sides_in_plane(points[row[2]], x, shrink)
        parts = (dd.minor(q, r), dd.minor(r, p), dd.minor(p, q))
        total = dd.add(dd.add(parts[0], parts[1]), parts[2])[0]
        if not abs(total) > RELIABLE * (extent((p, q, r), 0) * extent((p, q, r), 1)):
            return False
        for k in range(3):
            out[k] = parts[k][0] / total
    else:
        a, b = sides_in_space(points[row[0]], x, shrink), sides_in_space(points[row[1]], x, shrink)
        c, d = sides_in_space(points[row[2]], x, shrink), sides_in_space(points[row[3]], x, shrink)
        ab, cd = cross(a, b), cross(c, d)
        volumes = (dot(b, cd), dot(a, cd), dot(d, ab), dot(c, ab))
        total = dd.add(dd.subtract(volumes[0], volumes[1]), dd.subtract(volumes[2], volumes[3]))[0]
        product = extent((a, b, c, d), 0) * extent((a, b, c, d), 1) * extent((a, b, c, d), 2)
        if not abs(total) > RELIABLE * product:
            return False
        for k in range(4):
            out[k] = (1.0 - 2.0 * (k % 2)) * volumes[k][0] / total
    return True


@cached_njit(nogil=True)
def _weights(points, simplices, found, xi, begin, end, out):
    """Write the weights of each point in simplex found; NaN outside, infinite where pairs leave it open."""
    for i in range(begin, end):
        if found[i] < 0:
            out[i] = np.nan
            continue
        row = simplices[found[i]]
        if not plain_weights(points, row, xi[i], out[i]) and not weights_of_pairs(points, row, xi[i], out[i]):
            out[i] = np.inf


def barycentric_weights(
    points: np.ndarray, simplices: np.ndarray, found: np.ndarray, xi: np.ndarray
) -> np.ndarray:
    """The weight of each vertex of the simplex found for each point, float64 (k, d + 1); their sum is 1.

    NaN where found is negative. In simplices that contain the points, weights are not negative but for
    rounding, and accurate to some units in the last place of 1, in slivers, too.

    Parameters
    ----------
    points : float64 (n, d)
        Sites, finite.
    simplices : int32 (m, d + 1)
        None is flat.
    found : int32 (k,)
        Rows of simplices, or negative.
    xi : float64 (k, d)
        The points.
    """
    sites, unit = scaled_sites(points)
    queries = np.ascontiguousarray(xi if unit == 1.0 else xi / unit)
    out = np.empty((len(xi), points.shape[1] + 1))
    in_pieces(lambda begin, end: _weights(sites, simplices, found, queries, begin, end, out), len(xi))
    for i in np.flatnonzero(np.isinf(out).any(axis=1)):
        out[i] = _by_fractions(sites[simplices[found[i]]], queries[i])
    return out


def _by_fractions(corners: np.ndarray, x: np.ndarray) -> list[float]:
    """The weights of one point, from exact numbers: the solution by Cramer's rule."""
    whole = determinant(fractions(corners))
    weights = []
    for k in range(len(corners)):
        moved = corners.copy()
        moved[k] = x
        weights.append(determinant(fractions(moved)) / whole if whole else Fraction(0))
    return [as_float(w) for w in weights]
