"""Biased randomised insertion orders: rounds that grow by a factor at random, along the curve within each.

N. Amenta, S. Choi, G. Rote: Incremental constructions con BRIO. SoCG 2003. The rounds keep the expected cost
of a randomised insertion. The curve keeps consecutive sites, and what they change, near each other in memory.
"""

from __future__ import annotations

import numpy as np

from .._numba.kernel_cache import cached_njit
from .hashing import GOLDEN, finalised, mixed

SMALLEST_ROUND = 64  # sites, or about as many
SPACE_FACTOR_BITS = 2  # a round is four times as large as all before it,
PLANE_FACTOR_BITS = 1  # or as large
MOST_PLANE_ROUNDS = 24


@cached_njit(nogil=True)
def _round_of(bits, rounds, factor_bits):
    """Return the round of a site: the last one unless the low bits of a random number are zero, and so on."""
    mask = np.uint64((1 << factor_bits) - 1)
    last = rounds - 1
    while last > 0 and bits & mask == 0:
        bits >>= np.uint64(factor_bits)
        last -= 1
    return last


@cached_njit(nogil=True)
def insertion_rounds(n, seed, left_out):
    """Return sites 0 .. n-1 without four, round by round, uint32 (n - 4,), and where each round ends.

    Sites ascend within a round. A site is in the last round with probability 3/4, in the one before with
    3/16, and so on. The first round has about `SMALLEST_ROUND` sites.
    """
    rounds = 1
    while n >> (SPACE_FACTOR_BITS * rounds) > SMALLEST_ROUND:
        rounds += 1
    level = np.empty(n, np.uint8)
    ends = np.zeros(rounds + 1, np.int64)
    for i in range(n):
        bits = finalised((np.uint64(i) + (np.uint64(seed) << np.uint64(32)) + np.uint64(1)) * GOLDEN)
        level[i] = _round_of(bits, rounds, SPACE_FACTOR_BITS)
    for site in left_out:
        level[site] = 255
    for i in range(n):
        if level[i] < 255:
            ends[level[i] + 1] += 1
    for k in range(rounds):
        ends[k + 1] += ends[k]
    order = np.empty(n - len(left_out), np.uint32)
    place = ends[:-1].copy()
    for i in range(n):
        if level[i] < 255:
            order[place[level[i]]] = i
            place[level[i]] += 1
    return order, ends[1:]


@cached_njit(nogil=True)
def _sort_rounds(part, parts, seed, rounds):
    count = np.zeros(parts * rounds + 1, np.int64)
    n = len(part)
    key = np.empty(n, np.int32)
    for i in range(n):
        key[i] = part[i] * rounds + _round_of(~mixed(i, seed), rounds, PLANE_FACTOR_BITS)
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
    """Return how many rounds n sites of the plane make."""
    return max(1, min(MOST_PLANE_ROUNDS, int(n // SMALLEST_ROUND).bit_length()))


def brio(part: np.ndarray, parts: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return sites 0 .. n-1, numbered along the curve, part by part, and in each part round by round.

    Parameters
    ----------
    part : int32 (n,)
        The part of each site, from 0 to parts - 1.
    parts : int
        How many parts there are.
    seed : int
        Another one gives other rounds.

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
