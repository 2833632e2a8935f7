"""Circumspheres of new tetrahedra, rounded so that comparing with them proves something.

A site destroys some tetrahedra, and asks about twice as many; it makes about as many as it asks. Asking is
cheap if a tetrahedron keeps its circumsphere: one load of 32 bytes and eight operations, instead of four
vertices and an in-sphere determinant.

The bounds. Let u = 2^-53; p, q, r the vertices relative to the new site s, of length at most m, and
c = N / D the centre relative to s, with D = 2 det[p, q, r] and N = |p|^2 q x r + |q|^2 r x p + |r|^2 p x q.

* D / 2 has 6 monomials of at most m^3, each rounded at most 3 times in differences, twice in the cross
  product, once in a product, twice in sums: |error of D| <= 12 m^3 ((1+u)^8 - 1) < 98 u m^3.
* a component of N has 6 monomials of at most m^4, each rounded at most 4 times in differences, 3 times in
  the squared length, twice in the cross product, once in the product, twice in sums: error <= 6 m^4
  ((1+u)^12 - 1) < 73 u m^4, and that of the vector < 127 u m^4.
* so the computed N / D is off by at most (127 u m^4 + |c| 98 u m^3) / (|D| - 98 u m^3), where c is the
  computed one, and by 6 u |c| for the division and the length; and the centre s + c, by u (|s| + |c|) for
  its rounding.

Let e be a bound of all these, d the distance of a site from the stored centre, r the stored radius |c|.
The site is inside if d + e < r - e, outside if d - e > r + e. The constants below are larger than these
bounds, so that rounding in the bounds themselves and in m does not matter; and the squares of r - 2 e and
r + 2 e are moved by 2^-21 of themselves, which is more than rounding them to float32 (2^-24) and computing
d^2 (6 u) can do.

``reach`` is a bound of the coordinates' magnitude, 1 if they are scaled, and infinite if they cannot be.

A star has tetrahedra of positive volume only, so D is positive. What has a sphere here has been proved to be
so by the bound of D; `flat` proves it for the others.

No product under- or overflows to any effect for coordinates below 1 in magnitude and the ranges checked
here. Where a bound fails, and for ghosts, whose coordinates are NaN, nothing is proved: the interval is
(-1, inf).
"""

from __future__ import annotations

import numba
import numpy as np

from .._numba.kernel_cache import cached_njit
from ..predicates.filtered import orient3d
from .mesh import radius_above, set_center, set_radius

U = 2.0**-53
LEAST_SQUARE = 2.0**-110  # of m^2 and of what becomes a float32, which has its full precision above 2^-126
GREATEST_SQUARE = 2.0**80  # of a radius
RADIUS_MARGIN = 2.0**-21


@cached_njit(error_model="numpy", inline="always")
def round_spheres(mesh, site, scratch, facets, reach):
    """Store the spheres of the tetrahedra to the first ``facets`` facets; returns for how many nothing is
    proved."""
    p, q, r, slots = scratch.p, scratch.q, scratch.r, scratch.slots
    x, y, z, squared = scratch.x, scratch.y, scratch.z, scratch.squared
    unproved = 0
    for f in range(facets):
        i, j, k = p[f], q[f], r[f]
        px, py, pz, p2 = x[i], y[i], z[i], squared[i]
        qx, qy, qz, q2 = x[j], y[j], z[j], squared[j]
        rx, ry, rz, r2 = x[k], y[k], z[k], squared[k]
        ax, ay, az = qy * rz - qz * ry, qz * rx - qx * rz, qx * ry - qy * rx
        bx, by, bz = ry * pz - rz * py, rz * px - rx * pz, rx * py - ry * px
        cx, cy, cz = py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx
        d = 2.0 * ((px * ax + py * ay) + pz * az)
        over = 1.0 / d
        ux = ((p2 * ax + q2 * bx) + r2 * cx) * over
        uy = ((p2 * ay + q2 * by) + r2 * cy) * over
        uz = ((p2 * az + q2 * bz) + r2 * cz) * over
        u2 = ux * ux + uy * uy + uz * uz
        m2 = max(max(p2, q2), r2)
        m, radius = np.sqrt(m2), np.sqrt(u2)
        d_error = (100.0 * U) * (m2 * m)
        rest = d - d_error
        error = ((160.0 * U) * (m2 * m2) + radius * d_error) / rest + (8.0 * U) * radius + (4.0 * U) * reach
        low = max(radius - 2.0 * error, 0.0)
        high = radius + 2.0 * error
        t = numba.int64(slots[f])
        set_center(mesh, t, site.x + ux, site.y + uy, site.z + uz)
        good = (rest > d_error) & (m2 > LEAST_SQUARE) & (u2 < GREATEST_SQUARE)
        below = low * low * (1.0 - RADIUS_MARGIN) if good & (low * low > LEAST_SQUARE) else -1.0
        above = high * high * (1.0 + RADIUS_MARGIN) if good else np.inf
        set_radius(mesh, t, np.float32(below), np.float32(above))
        unproved += not good
    return unproved


@cached_njit(error_model="numpy", inline="always")
def flat(mesh, v, scratch, facets, w):
    """Whether one of these tetrahedra that have no sphere and no infinite vertex is not positive; exact."""
    vertices, found = scratch.vertices, False
    for f in range(facets):
        i, j, k = scratch.p[f], scratch.q[f], scratch.r[f]
        if radius_above(mesh, numba.int64(scratch.slots[f])) == np.inf and i > 0 and j > 0 and k > 0:
            a, b, c = numba.int64(vertices[i]), numba.int64(vertices[j]), numba.int64(vertices[k])
            if orient3d(mesh.points, v, a, b, c, w) <= 0:
                found = True
                break
    return found
