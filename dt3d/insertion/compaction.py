"""From the memory of a growing triangulation to arrays without gaps."""

from __future__ import annotations

import numpy as np

from .._numba.kernel_cache import cached_njit
from .layout import DEAD


@cached_njit(nogil=True)
def count_finite(mesh, begin, end):
    """How many of the slots begin .. end-1 hold tetrahedra that are not ghosts."""
    m = 0
    for t in range(begin, end):
        m += max(max(mesh[8 * t], mesh[8 * t + 1]), max(mesh[8 * t + 2], mesh[8 * t + 3])) < DEAD
    return m


@cached_njit(nogil=True)
def number_finite(mesh, begin, end, first, number):
    """Number them from ``first`` on; -1 for the others."""
    for t in range(begin, end):
        if max(max(mesh[8 * t], mesh[8 * t + 1]), max(mesh[8 * t + 2], mesh[8 * t + 3])) < DEAD:
            number[t] = first
            first += 1
        else:
            number[t] = -1


@cached_njit(nogil=True)
def write_finite(mesh, begin, end, number, original, simplices, neighbors):
    """Rows of the result: vertices by their indices in the input, neighbours by number, -1 beyond the
    hull."""
    for t in range(begin, end):
        s = number[t]
        if s >= 0:
            for k in range(4):
                simplices[s, k] = original[mesh[8 * t + k]]
                neighbors[s, k] = number[mesh[8 * t + 4 + k] >> np.uint32(2)]
