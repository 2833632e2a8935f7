"""Random bits for numbers: SplitMix64 (G. L. Steele, D. Lea, C. H. Flood, OOPSLA 2014)."""

from __future__ import annotations

import numpy as np

from .._numba.kernel_cache import cached_njit

GOLDEN = np.uint64(0x9E3779B97F4A7C15)  # 2^64 divided by the golden ratio


@cached_njit(inline="always")
def finalised(z):
    """Return 64 bits, each of which depends on all bits of z, uint64."""
    z = (z ^ z >> np.uint64(30)) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ z >> np.uint64(27)) * np.uint64(0x94D049BB133111EB)
    return z ^ z >> np.uint64(31)


@cached_njit(nogil=True)
def mixed(i, seed):
    """Return 64 random bits for number i."""
    return finalised(np.uint64(i) + np.uint64(seed) * GOLDEN + np.uint64(0x632BE59BD9B4E019))
