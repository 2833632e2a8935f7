"""The order of sites in memory and of their insertion; and which of them are duplicates.

A biased randomised order (N. Amenta, S. Choi, G. Rote: Incremental constructions con BRIO, SoCG 2003): rounds
that double in size at random, each along a space-filling curve. It keeps the expected cost of random
insertion, and what is needed next is near in memory.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from .._input import first_copies
from .._numba.kernel_cache import cached_njit
from .sorting import sort_runs

SMALLEST_ROUND = 64
MOST_ROUNDS = 24


def _turns() -> np.ndarray:
    """Hilbert's curve, four bits of both coordinates at a time: uint16 (4 * 256,).

    Row 256 t + 16 x + y is for the cell (x, y) of a square of 16 x 16 that is turned by t, in whose bits 0
    and 1 are whether coordinates are exchanged and whether they are complemented: the cell's place along the
    curve, times 4, and how the cell is turned.
    """
    table = np.empty(4 * 256, np.uint16)
    for row in range(len(table)):
        exchanged, complemented = row >> 8 & 1, row >> 9
        place = 0
        for i in (3, 2, 1, 0):
            rx, ry = row >> 4 + i & 1 ^ complemented, row >> i & 1 ^ complemented
            if exchanged:
                rx, ry = ry, rx
            place = place << 2 | (3 * rx) ^ ry
            if ry == 0:
                exchanged, complemented = 1 - exchanged, complemented ^ rx
        table[row] = place << 2 | complemented << 1 | exchanged
    return table


_TURNS = _turns()
_COORDINATE_BITS = 24


@cached_njit(nogil=True, forceinline=True)
def _hilbert(x, y):
    """The place of cell (x, y), of 2^24 a side, along Hilbert's curve."""
    place, turn = np.uint64(0), np.int64(0)
    for shift in (20, 16, 12, 8, 4, 0):
        entry = _TURNS[256 * turn + 16 * ((x >> shift) & 15) + ((y >> shift) & 15)]
        place = (place << np.uint64(8)) | np.uint64(entry >> 2)
        turn = np.int64(entry & 3)
    return place


@cached_njit(nogil=True)
def _keys(points, low_x, low_y, half, scale, bits, index_bits, out, begin):
    """Places along the curve, of 2^bits cells a side, with the numbers of the sites in the low bits; of as
    many sites from ``begin`` on as there is room for.

    Differences are rounded, alike for equal coordinates: equal sites get equal places, and no more is built
    upon it. ``half`` is 1, or 0.5 where differences would overflow.
    """
    top = (1 << bits) - 1
    finer = _COORDINATE_BITS - bits
    low_x, low_y = low_x * half, low_y * half
    for i in range(begin, begin + len(out)):
        x = min(np.int64((points[i, 0] * half - low_x) * scale), top)
        y = min(np.int64((points[i, 1] * half - low_y) * scale), top)
        place = _hilbert(x << finer, y << finer) >> np.uint64(2 * finer)
        out[i - begin] = (place << np.uint64(index_bits)) | np.uint64(i)


@cached_njit(nogil=True)
def _extent(points):
    low_x = high_x = points[0, 0]
    low_y = high_y = points[0, 1]
    for i in range(len(points)):
        low_x, high_x = min(low_x, points[i, 0]), max(high_x, points[i, 0])
        low_y, high_y = min(low_y, points[i, 1]), max(high_y, points[i, 1])
    half = 1.0 if max(high_x - low_x, high_y - low_y) < np.inf else 0.5
    return low_x, low_y, half, max(high_x * half - low_x * half, high_y * half - low_y * half)


def along_curve(points: np.ndarray, threads: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Sites sorted along Hilbert's curve, and pairs (a later copy, the first one): int64 (m,), int32 (k, 2).

    ``points`` are float64 (n, 2), finite. Of equal sites the one of least index is kept. Whether two are
    equal is decided by comparing coordinates; cells may be crowded, where a set has all magnitudes of float64
    even with all sites but a few.
    """
    n = len(points)
    index_bits = max(1, int(n - 1).bit_length())
    bits = min(_COORDINATE_BITS, (64 - index_bits) // 2)
    low_x, low_y, half, extent = _extent(points)
    # 2^bits / extent may overflow where a set is smaller: that is one cell. Where sites have been scaled, it
    # has no area
    scale = 2.0**bits / extent if extent > 2.0**-900 else 0.0
    keys = sort_runs(threads, n, partial(_keys, points, low_x, low_y, half, scale, bits, index_bits))
    index = (keys & np.uint64((1 << index_bits) - 1)).astype(np.int64)
    keys >>= np.uint64(index_bits)
    same = keys[1:] == keys[:-1]
    if not same.any():
        return index, np.empty((0, 2), np.int32)
    # equal sites are in one cell of the curve
    shared_cell = np.zeros(n, bool)
    shared_cell[1:] |= same
    shared_cell[:-1] |= same
    among = np.sort(index[shared_cell])
    _, pairs = first_copies(points[among])
    pairs = among[pairs].astype(np.int32)
    copy = np.zeros(n, bool)
    copy[pairs[:, 0]] = True
    return index[~copy[index]], pairs


@cached_njit(nogil=True)
def mixed(i, seed):
    """64 random bits for number i: SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014)."""
    z = np.uint64(i) + np.uint64(seed) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(0x632BE59BD9B4E019)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return z ^ (z >> np.uint64(31))


@cached_njit(nogil=True)
def _round_of(i, seed, rounds):
    """The round of site i: the last with probability 1/2, the one before with 1/4, and so on."""
    z = mixed(i, seed)
    r = rounds - 1
    while r > 0 and z & np.uint64(1):
        z >>= np.uint64(1)
        r -= 1
    return r


@cached_njit(nogil=True)
def _sort_rounds(part, parts, seed, rounds):
    count = np.zeros(parts * rounds + 1, np.int64)
    n = len(part)
    key = np.empty(n, np.int32)
    for i in range(n):
        key[i] = part[i] * rounds + _round_of(i, seed, rounds)
        count[key[i] + 1] += 1
    for k in range(parts * rounds):
        count[k + 1] += count[k]
    starts = count.copy()
    out = np.empty(n, np.int64)
    for i in range(n):
        out[count[key[i]]] = i
        count[key[i]] += 1
    return out, starts


def rounds_of(n: int) -> int:
    """How many rounds n sites make."""
    return max(1, min(MOST_ROUNDS, int(n // SMALLEST_ROUND).bit_length()))


def brio(part: np.ndarray, parts: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Sites 0 .. n-1, numbered along the curve, part by part, and in each part round by round.

    Parameters
    ----------
    part : int32 (n,)
        The part of each site, from 0 to parts - 1.
    parts, seed : int

    Returns
    -------
    order : int64 (n,)
    starts : int64 (parts, rounds + 1)
        Where in ``order`` the rounds of each part begin, and where the last one ends.
    """
    rounds = rounds_of(len(part))
    order, starts = _sort_rounds(part, parts, seed, rounds)
    begin = starts[: parts * rounds].reshape(parts, rounds)
    return order, np.column_stack([begin, starts[rounds::rounds]])
