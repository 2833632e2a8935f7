"""What the filters of the predicates leave open: pairs of doubles, lattices, and integers of any size.

See `space` for the stages and their bounds. Points are tuples of their coordinates, so these functions are
the same for all arrays that points are in. Each is compiled once, when a kernel first comes to it, and called
by its address (`_numba.by_address`), which the workspace has: within the kernels they would be compiled again
and again. Sites in general position hardly ever come to them.
"""

from __future__ import annotations

from numba.core import types
from numba.extending import intrinsic

from .._numba.by_address import Functions, call_at
from .._numba.kernel_cache import cached_njit
from . import double_double as dd
from .big_integers import in_circle_exact, in_sphere_exact, orient2d_exact, orient3d_exact
from .layout import (
    FINDER,
    IN_CIRCLE_OPEN,
    IN_SPHERE_OPEN,
    NEGLIGIBLE,
    ORIENT2D_OPEN,
    ORIENT3D_OPEN,
    SLACK_INDEX,
)

ORIENT2D_BOUND_OF_PAIRS = 21.0 * 2.0**-106
IN_CIRCLE_BOUND_OF_PAIRS = 430.0 * 2.0**-106
ORIENT3D_BOUND_OF_PAIRS = 160.0 * 2.0**-106
IN_SPHERE_BOUND_OF_PAIRS = 4100.0 * 2.0**-106

# Steps of a lattice that the greatest difference may have, N = 2^k: for a determinant below 2^53 steps, and
# for one that is zero or beyond twice the bound. 2 N^2, 12 N^4, 6 N^3 and 72 N^5 are less than 2^53; 2 * 21
# N^2 and 2 * 430 N^4 less than 2^106, 6 * 27 N^3 and 72 * 57 N^5 less than 2^105.
ORIENT2D_STEPS = 25, 49
IN_CIRCLE_STEPS = 12, 23
ORIENT3D_STEPS = 16, 32
IN_SPHERE_STEPS = 9, 18

WORKSPACE = types.Array(types.float64, 1, "C")


@cached_njit(error_model="numpy")
def orient2d_open(rows, det, extents, w):
    """Sign of the determinant that the filter leaves open; its rounded value and X, Y are given."""
    x, y = extents
    if x == 0.0 or y == 0.0:
        return 0
    a, b, c = rows
    p, q = _difference(b, a), _difference(c, a)
    m = max(x, y)
    discrete = w[SLACK_INDEX] < NEGLIGIBLE * m * m
    if discrete and dd.on_lattice((p, q), m, ORIENT2D_STEPS[0]):
        return (det > 0.0) - (det < 0.0)
    value = dd.minor(p, q)[0]
    bound = ORIENT2D_BOUND_OF_PAIRS * (x * y) + w[SLACK_INDEX]
    sign = (value > bound) - (value < -bound)
    if sign != 0 or (discrete and dd.on_lattice((p, q), m, ORIENT2D_STEPS[1])):
        return sign
    return orient2d_exact(a, b, c, w)


@cached_njit(error_model="numpy")
def in_circle_open(rows, det, extents, w):
    """Sign of the determinant that the filter leaves open; its rounded value and X, Y are given."""
    x, y = extents
    a, b, c, d = rows
    p, q, r = _difference(a, d), _difference(b, d), _difference(c, d)
    m = max(x, y)
    discrete = w[SLACK_INDEX] < NEGLIGIBLE * (m * m) * (m * m)
    if discrete and dd.on_lattice((p, q, r), m, IN_CIRCLE_STEPS[0]):
        return (det > 0.0) - (det < 0.0)
    total = dd.add(dd.multiply(dd.square(p), dd.minor(q, r)), dd.multiply(dd.square(q), dd.minor(r, p)))
    value = dd.add(total, dd.multiply(dd.square(r), dd.minor(p, q)))[0]
    bound = IN_CIRCLE_BOUND_OF_PAIRS * (x * y * (m * m)) + w[SLACK_INDEX]
    sign = (value > bound) - (value < -bound)
    if sign != 0 or (discrete and dd.on_lattice((p, q, r), m, IN_CIRCLE_STEPS[1])):
        return sign
    return in_circle_exact(a, b, c, d, w)


@cached_njit(error_model="numpy")
def orient3d_open(rows, det, extents, w):
    """Sign of the determinant that the filter leaves open; its rounded value and X, Y, Z are given."""
    x, y, z = extents
    if x == 0.0 or y == 0.0 or z == 0.0:
        return 0
    a, b, c, d = rows
    p, q, r = _difference(b, a), _difference(c, a), _difference(d, a)
    m = max(x, y, z)
    discrete = w[SLACK_INDEX] < NEGLIGIBLE * m * m * m
    if discrete and dd.on_lattice((p, q, r), m, ORIENT3D_STEPS[0]):
        return (det > 0.0) - (det < 0.0)
    value = dd.add(
        dd.add(dd.multiply(dd.minor(p, q), r[2]), dd.multiply(dd.minor(q, r), p[2])),
        dd.multiply(dd.minor(r, p), q[2]),
    )[0]
    bound = ORIENT3D_BOUND_OF_PAIRS * (x * y * z) + w[SLACK_INDEX]
    sign = (value > bound) - (value < -bound)
    if sign != 0 or (discrete and dd.on_lattice((p, q, r), m, ORIENT3D_STEPS[1])):
        return sign
    return orient3d_exact(a, b, c, d, w)


@cached_njit(error_model="numpy")
def in_sphere_open(rows, det, extents, w):
    """Sign of the determinant that the filter leaves open; its rounded value and X, Y, Z are given."""
    x, y, z = extents
    a, b, c, d, e = rows
    differences = (
        _difference(a, e), _difference(b, e),
        _difference(c, e), _difference(d, e),
    )  # fmt: skip
    m = max(x, y, z)
    discrete = w[SLACK_INDEX] < NEGLIGIBLE * (m * m) * (m * m) * m
    if discrete and dd.on_lattice(differences, m, IN_SPHERE_STEPS[0]):
        return (det > 0.0) - (det < 0.0)
    value = _in_sphere_of_pairs(differences)[0]
    bound = IN_SPHERE_BOUND_OF_PAIRS * (x * y * z * (m * m)) + w[SLACK_INDEX]
    sign = (value > bound) - (value < -bound)
    if sign != 0 or (discrete and dd.on_lattice(differences, m, IN_SPHERE_STEPS[1])):
        return sign
    return in_sphere_exact(a, b, c, d, e, w)


@cached_njit
def _in_sphere_of_pairs(differences):
    a, b, c, d = differences
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


@cached_njit
def _difference(p, q):
    """Point p minus point q, as a pair for each coordinate; exact."""
    if len(p) == 2:
        return dd.two_sum(p[0], -q[0]), dd.two_sum(p[1], -q[1])
    return dd.two_sum(p[0], -q[0]), dd.two_sum(p[1], -q[1]), dd.two_sum(p[2], -q[2])


def _kinds(points: int, dimension: int) -> tuple[types.Type, ...]:
    """The types of the arguments."""
    corner = types.UniTuple(types.float64, dimension)
    return types.UniTuple(corner, points), types.float64, corner, WORKSPACE


FUNCTIONS = Functions(FINDER)
"""What the addresses in a workspace are of: these stages, and what an engine adds."""

FUNCTIONS.add(ORIENT2D_OPEN, orient2d_open, _kinds(3, 2))
FUNCTIONS.add(IN_CIRCLE_OPEN, in_circle_open, _kinds(4, 2))
FUNCTIONS.add(ORIENT3D_OPEN, orient3d_open, _kinds(4, 3))
FUNCTIONS.add(IN_SPHERE_OPEN, in_sphere_open, _kinds(5, 3))


@intrinsic
def call_orient2d_open(typingctx, work, rows, det, extents, w):
    """The stage of `plane.orient2d`; ``work`` is the workspace, as is ``w``."""
    return call_at(work, ORIENT2D_OPEN, types.int64, FUNCTIONS)


@intrinsic
def call_in_circle_open(typingctx, work, rows, det, extents, w):
    """The stage of `plane.in_circle`."""
    return call_at(work, IN_CIRCLE_OPEN, types.int64, FUNCTIONS)


@intrinsic
def call_orient3d_open(typingctx, work, rows, det, extents, w):
    """The stage of `space.orient3d`."""
    return call_at(work, ORIENT3D_OPEN, types.int64, FUNCTIONS)


@intrinsic
def call_in_sphere_open(typingctx, work, rows, det, extents, w):
    """The stage of `space.in_sphere`."""
    return call_at(work, IN_SPHERE_OPEN, types.int64, FUNCTIONS)
