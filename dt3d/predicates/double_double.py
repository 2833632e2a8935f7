"""Arithmetic with pairs of doubles, which hold some 106 bits.

M. Joldes, J.-M. Muller, V. Popescu: Tight and Rigorous Error Bounds for Basic Building Blocks of
Double-Word Arithmetic. ACM Transactions on Mathematical Software 44, 2017, algorithms 6 and 12. With
u = 2^-53 the relative error of a sum is at most 3 u^2 + 13 u^3, that of a product 5 u^2, unless something
underflows.
Compiled by numba without fast-math, so that no operation is contracted or reordered.
"""

from __future__ import annotations

from numba import types
from numba.extending import intrinsic

from .._numba.kernel_cache import cached_njit


@intrinsic
def fma(typingctx, a, b, c):
    """a b + c, rounded once."""

    def codegen(context, builder, signature, args):
        return builder.fma(*args)

    return types.float64(types.float64, types.float64, types.float64), codegen


@cached_njit
def two_sum(a, b):
    """s + r = a + b exactly, s the rounded sum (Knuth)."""
    s = a + b
    virtual = s - a
    return s, (a - (s - virtual)) + (b - virtual)


@cached_njit
def two_product(a, b):
    """p + r = a b exactly, p the rounded product, unless the product underflows."""
    p = a * b
    return p, fma(a, b, -p)


@cached_njit
def _fast_two_sum(a, b):
    """s + r = a + b exactly, where a is not smaller in magnitude (Dekker)."""
    s = a + b
    return s, b - (s - a)


@cached_njit
def add(a, b):
    """The sum of two pairs."""
    s, low = two_sum(a[0], b[0])
    t, rest = two_sum(a[1], b[1])
    s, low = _fast_two_sum(s, low + t)
    return _fast_two_sum(s, rest + low)


@cached_njit
def subtract(a, b):
    """The difference of two pairs."""
    return add(a, (-b[0], -b[1]))


@cached_njit
def multiply(a, b):
    """The product of two pairs."""
    p, low = two_product(a[0], b[0])
    return _fast_two_sum(p, low + fma(a[1], b[0], fma(a[0], b[1], a[1] * b[1])))


@cached_njit
def minor(p, q):
    """x_p y_q - x_q y_p."""
    return subtract(multiply(p[0], q[1]), multiply(q[0], p[1]))


@cached_njit
def square(p):
    """|p|^2 of a vector of pairs."""
    total = multiply(p[0], p[0])
    for k in range(1, len(p)):
        total = add(total, multiply(p[k], p[k]))
    return total


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
