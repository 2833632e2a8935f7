"""stand-in"""
from __future__ import annotations

import numba

from numba.extending import intrinsic

from .expansions import add, difference, multiply, negate
from .outlined import call_outlined


@intrinsic
def _orient2d_slow(typingctx, points, a, b, c, w):
    return call_outlined(typingctx, orient2d_exact, (points, a, b, c, w))


@intrinsic
def _in_circle_slow(typingctx, points, a, b, c, d, w):
    return call_outlined(typingctx, in_circle_exact, (points, a, b, c, d, w))

ORIENT2D_BOUND = 8.0 * 2.0**-53
IN_CIRCLE_BOUND = 120.0 * 2.0**-53


@numba.njit(cache=True)
def orient2d(points, a, b, c, w):
    x, y = points[a, 0], points[a, 1]
    bx, by = points[b, 0] - x, points[b, 1] - y
    cx, cy = points[c, 0] - x, points[c, 1] - y
    det = bx * cy - by * cx
    bound = ORIENT2D_BOUND * (abs(bx) * abs(cy) + abs(by) * abs(cx))
    if abs(det) > bound:
        return 1 if det > 0.0 else -1
    return _orient2d_slow(points, a, b, c, w)


@numba.njit(cache=True)
def _minor(points, p, q, r, w, h):
    ax = difference(w, h, points[p, 0], points[r, 0])
    ay = difference(w, h + 2, points[p, 1], points[r, 1])
    bx = difference(w, h + 4, points[q, 0], points[r, 0])
    by = difference(w, h + 6, points[q, 1], points[r, 1])
    n = multiply(w, h, ax, h + 6, by, h + 8)
    m = multiply(w, h + 2, ay, h + 4, bx, h + 8 + n)
    negate(w, h + 8 + n, m)
    k = add(w, h + 8, n, h + 8 + n, m, h + 8 + n + m)
    for i in range(k):
        w[h + i] = w[h + 8 + n + m + i]
    return k


@numba.njit(cache=True)
def _sign(w, e, n):
    if n == 0:
        return 0
    return 1 if w[e + n - 1] > 0.0 else -1


@numba.njit(cache=True)
def orient2d_exact(points, a, b, c, w):
    n = _minor(points, b, c, a, w, 0)
    return _sign(w, 0, n)


@numba.njit(cache=True)
def in_circle(points, a, b, c, d, w):
    x, y = points[d, 0], points[d, 1]
    ax, ay = points[a, 0] - x, points[a, 1] - y
    bx, by = points[b, 0] - x, points[b, 1] - y
    cx, cy = points[c, 0] - x, points[c, 1] - y
    al = ax * ax + ay * ay
    bl = bx * bx + by * by
    cl = cx * cx + cy * cy
    det = al * (bx * cy - by * cx) + bl * (cx * ay - cy * ax) + cl * (ax * by - ay * bx)
    mx = max(abs(ax), abs(bx), abs(cx))
    my = max(abs(ay), abs(by), abs(cy))
    m = max(mx, my)
    bound = IN_CIRCLE_BOUND * (mx * my * (m * m))
    if abs(det) > bound:
        return 1 if det > 0.0 else -1
    return _in_circle_slow(points, a, b, c, d, w)


@numba.njit(cache=True)
def in_circle_exact(points, a, b, c, d, w):
    total = 0
    for k in range(3):
        p, q, r = (a, b, c) if k == 0 else ((b, c, a) if k == 1 else (c, a, b))
        h = total
        x = difference(w, h, points[p, 0], points[d, 0])
        y = difference(w, h + 2, points[p, 1], points[d, 1])
        n = multiply(w, h, x, h, x, h + 4)
        m = multiply(w, h + 2, y, h + 2, y, h + 4 + n)
        e = add(w, h + 4, n, h + 4 + n, m, h + 4 + n + m)
        for i in range(e):
            w[h + i] = w[h + 4 + n + m + i]
        f = _minor(points, q, r, d, w, h + e)
        g = multiply(w, h, e, h + e, f, h + e + f)
        for i in range(g):
            w[h + i] = w[h + e + f + i]
        s = add(w, 0, total, h, g, h + g)
        for i in range(s):
            w[i] = w[h + g + i]
        total = s
    return _sign(w, 0, total)
