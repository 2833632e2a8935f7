"""Orientation and in-circle in the plane: a fast sign where a bound of the error allows it, as in `filtered`.

Sign conventions. Orientation of a, b, c is the sign of det[b-a, c-a], positive for a turn to the left.
In-circle of a, b, c, d is positive where d is inside the circumcircle of a positive triangle abc. Points are
named by their rows in an array (n, 2).

The bounds. Let u = 2^-53, X, Y the largest absolute differences of coordinates, M the larger of them. What
under- and overflow can do is the slack of the work array.

* orientation: 2 monomials XY, rounded twice in differences, once in the product, once in the sum: error <=
  2 XY ((1+u)^4 - 1) < 8.1 u XY.
* in-circle: 3 x 2 monomials XY times a lift of at most 2 M^2. Rounded 4 times in differences (two, and two in
  the lift), 2 in a minor, 2 in the lift's square and sum, once in their product, 2 in the last sums: error <=
  12 XY M^2 ((1+u)^11 - 1) < 132.1 u XY M^2.

Contraction to fused multiply-add leaves out roundings and adds none, so both hold with it.
"""

from __future__ import annotations

from typing import Any

from numba.extending import intrinsic

from .._numba.kernel_cache import cached_njit
from .._numba.noinline import call_noinline
from .adaptive2d import in_circle_adaptive, orient2d_adaptive
from .work import SLACK

ORIENT2D_BOUND = 9.0 * 2.0**-53
IN_CIRCLE_BOUND = 134.0 * 2.0**-53


@intrinsic
def _orient2d_open(
    typingctx: Any, points: Any, a: Any, b: Any, c: Any, det: Any, x: Any, y: Any, w: Any
) -> Any:
    return call_noinline(typingctx, orient2d_adaptive, (points, a, b, c, det, x, y, w))


@intrinsic
def _in_circle_open(
    typingctx: Any, points: Any, a: Any, b: Any, c: Any, d: Any, det: Any, x: Any, y: Any, w: Any
) -> Any:
    return call_noinline(typingctx, in_circle_adaptive, (points, a, b, c, d, det, x, y, w))


@cached_njit
def orient2d(points, a, b, c, w):
    """Sign of det[b-a, c-a] of three rows of ``points``."""
    bx, by = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1]
    cx, cy = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1]
    det = bx * cy - cx * by
    x, y = max(abs(bx), abs(cx)), max(abs(by), abs(cy))
    bound = ORIENT2D_BOUND * (x * y) + w[SLACK]
    # one branch that is nearly always taken, and no other on the sign, which nobody can predict
    if abs(det) > bound:
        return 1 if det > 0.0 else -1
    return _orient2d_open(points, a, b, c, det, x, y, w)


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
    bound = IN_CIRCLE_BOUND * (x * y * (m * m)) + w[SLACK]
    if abs(det) > bound:
        return 1 if det > 0.0 else -1
    return _in_circle_open(points, a, b, c, d, det, x, y, w)
