"""The order of sites in memory and of their insertion.

In memory sites lie along a Hilbert curve, where equal sites are neighbours and are found. They are
inserted in random rounds, each several times as large as all before it, along the curve within (N. Amenta,
S. Choi, G. Rote: Incremental constructions con BRIO. SoCG 2003): the rounds keep the expected cost of a
randomised insertion, the curve keeps consecutive sites, and their tetrahedra, near each other in memory.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .._errors import InternalError
from .._numba.kernel_cache import cached_njit
from .curve import hilbert_keys

ROUND_BITS = 2  # a site is in the last round unless as many bits of its hash are zero, and so on
SMALLEST_ROUND = 64
MOST_BITS = 21  # of a coordinate's place on the curve
SHORT_RUN = 128  # sites in one cell that are sorted by coordinates; more are placed on a finer curve
# Curves within cells within cells. Sites are fewer than 2^31, so places have at least 10 bits per coordinate,
# and a cell, with what rounding lets in, is less than 2^-9 of the box around. A box is smaller than 2^1025,
# and no two floating-point numbers are nearer than 2^-1074.
MOST_LEVELS = (1025 + 1074) // 9 + 2
LEAST_EXTENT = 2.0**-900  # whose reciprocal, times 2^21, does not overflow


def along_curve(
    sites: np.ndarray, in_pieces: Callable[[Callable[[int, int], None], int], None]
) -> np.ndarray:
    """The rows of sites float64 (n, 3) along a Hilbert curve, int64 (n,); equal sites together, by index.

    ``in_pieces(work, n)`` calls ``work(begin, end)`` for all of range(n), in pieces, at the same time
    perhaps. The place on the curve is rounded, but a function of the coordinates alone, so equal sites have
    one place. What shares a place is put on a curve of its own, or sorted by the coordinates themselves.

    Raises
    ------
    InternalError
        If cells lie within cells beyond all bounds.
    """
    order = np.arange(len(sites))
    crowded = [(0, len(sites), 0)]
    while crowded:
        begin, end, level = crowded.pop()
        if level > MOST_LEVELS:
            msg = f"{end - begin} sites share a cell after {level} subdivisions"
            raise InternalError(msg)
        part = order[begin:end]
        places, runs = _along_one_curve(sites if level == 0 else sites[part], in_pieces)
        part[:] = part[places]
        crowded += [(begin + i, begin + j, level + 1) for i, j in runs.tolist()]
    return order


def _along_one_curve(
    sites: np.ndarray, in_pieces: Callable[[Callable[[int, int], None], int], None]
) -> tuple[np.ndarray, np.ndarray]:
    """Sites along the curve through their box, int64 (n,); and the runs in it, int64 (k, 2), from begin to
    end - 1, that share a cell and are sorted by index alone."""
    n = len(sites)
    low, high = bounds(sites)
    part = 1.0
    with np.errstate(over="ignore"):
        extent = float((high - low).max())
    if extent == np.inf:
        part = 0.25
        extent = float((high * part - low * part).max())
    if not extent:
        return np.arange(n), np.empty((0, 2), np.int64)
    first = 1.0 if extent >= LEAST_EXTENT else 1 / LEAST_EXTENT
    index_bits = max(1, int(n - 1).bit_length())
    bits = min(MOST_BITS, (63 - index_bits) // 3)
    scale = 2.0**bits / (extent * first)
    keys = np.empty(n, np.int64)
    in_pieces(lambda i, j: hilbert_keys(sites, low, part, first, scale, bits, index_bits, i, j, keys), n)
    keys.sort()
    long_runs = np.empty((n // SHORT_RUN + 1, 2), np.int64)
    count = _sort_short_runs(sites, keys, index_bits, long_runs)
    return keys, long_runs[:count]


@cached_njit(nogil=True)
def bounds(sites):
    """The least and the greatest corner of the box of sites float64 (n, 3), float64 (2, 3)."""
    box = np.empty((2, 3))
    for k in range(3):
        box[0, k] = box[1, k] = sites[0, k]
    for i in range(len(sites)):
        for k in range(3):
            box[0, k] = min(box[0, k], sites[i, k])
            box[1, k] = max(box[1, k], sites[i, k])
    return box


@cached_njit(nogil=True)
def _sort_short_runs(sites, keys, index_bits, long_runs):
    """Replace keys by indices, sorted by coordinates within short runs of one position; returns the long
    ones."""
    n, mask, count = len(keys), (1 << index_bits) - 1, 0
    i = 0
    while i < n:
        position = keys[i] >> index_bits
        j = i
        while j < n and keys[j] >> index_bits == position:
            site = keys[j] & mask
            # insertion sort, which leaves equal sites in the order of their indices
            k = j
            if j - i < SHORT_RUN:
                while k > i and _before(sites, site, keys[k - 1]):
                    keys[k] = keys[k - 1]
                    k -= 1
            keys[k] = site
            j += 1
        if j - i > SHORT_RUN:
            keys[i:j].sort()
            long_runs[count, 0], long_runs[count, 1] = i, j
            count += 1
        i = j
    return count


@cached_njit
def _before(sites, a, b):
    for k in range(3):
        if sites[a, k] != sites[b, k]:
            return sites[a, k] < sites[b, k]
    return False


@cached_njit(nogil=True)
def gather(sites, order, rows, begin, end):
    """Put sites float64 (n, 3) in order, into rows of four (see `mesh`), from place begin to end - 1."""
    for i in range(begin, end):
        for k in range(3):
            rows[4 * i + k] = sites[order[i], k]
        rows[4 * i + 3] = 0.0


@cached_njit(nogil=True)
def copied(rows, begin, end):
    """Whether a row from begin to end - 1 equals the one before it."""
    for i in range(max(begin, 1), end):
        j = 4 * i
        if rows[j] == rows[j - 4] and rows[j + 1] == rows[j - 3] and rows[j + 2] == rows[j - 2]:
            return True
    return False


@cached_njit(nogil=True)
def separate_copies(sites, order):
    """Move the first of equal sites to the front of ``order``, as `along_curve` gave it; returns their
    number.

    Also the pairs (a later copy, the first one), int32 (k, 2), by the index of the copy.
    """
    n = len(order)
    distinct = 0
    copies = 0
    for i in range(n):
        if i == 0 or not _equal(sites, order[i], order[i - 1]):
            distinct += 1
    pairs = np.empty((n - distinct, 2), np.int32)
    distinct = 0
    previous = -1
    for i in range(n):
        site = order[i]
        if i > 0 and _equal(sites, site, previous):
            pairs[copies, 0], pairs[copies, 1] = site, order[distinct - 1]
            copies += 1
        else:
            order[distinct] = site
            distinct += 1
        previous = site
    return distinct, pairs[np.argsort(pairs[:, 0])]


@cached_njit
def _equal(sites, a, b):
    return sites[a, 0] == sites[b, 0] and sites[a, 1] == sites[b, 1] and sites[a, 2] == sites[b, 2]


@cached_njit(nogil=True)
def insertion_rounds(n, seed, left_out):
    """Sites 0 .. n-1 without four in rounds, ascending within each: uint32 (n - 4,), and where each round
    ends.

    Each site is in the last round with probability 3/4, in the one before with 3/16, and so on; the first
    has about `SMALLEST_ROUND`.
    """
    rounds = 1
    while n >> (ROUND_BITS * rounds) > SMALLEST_ROUND:
        rounds += 1
    level = np.empty(n, np.uint8)
    ends = np.zeros(rounds + 1, np.int64)
    for i in range(n):
        back = 0
        h = _mixed(np.uint64(i) + (np.uint64(seed) << np.uint64(32)))
        while back < rounds - 1 and h & np.uint64((1 << ROUND_BITS) - 1) == 0:
            h >>= np.uint64(ROUND_BITS)
            back += 1
        level[i] = rounds - 1 - back
    for site in left_out:
        level[site] = 255
    for i in range(n):
        if level[i] < 255:
            ends[level[i] + 1] += 1
    ends = np.cumsum(ends)
    order = np.empty(n - len(left_out), np.uint32)
    place = ends[:-1].copy()
    for i in range(n):
        if level[i] < 255:
            order[place[level[i]]] = i
            place[level[i]] += 1
    return order, ends[1:]


@cached_njit(inline="always")
def _mixed(x):
    """A number whose bits all depend on all bits of x (the finaliser of S. Vigna's splitmix64)."""
    x = (x + np.uint64(1)) * np.uint64(0x9E3779B97F4A7C15)
    x = (x ^ x >> np.uint64(30)) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ x >> np.uint64(27)) * np.uint64(0x94D049BB133111EB)
    return x ^ x >> np.uint64(31)
