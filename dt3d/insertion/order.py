"""The order of insertion: random rounds that double in size, each along a space-filling curve.

N. Amenta, S. Choi, G. Rote: Incremental constructions con BRIO. SoCG 2003. The rounds keep the expected
cost of a randomised insertion; the Morton curve keeps consecutive sites, and their tetrahedra, near each
other in memory.
"""

from __future__ import annotations

import numpy as np

BITS = 21  # a coordinate, so that three fit into a 64-bit code
SMALLEST_ROUND = 64


def _spread(x: np.ndarray) -> np.ndarray:
    """The 21 low bits of each word, two zero bits between neighbours."""
    x = x & np.uint64(0x1FFFFF)
    for shift, mask in (
        (32, 0x1F00000000FFFF), (16, 0x1F0000FF0000FF), (8, 0x100F00F00F00F00F),
        (4, 0x10C30C30C30C30C3), (2, 0x1249249249249249),
    ):  # fmt: skip
        x = (x | x << np.uint64(shift)) & np.uint64(mask)
    return x


def morton_codes(sites: np.ndarray) -> np.ndarray:
    """Positions of sites (n, 3) along the Morton curve of their bounding box, uint64 (n,)."""
    low = sites.min(axis=0)
    extent = max(float((sites.max(axis=0) - low).max()), np.finfo(float).tiny)
    cells = np.minimum((sites - low) / extent * 2.0**BITS, 2.0**BITS - 1).astype(np.uint64)
    x, y, z = (_spread(cells[:, k]) for k in range(3))
    return x | y << np.uint64(1) | z << np.uint64(2)


def insertion_order(n: int, seed: int = 0) -> np.ndarray:
    """Indices 0 .. n-1 of sites that are in Morton order, in rounds; int32 (n,).

    Each site is in the last round with probability 1/2, in the one before with 1/4, and so on; within a
    round the sites keep their order.
    """
    rounds = max(1, int(np.log2(max(n, 1) / SMALLEST_ROUND)) + 1) if n > SMALLEST_ROUND else 1
    back = np.random.default_rng(seed).geometric(0.5, n)  # rounds from the end, from 1
    level = np.maximum(rounds - back, 0)
    return np.argsort(level, kind="stable").astype(np.int32)
