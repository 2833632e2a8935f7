"""Exact integers of any size in JAX: digits of 27 bits along the first axis of an array.

A number is the sum of x[i] 2^(27 i). Digits have signs of their own, and the same number has many forms: what
matters is only that digits are small enough for the next products (`carry`). A carry then travels one place
or two, never through the whole number, and the sign is that of the highest digit that is not zero. Every
operation is a few operations on whole arrays, whatever the number of digits (A. Avizienis: Signed-digit
number representations for fast parallel arithmetic, IRE Transactions on Electronic Computers EC-10, 1961).

The bounds. Let h = 2^26, half a digit. `limbs_of` gives |x[i]| <= h, so differences have digits of at most
2 h and need no carry. After `carry` digits are at most h + 2^10, except the highest, which keeps what has
no place above it. With n the length of the shorter factor, a column of a product of differences is at most
4 h^2 n = 2^54 n, and a sum of three of them (a squared length) stays below 2^63 up to n = 170. No other sum
in `determinants` is greater.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt
from jax import dtypes, lax

from ..layout import DIGIT_BITS, HALF_DIGIT

# Lengths of coordinates that are compiled for. The last holds every finite float64: its 27 * 78 - 1 bits are
# more than the 2098 between 2^-1074 and 2^1024.
LENGTHS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 78)

# Products of numbers up to this length are written out, longer ones are a loop in the compiled program.
UNROLLED = 8


def limbs_of(points: npt.ArrayLike) -> np.ndarray:
    """Return finite coordinates as integers, exactly: int32 (L, n, d) for float64 (n, d).

    One power of two for all makes them integers. L is the least of `LENGTHS` that holds the greatest: 1 for
    lattices of up to 2^26 steps, 2 for multiples of 2^-53 in the unit cube, 3 or 4 for other random floats,
    78 for any set. Computed by NumPy, since XLA takes subnormal numbers for zero.
    """
    points = np.asarray(points, np.float64)
    fraction, exponent = np.frexp(points.ravel())
    mantissa = np.ldexp(np.abs(fraction), 53).astype(np.int64)
    exponent = exponent.astype(np.int64) - 53
    # the trailing zero bits of a mantissa move to its exponent
    _, lowest = np.frexp((mantissa & -mantissa).astype(np.float64))
    zeros = np.maximum(lowest - 1, 0)
    mantissa >>= zeros
    exponent += zeros
    used = mantissa > 0
    unit = exponent[used].min() if used.any() else 0
    _, width = np.frexp(mantissa.astype(np.float64))  # an odd mantissa of 53 bits is exact
    shift = np.where(used, exponent - unit, 0)
    bits = int((shift + width).max(initial=1))
    length = next(n for n in LENGTHS if DIGIT_BITS * n - 1 >= bits)

    digits = np.zeros((length + 2, points.size), np.int64)
    place, column = shift // DIGIT_BITS, np.arange(points.size)
    low, high = mantissa & (2 * HALF_DIGIT - 1), mantissa >> DIGIT_BITS
    digits[place, column] = low << shift % DIGIT_BITS
    digits[place + 1, column] = high << shift % DIGIT_BITS
    for i in range(length - 1):
        over = (digits[i] + HALF_DIGIT) >> DIGIT_BITS
        digits[i] -= over << DIGIT_BITS
        digits[i + 1] += over
    digits[:, fraction < 0] *= -1
    return digits[:length].astype(np.int32).reshape(length, *points.shape)


def product(a: jax.Array, b: jax.Array) -> jax.Array:
    """a b, int64 (len(a) + len(b), ...) with digits that have not been carried; the other axes broadcast.

    The highest digit is zero, for the carry.
    """
    if dtypes.canonicalize_dtype(np.int64) != np.int64:
        msg = "exact integers need 64 bits, which JAX has switched off; use `with jax.enable_x64(True):`"
        raise ValueError(msg)
    if len(a) > len(b):
        a, b = b, a
    a = a.astype(jnp.int64)
    b = b.astype(jnp.int64)
    n = len(b)
    shape = jnp.broadcast_shapes(a.shape[1:], b.shape[1:])
    if len(a) <= UNROLLED:
        rest = [(0, 0)] * len(shape)
        rows = [jnp.pad(a[i] * b, [(i, len(a) - i), *rest]) for i in range(len(a))]
        return sum(rows[1:], rows[0])

    def row(i: jax.Array, total: jax.Array) -> jax.Array:
        part = lax.dynamic_slice_in_dim(total, i, n)
        part = part + lax.dynamic_index_in_dim(a, i, keepdims=False) * b
        return lax.dynamic_update_slice_in_dim(total, part, i, 0)

    total: jax.Array = lax.fori_loop(0, len(a), row, jnp.zeros((len(a) + n, *shape), jnp.int64))
    return total


def carry(x: jax.Array) -> jax.Array:
    """The same numbers with digits of at most 2^26 + 2^10, int64; the highest takes what comes to it.

    From digits below 2^63 in magnitude the first round leaves 2^26 + 2^36, the second 2^26 + 2^10.
    """
    for _ in range(2):
        over = (x[:-1] + HALF_DIGIT) >> DIGIT_BITS
        keep = jnp.concatenate([x[:-1] - (over << DIGIT_BITS), x[-1:]])
        x = keep + jnp.concatenate([jnp.zeros_like(x[:1]), over])
    return x


def sign(x: jax.Array) -> jax.Array:
    """-1, 0 or 1 of carried numbers (L, ...), int32 (...).

    All digits below the highest that is not zero are less than 2^27 - 1, and add up to less than it.
    """
    weights = jnp.arange(1, len(x) + 1, dtype=jnp.int32).reshape(-1, *[1] * (x.ndim - 1))
    signed = jnp.sign(x).astype(jnp.int32) * weights
    # of the greatest and the least of +-(i + 1), the one of greater magnitude belongs to the highest digit
    return jnp.sign(jnp.max(signed, axis=0) + jnp.min(signed, axis=0))
