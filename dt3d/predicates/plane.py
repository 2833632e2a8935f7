r"""Orientation and in-circle in the plane, and which perturbed site is inside a circle: exact signs.

Sign conventions, as drawn::

          c          orient2d(a, b, c) = +1: a turn to the left. It is 0 where the three are collinear, and -1
         / \         for a turn to the right.
        /   \
       a-----b       in_circle(a, b, c, d) = +1 where d is inside the circle through a positive a, b, c;
                     0 where it is on the circle, -1 outside.

Points are rows of an array (n, 2). The stages are those of `space`, but what the filter leaves open is not
inlined.

The bounds. Let u = 2^-53, X, Y the largest absolute differences of coordinates, M the larger of them. What
under- and overflow can do is the slack of the workspace. In pairs of doubles differences are exact and each
rounding is at most 5 u^2.

* orientation: 2 monomials XY, rounded in doubles twice in differences, once in the product, once in the sum:
  error <= 2 XY ((1+u)^4 - 1) < 8.1 u XY. In pairs once in the product, once in the sum: 2 * 10 u^2 XY.
* in-circle: 3 x 2 monomials XY times a lift of at most 2 M^2. In doubles rounded 4 times in differences (two,
  and two in the lift), 2 in a minor, 2 in the lift's square and sum, once in their product, 2 in the last
  sums: error <= 12 XY M^2 ((1+u)^11 - 1) < 132.1 u XY M^2. In pairs twice in a minor, twice in a lift, once
  in their product, twice in sums: 12 * 35 u^2 XY M^2.

Contraction to fused multiply-add leaves out roundings and adds none, so all hold with it.
"""

from __future__ import annotations

from numba.extending import intrinsic

from .._numba.kernel_cache import cached_njit
from .._numba.noinline import call_noinline
from .layout import SLACK_INDEX
from .lexicographic import before
from .open_stages import call_in_circle_open, call_orient2d_open

ORIENT2D_BOUND = 9.0 * 2.0**-53
IN_CIRCLE_BOUND = 134.0 * 2.0**-53


@cached_njit
def _at(points, a):
    """The coordinates of a row."""
    return points[a, 0], points[a, 1]


@cached_njit
def orient2d(points, a, b, c, w):
    """Sign of det[b-a, c-a] of three rows of ``points``."""
    bx, by = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1]
    cx, cy = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1]
    det = bx * cy - cx * by
    x, y = max(abs(bx), abs(cx)), max(abs(by), abs(cy))
    bound = ORIENT2D_BOUND * (x * y) + w[SLACK_INDEX]
    # one branch that is nearly always taken, and no other on the sign, which nobody can predict
    if abs(det) > bound:
        return 1 if det > 0.0 else -1
    return call_orient2d_open(w, (_at(points, a), _at(points, b), _at(points, c)), det, (x, y), w)


@cached_njit
def in_circle(points, a, b, c, d, w):
    """1 inside, -1 outside, 0 on the circumcircle of the positive triangle abc; rows of ``points``."""
    x, y = points[d, 0], points[d, 1]
    ax, ay = points[a, 0] - x, points[a, 1] - y
    bx, by = points[b, 0] - x, points[b, 1] - y
    cx, cy = points[c, 0] - x, points[c, 1] - y
    a_lift, b_lift, c_lift = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    det = a_lift * (bx * cy - cx * by) + b_lift * (cx * ay - ax * cy) + c_lift * (ax * by - bx * ay)
    x = max(abs(ax), abs(bx), abs(cx))
    y = max(abs(ay), abs(by), abs(cy))
    m = max(x, y)
    bound = IN_CIRCLE_BOUND * (x * y * (m * m)) + w[SLACK_INDEX]
    if abs(det) > bound:
        return 1 if det > 0.0 else -1
    rows = _at(points, a), _at(points, b), _at(points, c), _at(points, d)
    return call_in_circle_open(w, rows, det, (x, y), w)


@cached_njit(forceinline=True)
def inside(points, v, site, w):
    """Whether a site is inside the perturbed circumcircle of the positive triangle v, three sites."""
    sign = in_circle(points, v[0], v[1], v[2], site, w)
    return sign > 0 if sign != 0 else _call_inside_tied(points, v, site, w)


@cached_njit
def _inside_tied(points, v, site, w):
    """The perturbed in-circle test of a site on the circumcircle of triangle v, a tuple of three sites.

    Heights are as in `space`. Of the four in lexicographic order the first whose coefficient is not zero
    decides. A site on the circle is on no line through two vertices, so that is the first of all. Coordinates
    are compared, since ranks would cost a sort of all sites.
    """
    a, b, c = v
    first, k = site, 3
    if before(points, a, first):
        first, k = a, 0
    if before(points, b, first):
        first, k = b, 1
    if before(points, c, first):
        first, k = c, 2
    if k == 3:
        return False
    if k == 0:
        return orient2d(points, site, b, c, w) > 0
    if k == 1:
        return orient2d(points, a, site, c, w) > 0
    return orient2d(points, a, b, site, w) > 0


@intrinsic
def _call_inside_tied(typingctx, points, v, site, w):
    return call_noinline(typingctx, _inside_tied, (points, v, site, w))


@cached_njit
def orient2d_of_cases(cases, w, out):
    """Write the signs of cases float64 (m, 3, 2)."""
    for i in range(len(out)):
        out[i] = orient2d(cases[i], 0, 1, 2, w)


@cached_njit
def in_circle_of_cases(cases, w, out):
    """Write the signs of cases float64 (m, 4, 2)."""
    for i in range(len(out)):
        out[i] = in_circle(cases[i], 0, 1, 2, 3, w)
