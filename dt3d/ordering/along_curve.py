"""Sites sorted along Hilbert's curve, where equal sites are neighbours and are found."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from .._errors import InternalError
from .._numba.kernel_cache import cached_njit
from ..predicates.lexicographic import before
from .duplicates import copies_among
from .hilbert import PLANE_BITS, SPACE_BITS, Grid, keys_in_plane, keys_in_space
from .sorting import sort_runs

SHORT_RUN = 128  # sites in one cell that are sorted by coordinates; more are placed on a finer curve
# Curves within cells within cells. Sites are fewer than 2^31, so places have at least 10 bits per coordinate,
# and a cell, with what rounding lets in, is less than 2^-9 of the box around. A box is smaller than 2^1025,
# and no two floating-point numbers are nearer than 2^-1074.
MOST_LEVELS = (1025 + 1074) // 9 + 2
LEAST_EXTENT = 2.0**-900  # whose reciprocal, times 2^24, does not overflow


def along_curve_in_plane(sites: np.ndarray, threads: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Return the distinct sites along the curve, int64 (m,), and pairs (a copy, the first one), int32 (k, 2).

    Of equal sites the one of least index is kept. Whether two are equal is decided by comparing coordinates.
    Cells may be crowded, where a set has all magnitudes of float64 even with all sites but a few.

    Parameters
    ----------
    sites : float64 (n, 2)
        Finite.
    threads : int
        Runs that are sorted at the same time, at most.
    """
    n = len(sites)
    grid = _grid(sites, PLANE_BITS, 64)
    # where a set is smaller, 2^bits / extent may overflow: that is one cell. Where sites have been scaled, it
    # has no area
    if grid.first != 1.0 or grid.scale == np.inf:
        grid = grid._replace(first=1.0, scale=0.0)
    keys = sort_runs(threads, n, partial(keys_in_plane, sites, grid))
    index = (keys & np.uint64((1 << grid.index_bits) - 1)).astype(np.int64)
    keys >>= np.uint64(grid.index_bits)
    same = keys[1:] == keys[:-1]
    if not same.any():
        return index, np.empty((0, 2), np.int32)
    shared_cell = np.zeros(n, bool)
    shared_cell[1:] |= same
    shared_cell[:-1] |= same
    pairs = copies_among(sites, index[shared_cell])
    copy = np.zeros(n, bool)
    copy[pairs[:, 0]] = True
    return index[~copy[index]], pairs


def along_curve_in_space(
    sites: np.ndarray, in_pieces: Callable[[Callable[[int, int], None], int], None]
) -> np.ndarray:
    """Return the rows of sites along the curve, int64 (n,); equal sites together, by index.

    What shares a cell is put on a curve of its own, or sorted by the coordinates themselves.

    Parameters
    ----------
    sites : float64 (n, 3)
        Finite.
    in_pieces : function
        ``in_pieces(work, n)`` calls ``work(begin, end)`` for all of range(n), in pieces, at the same time
        perhaps.

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


def along_curve(points: np.ndarray) -> np.ndarray:
    """Return the rows of points, float64 (n, 2) or (n, 3), along the curve: int64 (n,).

    Parameters
    ----------
    points : float64 (n, 2) or (n, 3)
        Finite; equal ones may be among them.
    """
    if len(points) < 2:
        return np.arange(len(points))
    in_space = np.zeros((len(points), 3))
    in_space[:, : points.shape[1]] = points
    return along_curve_in_space(in_space, lambda work, n: work(0, n))


def _along_one_curve(
    sites: np.ndarray, in_pieces: Callable[[Callable[[int, int], None], int], None]
) -> tuple[np.ndarray, np.ndarray]:
    """Return sites along the curve through their box, int64 (n,), and the long runs in it, int64 (k, 2).

    A run, from begin to end - 1, shares a cell. In the long ones sites are sorted by index alone.
    """
    n = len(sites)
    grid = _grid(sites, SPACE_BITS, 63)
    if grid.scale == np.inf:  # all sites are equal
        return np.arange(n), np.empty((0, 2), np.int64)
    keys = np.empty(n, np.int64)
    words = keys.view(np.uint64)
    in_pieces(lambda i, j: keys_in_space(sites, grid, words[i:j], i), n)
    keys.sort()
    long_runs = np.empty((n // SHORT_RUN + 1, 2), np.int64)
    count = _sort_short_runs(sites, keys, grid.index_bits, long_runs)
    for begin, end in long_runs[:count].tolist():
        keys[begin:end].sort()
    return keys, long_runs[:count]


def _grid(sites: np.ndarray, most_bits: int, key_bits: int) -> Grid:
    """Return the grid of the cube around sites, with as many cells as keys have bits for; see `Grid`.

    Where all sites are equal its scale is infinite.
    """
    low, high = bounds(sites)
    part = 1.0
    with np.errstate(over="ignore"):
        extent = float((high - low).max())
    if extent == np.inf:
        part = 0.25
        extent = float((high * part - low * part).max())
    first = 1.0 if extent >= LEAST_EXTENT else 1 / LEAST_EXTENT
    index_bits = max(1, int(len(sites) - 1).bit_length())
    bits = min(most_bits, (key_bits - index_bits) // sites.shape[1])
    scale = 2.0**bits / (extent * first) if extent else np.inf
    return Grid(tuple((low * part).tolist()), part, first, scale, bits, index_bits)


@cached_njit(nogil=True)
def bounds(sites):
    """Return the least and the greatest corner of the box of sites float64 (n, d): float64 (2, d)."""
    n, d = sites.shape
    box = np.empty((2, d))
    for k in range(d):
        low = high = even_low = even_high = sites[0, k]
        # two chains of comparisons, which a processor follows at the same time
        for i in range(1, n - 1, 2):
            low, high = min(low, sites[i, k]), max(high, sites[i, k])
            even_low, even_high = min(even_low, sites[i + 1, k]), max(even_high, sites[i + 1, k])
        low, high = min(low, even_low, sites[n - 1, k]), max(high, even_high, sites[n - 1, k])
        box[0, k], box[1, k] = low, high
    return box


@cached_njit(nogil=True)
def _sort_short_runs(sites, keys, index_bits, long_runs):
    """Replace keys by indices, sorted by coordinates within short runs of one place.

    Returns the number of long runs, which are written; their indices are in no order.
    """
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
                while k > i and before(sites, site, keys[k - 1]):
                    keys[k] = keys[k - 1]
                    k -= 1
            keys[k] = site
            j += 1
        if j - i > SHORT_RUN:
            long_runs[count, 0], long_runs[count, 1] = i, j
            count += 1
        i = j
    return count


@cached_njit(nogil=True)
def gather(sites, order, rows, begin, end):
    """Put sites float64 (n, 3) in order, into rows of four words, from place begin to end - 1."""
    for i in range(begin, end):
        for k in range(3):
            rows[4 * i + k] = sites[order[i], k]
        rows[4 * i + 3] = 0.0
