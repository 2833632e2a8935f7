"""Exact signs of the predicates, compiled, for any finite coordinates: in integers of any size.

All coordinates are multiples of one power of two. A number is some digits in a row in the workspace, named
by the place of the first: the value is the sum of x[at + i] 2^(27 i). Digits have signs of their own, as in
`traced/digits.py`, with h = 2^26: after `_carry` all are at most h but for the highest, which keeps what has
no place above it, at most 2^30. A column of a product is then at most h^2 times the length of the shorter
factor, at most 156, and two products of a highest digit; and four such columns are less than 2^63.

First in the array are up to four rows of differences, each a number for each coordinate, of as many digits n
as these points need: 78 for the greatest and the least floating-point number. What is computed from them lies
behind.
"""

from __future__ import annotations

import numpy as np
from numba import types
from numba.extending import intrinsic

from .._numba.kernel_cache import cached_njit
from .layout import DIGIT_BITS, HALF_DIGIT, INTEGERS_INDEX


@cached_njit
def orient2d_exact(a, b, c, w):
    """Sign of det[b-a, c-a] of three points, tuples of coordinates."""
    x = _integers(w)
    n = _enter((b, c), a, x)
    _minor(x, n, 0, 2 * n, 4 * n)
    return _sign(x, 4 * n, 2 * n)


@cached_njit
def orient3d_exact(a, b, c, d, w):
    """Sign of det[b-a, c-a, d-a] of four points, tuples of coordinates."""
    x = _integers(w)
    n = _enter((b, c, d), a, x)
    _determinant(x, n, 0, 3 * n, 6 * n, 9 * n)
    return _sign(x, 9 * n, 3 * n)


@cached_njit
def in_circle_exact(a, b, c, d, w):
    """Sign of the in-circle determinant: 1 where d is inside the circle of the positive triangle abc."""
    x = _integers(w)
    n = _enter((a, b, c), d, x)
    total, lift, minor = 6 * n, 10 * n, 12 * n
    _clear(x, total, 4 * n)
    for k in range(3):
        _lift(x, n, 2 * n * k, 2, lift)
        _minor(x, n, 2 * n * ((k + 1) % 3), 2 * n * ((k + 2) % 3), minor)
        _add_product(x, total, lift, 2 * n, minor, 2 * n, 1)
    _carry(x, total, 4 * n)
    return _sign(x, total, 4 * n)


@cached_njit
def in_sphere_exact(a, b, c, d, e, w):
    """Sign of the in-sphere determinant: 1 where e is inside the sphere of the positive tetrahedron abcd."""
    x = _integers(w)
    n = _enter((a, b, c, d), e, x)
    total, lift, minor = 12 * n, 17 * n, 19 * n
    _clear(x, total, 5 * n)
    for k in range(4):
        i, j, m = (1, 2, 3) if k == 0 else ((0, 2, 3) if k == 1 else ((0, 1, 3) if k == 2 else (0, 1, 2)))
        _lift(x, n, 3 * n * k, 3, lift)
        _determinant(x, n, 3 * n * i, 3 * n * j, 3 * n * m, minor)
        _add_product(x, total, lift, 2 * n, minor, 3 * n, 1 - 2 * (k % 2))
    _carry(x, total, 5 * n)
    return _sign(x, total, 5 * n)


@cached_njit
def _integers(w):
    """The workspace behind all else, for integers."""
    return w[INTEGERS_INDEX:].view(np.int64)


@intrinsic
def _bits(typingctx, x):
    """The 64 bits of a double, as an integer."""

    def codegen(context, builder, signature, args):
        return builder.bitcast(args[0], context.get_value_type(types.int64))

    return types.int64(types.float64), codegen


@cached_njit
def _parts(x):
    """m and e with |x| = m 2^(e - 1075): up to 53 bits, and an exponent from 1 to 2046."""
    bits = _bits(x)
    fraction, exponent = bits & ((1 << 52) - 1), (bits >> 52) & 0x7FF
    return (fraction, 1) if exponent == 0 else (fraction | 1 << 52, exponent)


@cached_njit
def _reach(point, least, greatest):
    """The least and the greatest exponent of a bit that is set, so far and in a point."""
    for coordinate in point:
        m, e = _parts(coordinate)
        if m != 0:
            # the lowest bit that is set is a power of two, whose exponent its float has
            least = min(least, e + (_bits(float(m & -m)) >> 52) - 1023)
            greatest = max(greatest, e + 53)
    return least, greatest


@cached_njit
def _enter(points, origin, x):
    """Put the digits of some points minus another at x[0], row after row; returns their length."""
    least, greatest = _reach(origin, 4000, 0)
    for point in points:
        least, greatest = _reach(point, least, greatest)
    n = max(greatest - least, 0) // DIGIT_BITS + 1
    at = 0
    for point in points:
        for c in range(len(origin)):
            _clear(x, at, n)
            _add_coordinate(x, at, point[c], least)
            _add_coordinate(x, at, -origin[c], least)
            _carry(x, at, n)
            at += n
    return n


@cached_njit
def _add_coordinate(x, at, value, unit):
    """Add a coordinate, a multiple of 2^(unit - 1075)."""
    m, e = _parts(value)
    if e < unit:
        m, e = m >> (unit - e), unit
    place, shift = divmod(e - unit, DIGIT_BITS)
    low, high = (m & (2 * HALF_DIGIT - 1)) << shift, (m >> DIGIT_BITS) << shift
    sign = -1 if value < 0.0 else 1
    if low != 0:
        x[at + place] += sign * low
    if high != 0:
        x[at + place + 1] += sign * high


@cached_njit
def _minor(x, n, p, q, at):
    """Put x_p y_q - x_q y_p, of the rows at p and q, at x[at], 2 n digits."""
    _clear(x, at, 2 * n)
    _add_product(x, at, p, n, q + n, n, 1)
    _add_product(x, at, q, n, p + n, n, -1)
    _carry(x, at, 2 * n)


@cached_njit
def _determinant(x, n, p, q, r, at):
    """Put the determinant of the rows at p, q and r at x[at], 3 n digits; 2 n behind are used."""
    _clear(x, at, 3 * n)
    for i, j, k in ((p, q, r), (q, r, p), (r, p, q)):
        _minor(x, n, i, j, at + 3 * n)
        _add_product(x, at, at + 3 * n, 2 * n, k + 2 * n, n, 1)
    _carry(x, at, 3 * n)


@cached_njit
def _lift(x, n, p, dimension, at):
    """Put the squared length of the row at p at x[at], 2 n digits."""
    _clear(x, at, 2 * n)
    for c in range(dimension):
        _add_product(x, at, p + c * n, n, p + c * n, n, 1)
    _carry(x, at, 2 * n)


@cached_njit
def _clear(x, at, n):
    for i in range(at, at + n):
        x[i] = 0


@cached_njit
def _add_product(x, at, a, na, b, nb, sign):
    """Add the product of the numbers at a and b, or subtract it."""
    for i in range(na):
        factor = sign * x[a + i]
        if factor != 0:
            for j in range(nb):
                x[at + i + j] += factor * x[b + j]


@cached_njit
def _carry(x, at, n):
    for i in range(at, at + n - 1):
        over = (x[i] + HALF_DIGIT) >> DIGIT_BITS
        x[i] -= over << DIGIT_BITS
        x[i + 1] += over


@cached_njit
def _sign(x, at, n):
    for i in range(at + n - 1, at - 1, -1):
        if x[i] != 0:
            return 1 if x[i] > 0 else -1
    return 0
