"""Exact signs of the determinants of orientation and in-sphere, by expansions."""

from __future__ import annotations

import numba

from .expansions import add, difference, multiply, negate

# A work array begins with the twelve entries of up to four rows of differences, two components each, and
# their lengths; what is computed from them lies behind.
LENGTHS = 24
FREE = 36


@numba.njit(cache=True)
def _minor(w, p, q, h):
    """Put x_p y_q - x_q y_p, of rows p and q, at w[h]; all from w[h] on is used."""
    a = _product(w, 3 * p, 3 * q + 1, h)
    b = _product(w, 3 * q, 3 * p + 1, h + a)
    negate(w, h + a, b)
    return _collect(w, h, a, b)


@numba.njit(cache=True)
def _product(w, i, j, h):
    """Put the product of entries i and j of the rows at w[h]; all from w[h] on is used."""
    return multiply(w, 2 * i, int(w[LENGTHS + i]), 2 * j, int(w[LENGTHS + j]), h)


@numba.njit(cache=True)
def _collect(w, h, total, n):
    """Replace the expansion of length total at w[h] by its sum with that of length n behind it."""
    s = add(w, h, total, h + total, n, h + total + n)
    for x in range(s):
        w[h + x] = w[h + total + n + x]
    return s


@numba.njit(cache=True)
def _determinant3(w, i, j, k, h):
    """Put the determinant of rows i, j, k at w[h]; all from w[h] on is used."""
    total = 0
    for turn in range(3):
        p, q, r = (i, j, k) if turn == 0 else ((j, k, i) if turn == 1 else (k, i, j))
        # the minor moves behind the product that is made of it, and is overwritten with the sum
        at = h + total
        m = _minor(w, p, q, at)
        n = multiply(w, at, m, 2 * (3 * r + 2), int(w[LENGTHS + 3 * r + 2]), at + m)
        for x in range(n):
            w[at + x] = w[at + m + x]
        total = _collect(w, h, total, n)
    return total


@numba.njit(cache=True)
def _lift(w, k, h):
    """Put the squared length of row k at w[h]; all from w[h] on is used."""
    total = 0
    for c in range(3):
        n = _product(w, 3 * k + c, 3 * k + c, h + total)
        total = _collect(w, h, total, n)
    return total


@numba.njit(cache=True)
def _sign(w, e, n):
    if n == 0:
        return 0
    return 1 if w[e + n - 1] > 0.0 else -1


@numba.njit(cache=True)
def _enter(points, w, r, p, q):
    """Make point p minus point q the row r."""
    for c in range(3):
        i = 3 * r + c
        w[LENGTHS + i] = difference(w, 2 * i, points[p, c], points[q, c])


@numba.njit(cache=True)
def orient3d_exact(points, a, b, c, d, w):
    """Sign of det[b-a, c-a, d-a] of four rows of ``points``."""
    _enter(points, w, 0, b, a)
    _enter(points, w, 1, c, a)
    _enter(points, w, 2, d, a)
    return _sign(w, FREE, _determinant3(w, 0, 1, 2, FREE))


@numba.njit(cache=True)
def in_sphere_exact(points, a, b, c, d, e, w):
    """Sign of the in-sphere determinant: 1 where e is inside the sphere of the positive tetrahedron abcd."""
    _enter(points, w, 0, a, e)
    _enter(points, w, 1, b, e)
    _enter(points, w, 2, c, e)
    _enter(points, w, 3, d, e)
    total = 0
    for k in range(4):
        i, j, m = (1, 2, 3) if k == 0 else ((0, 2, 3) if k == 1 else ((0, 1, 3) if k == 2 else (0, 1, 2)))
        at = FREE + total
        lift = _lift(w, k, at)
        minor = _determinant3(w, i, j, m, at + lift)
        n = multiply(w, at + lift, minor, at, lift, at + lift + minor)
        if k % 2 == 1:
            negate(w, at + lift + minor, n)
        for x in range(n):
            w[at + x] = w[at + lift + minor + x]
        total = _collect(w, FREE, total, n)
    return _sign(w, FREE, total)
