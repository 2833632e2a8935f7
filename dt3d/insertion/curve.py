"""Positions along a Hilbert curve: near in number means near in space, without the jumps of the Morton
order.

Its halves, quarters and eighths are pieces of space of their own, and so is what remains of it without one
of them: the pieces of the curve that threads own can be moved along it, and what was the boundary of two
pieces becomes the inside of one.
"""

from __future__ import annotations

from .._numba.kernel_cache import cached_njit


@cached_njit(nogil=True, error_model="numpy")
def hilbert_keys(sites, low, part, first, scale, bits, index_bits, begin, end, keys):
    """``keys[i] = position << index_bits | i`` of sites[i], int64, for i from begin to end - 1.

    Positions have 3 ``bits`` bits, in the cube with the least corner ``low`` and the side 2^bits / (part
    first scale). ``part`` is a power of two with which no difference overflows, ``first`` one with which a
    tiny difference becomes a normal number. All this rounds, but depends on the site's coordinates alone:
    equal sites have equal positions. J. Skilling: Programming the Hilbert curve. AIP Conference Proceedings
    707, 2004.
    """
    top = (1 << bits) - 1
    for i in range(begin, end):
        x = min(int((sites[i, 0] * part - low[0] * part) * first * scale), top)
        y = min(int((sites[i, 1] * part - low[1] * part) * first * scale), top)
        z = min(int((sites[i, 2] * part - low[2] * part) * first * scale), top)
        # undo the exchanges and inversions of the curve, from the greatest cube to the least
        q = 1 << (bits - 1)
        while q > 1:
            p = q - 1
            if x & q:
                x ^= p
            if y & q:
                x ^= p
            else:
                swap = (x ^ y) & p
                x ^= swap
                y ^= swap
            if z & q:
                x ^= p
            else:
                swap = (x ^ z) & p
                x ^= swap
                z ^= swap
            q >>= 1
        # Gray code
        y ^= x
        z ^= y
        turn = 0
        q = 1 << (bits - 1)
        while q > 1:
            if z & q:
                turn ^= q - 1
            q >>= 1
        keys[i] = (_spread(x ^ turn) << 2 | _spread(y ^ turn) << 1 | _spread(z ^ turn)) << index_bits | i


@cached_njit(inline="always")
def _spread(x):
    """The 21 low bits of x, two zero bits between neighbours."""
    x = (x | x << 32) & 0x1F00000000FFFF
    x = (x | x << 16) & 0x1F0000FF0000FF
    x = (x | x << 8) & 0x100F00F00F00F00F
    x = (x | x << 4) & 0x10C30C30C30C30C3
    return (x | x << 2) & 0x1249249249249249
