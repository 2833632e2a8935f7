"""Signs in the plane that the filter leaves open, by the least arithmetic that decides: as in `adaptive`.

The bounds, with differences that are exact and at most 5 u^2 for each rounding:

* orientation: 2 XY, rounded once in the product, once in the sum: 2 * 10 u^2 XY.
* in-circle: 12 XY M^2, rounded twice in a minor, twice in a lift, once in their product, twice in sums:
  12 * 35 u^2 XY M^2.
"""

from __future__ import annotations

from .._numba.kernel_cache import cached_njit
from . import double_double as dd
from .adaptive import NOTHING, on_lattice
from .double_double import two_sum
from .exact import in_circle_exact, orient2d_exact
from .work import SLACK

ORIENT2D_BOUND = 21.0 * 2.0**-106
IN_CIRCLE_BOUND = 430.0 * 2.0**-106

# As in `adaptive`: 2 N^2 or 12 N^4 are less than 2^53, twice 21 N^2 or 430 N^4 less than 2^106.
ORIENT2D_STEPS = 25, 49
IN_CIRCLE_STEPS = 12, 23


@cached_njit
def _row(points, p, q):
    """Point p minus point q, in the plane, as two pairs; exact."""
    return two_sum(points[p, 0], -points[q, 0]), two_sum(points[p, 1], -points[q, 1])


@cached_njit
def orient2d_adaptive(points, a, b, c, det, x, y, w):
    """Sign of det[b-a, c-a], of which det, x, y are the rounded value and X, Y."""
    if x == 0.0 or y == 0.0:
        return 0
    rows = _row(points, b, a), _row(points, c, a)
    m = max(x, y)
    discrete = w[SLACK] < NOTHING * m * m
    if discrete and on_lattice(rows, m, ORIENT2D_STEPS[0]):
        return (det > 0.0) - (det < 0.0)
    value = dd.minor(rows[0], rows[1])[0]
    bound = ORIENT2D_BOUND * (x * y) + w[SLACK]
    if value > bound:
        return 1
    if value < -bound:
        return -1
    if discrete and on_lattice(rows, m, ORIENT2D_STEPS[1]):
        return 0
    return orient2d_exact(points, a, b, c, w)


@cached_njit
def in_circle_adaptive(points, a, b, c, d, det, x, y, w):
    """Sign of the in-circle determinant, of which det, x, y are the rounded value and X, Y."""
    rows = _row(points, a, d), _row(points, b, d), _row(points, c, d)
    m = max(x, y)
    discrete = w[SLACK] < NOTHING * (m * m) * (m * m)
    if discrete and on_lattice(rows, m, IN_CIRCLE_STEPS[0]):
        return (det > 0.0) - (det < 0.0)
    value = _in_circle(rows[0], rows[1], rows[2])[0]
    bound = IN_CIRCLE_BOUND * (x * y * (m * m)) + w[SLACK]
    if value > bound:
        return 1
    if value < -bound:
        return -1
    if discrete and on_lattice(rows, m, IN_CIRCLE_STEPS[1]):
        return 0
    return in_circle_exact(points, a, b, c, d, w)


@cached_njit
def _in_circle(a, b, c):
    total = dd.add(dd.multiply(dd.square(a), dd.minor(b, c)), dd.multiply(dd.square(b), dd.minor(c, a)))
    return dd.add(total, dd.multiply(dd.square(c), dd.minor(a, b)))
