"""Signs in space that the filter leaves open, by the least arithmetic that decides.

1. If all differences are small multiples of one power of two, the filter's determinant has no rounding error.
2. In pairs of doubles the sign is certain beyond a bound of about 2^-51 times the filter's. And if the
   differences are multiples of g, so is the determinant of g^3 or g^5: closer to 0 than that it is 0.
3. What is left is computed exactly (`exact`).

Lattices and grids end in 1, nearly cospherical sites in 2; so do exact ties of some 18 bits (in-sphere)
or 32 (orientation).

The bounds, as in `filtered`, with differences that are exact and at most 5 u^2 for each rounding:

* orientation: 6 XYZ, rounded twice in a minor, once in the product, twice in sums: 6 * 25 u^2 XYZ.
* in-sphere: 72 XYZ M^2, rounded twice in a minor, three times in a 3x3 minor, three times in a lift, three
  times more: 72 * 55 u^2 XYZ M^2.
"""

from __future__ import annotations

from .._numba.kernel_cache import cached_njit
from . import double_double as dd
from .double_double import two_sum
from .exact import in_sphere_exact, orient3d_exact
from .work import SLACK

ORIENT3D_BOUND = 160.0 * 2.0**-106
IN_SPHERE_BOUND = 4100.0 * 2.0**-106

# Steps of a lattice that the greatest difference may have, N = 2^k: for a determinant below 2^53 steps, and
# for one that is zero or beyond twice the bound. 6 N^3 or 72 N^5 are less than 2^53; 6 * 27 N^3 and 72 * 57
# N^5 are less than 2^105.
ORIENT3D_STEPS = 16, 32
IN_SPHERE_STEPS = 9, 18

# The slack of the bounds is nothing beside a step of a lattice if it is less than this part of M^3 or M^5.
NOTHING = 2.0**-110


@cached_njit
def row(points, p, q):
    """Point p minus point q, in space, as three pairs; exact."""
    return (
        two_sum(points[p, 0], -points[q, 0]),
        two_sum(points[p, 1], -points[q, 1]),
        two_sum(points[p, 2], -points[q, 2]),
    )


@cached_njit
def on_lattice(rows, m, bits):
    """Whether all entries are single doubles, and multiples of a power of two of which m has at most 2^bits.

    Adding c rounds to multiples of its unit in the last place, of which m has 2^(bits - 1) to 2^bits.
    """
    c = m * 2.0 ** (53 - bits)
    for r in rows:
        for x in r:
            if x[1] != 0.0 or (x[0] + c) - c != x[0]:
                return False
    return True


@cached_njit
def _determinant(p, q, r):
    return dd.add(
        dd.add(dd.multiply(dd.minor(p, q), r[2]), dd.multiply(dd.minor(q, r), p[2])),
        dd.multiply(dd.minor(r, p), q[2]),
    )


@cached_njit
def orient3d_adaptive(points, a, b, c, d, det, x, y, z, w):
    """Sign of det[b-a, c-a, d-a], of which det, x, y, z are the rounded value and X, Y, Z."""
    if x == 0.0 or y == 0.0 or z == 0.0:
        return 0
    rows = row(points, b, a), row(points, c, a), row(points, d, a)
    m = max(x, y, z)
    discrete = w[SLACK] < NOTHING * m * m * m
    if discrete and on_lattice(rows, m, ORIENT3D_STEPS[0]):
        return (det > 0.0) - (det < 0.0)
    value = _determinant(rows[0], rows[1], rows[2])[0]
    bound = ORIENT3D_BOUND * (x * y * z) + w[SLACK]
    if value > bound:
        return 1
    if value < -bound:
        return -1
    if discrete and on_lattice(rows, m, ORIENT3D_STEPS[1]):
        return 0
    return orient3d_exact(points, a, b, c, d, w)


@cached_njit
def in_sphere_adaptive(points, a, b, c, d, e, det, x, y, z, w):
    """Sign of the in-sphere determinant, of which det, x, y, z are the rounded value and X, Y, Z."""
    rows = row(points, a, e), row(points, b, e), row(points, c, e), row(points, d, e)
    m = max(x, y, z)
    discrete = w[SLACK] < NOTHING * (m * m) * (m * m) * m
    if discrete and on_lattice(rows, m, IN_SPHERE_STEPS[0]):
        return (det > 0.0) - (det < 0.0)
    value = _in_sphere(rows[0], rows[1], rows[2], rows[3])[0]
    bound = IN_SPHERE_BOUND * (x * y * z * (m * m)) + w[SLACK]
    if value > bound:
        return 1
    if value < -bound:
        return -1
    if discrete and on_lattice(rows, m, IN_SPHERE_STEPS[1]):
        return 0
    return in_sphere_exact(points, a, b, c, d, e, w)


@cached_njit
def _in_sphere(a, b, c, d):
    ab, bc, cd = dd.minor(a, b), dd.minor(b, c), dd.minor(c, d)
    da, ac, bd = dd.minor(d, a), dd.minor(a, c), dd.minor(b, d)
    abc = _sum3(dd.multiply(bc, a[2]), dd.multiply(ac, _minus(b[2])), dd.multiply(ab, c[2]))
    bcd = _sum3(dd.multiply(cd, b[2]), dd.multiply(bd, _minus(c[2])), dd.multiply(bc, d[2]))
    cda = _sum3(dd.multiply(da, c[2]), dd.multiply(ac, d[2]), dd.multiply(cd, a[2]))
    dab = _sum3(dd.multiply(ab, d[2]), dd.multiply(bd, a[2]), dd.multiply(da, b[2]))
    return dd.add(
        dd.subtract(dd.multiply(dd.square(a), bcd), dd.multiply(dd.square(b), cda)),
        dd.subtract(dd.multiply(dd.square(c), dab), dd.multiply(dd.square(d), abc)),
    )


@cached_njit
def _sum3(a, b, c):
    return dd.add(dd.add(a, b), c)


@cached_njit
def _minus(a):
    return -a[0], -a[1]
