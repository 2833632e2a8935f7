"""Orientation and in-sphere: a fast sign where a bound of the error allows it, the exact one elsewhere.

Sign conventions. Orientation of a, b, c, d is the sign of det[b-a, c-a, d-a], positive for the origin and
the three unit vectors in order. In-sphere of a, b, c, d, e is positive where e is inside the circumsphere
of a positive tetrahedron abcd. Points are named by their rows in an array, so that compiled code makes no
views of it.

The bounds. Let u = 2^-53, X, Y, Z the largest absolute differences of coordinates, M the largest of them.
What under- and overflow can do is the slack of the work array, which has to be made for the points (`work`).

* orientation: 6 monomials, each at most XYZ. On the way a monomial is rounded at most 3 times in its
  differences, 2 in its 2x2 minor, once in the product with the third row, twice in sums: error <= 6 XYZ
  ((1+u)^8 - 1) < 48.1 u XYZ.
* in-sphere: 4 x 6 monomials XYZ times a lift of at most 3 M^2. Rounded at most 5 times in differences
  (three, and two in the lift), 2 in a minor, 3 in the product with the third row and its sums, 3 in the
  lift's square and sums, once in the product with the lift, 3 in the last sums: error <= 72 XYZ M^2
  ((1+u)^17 - 1) < 1225 u XYZ M^2.

Contraction to fused multiply-add leaves out roundings and adds none, so both hold with it.
"""

from __future__ import annotations

from .._numba.kernel_cache import cached_njit
from .adaptive import in_sphere_adaptive, orient3d_adaptive
from .work import SLACK

ORIENT3D_BOUND = 49.0 * 2.0**-53
IN_SPHERE_BOUND = 1240.0 * 2.0**-53


@cached_njit
def orient3d(points, a, b, c, d, w):
    """Sign of det[b-a, c-a, d-a] of four rows of ``points``."""
    x, y, z = points[a, 0], points[a, 1], points[a, 2]
    bx, by, bz = points[b, 0] - x, points[b, 1] - y, points[b, 2] - z
    cx, cy, cz = points[c, 0] - x, points[c, 1] - y, points[c, 2] - z
    dx, dy, dz = points[d, 0] - x, points[d, 1] - y, points[d, 2] - z
    det = bx * (cy * dz - cz * dy) + cx * (dy * bz - dz * by) + dx * (by * cz - bz * cy)
    x, y, z = max(abs(bx), abs(cx), abs(dx)), max(abs(by), abs(cy), abs(dy)), max(abs(bz), abs(cz), abs(dz))
    bound = ORIENT3D_BOUND * (x * y * z) + w[SLACK]
    if det > bound:
        return 1
    if det < -bound:
        return -1
    return orient3d_adaptive(points, a, b, c, d, det, x, y, z, w)


@cached_njit
def in_sphere(points, a, b, c, d, e, w):
    """1 inside, -1 outside, 0 on the circumsphere of the positive tetrahedron abcd; rows of ``points``."""
    x, y, z = points[e, 0], points[e, 1], points[e, 2]
    ax, ay, az = points[a, 0] - x, points[a, 1] - y, points[a, 2] - z
    bx, by, bz = points[b, 0] - x, points[b, 1] - y, points[b, 2] - z
    cx, cy, cz = points[c, 0] - x, points[c, 1] - y, points[c, 2] - z
    dx, dy, dz = points[d, 0] - x, points[d, 1] - y, points[d, 2] - z
    ab, bc, cd = ax * by - bx * ay, bx * cy - cx * by, cx * dy - dx * cy
    da, ac, bd = dx * ay - ax * dy, ax * cy - cx * ay, bx * dy - dx * by
    abc = az * bc - bz * ac + cz * ab
    bcd = bz * cd - cz * bd + dz * bc
    cda = cz * da + dz * ac + az * cd
    dab = dz * ab + az * bd + bz * da
    a_lift = ax * ax + ay * ay + az * az
    b_lift = bx * bx + by * by + bz * bz
    c_lift = cx * cx + cy * cy + cz * cz
    d_lift = dx * dx + dy * dy + dz * dz
    det = (a_lift * bcd - b_lift * cda) + (c_lift * dab - d_lift * abc)
    x = max(max(abs(ax), abs(bx)), max(abs(cx), abs(dx)))
    y = max(max(abs(ay), abs(by)), max(abs(cy), abs(dy)))
    z = max(max(abs(az), abs(bz)), max(abs(cz), abs(dz)))
    m = max(x, y, z)
    bound = IN_SPHERE_BOUND * (x * y * z * (m * m)) + w[SLACK]
    if det > bound:
        return 1
    if det < -bound:
        return -1
    return in_sphere_adaptive(points, a, b, c, d, e, det, x, y, z, w)
