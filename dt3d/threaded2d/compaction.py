"""What is left in the end: the triangles without infinite vertex, without gaps.

Nodes are numbered piece by piece; the threads take pieces in turn, as what is left is mostly of late.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from .._numba.kernel_cache import cached_njit
from .._numba.threads import run_short_tasks
from .mesh import CHILD, NEIGHBOR

PIECE_BITS = 14  # of a node's number within its piece


@cached_njit(nogil=True)
def _number(nodes, used, first, step, number, counts):
    """Number the finite leaves of each piece from 0 on, -1 for other nodes, and count them; of the pieces
    first, first + step, ..."""
    for piece in range(first, len(counts), step):
        m = 0
        for t in range(piece << PIECE_BITS, min((piece + 1) << PIECE_BITS, used)):
            if nodes[t, CHILD] < 0 and min(nodes[t, 0], nodes[t, 1], nodes[t, 2]) >= 0:
                number[t] = m
                m += 1
            else:
                number[t] = -1
        counts[piece] = m


@cached_njit(nogil=True)
def _collect(nodes, used, first, step, number, before, site, triangles, neighbors, maker):
    """Write the finite leaves of pieces; ``before`` each are so many of other pieces."""
    for piece in range(first, len(before), step):
        for t in range(piece << PIECE_BITS, min((piece + 1) << PIECE_BITS, used)):
            if number[t] >= 0:
                s = number[t] + before[piece]
                for k in range(3):
                    triangles[s, k] = site[nodes[t, k]]
                    u = nodes[t, NEIGHBOR + k] >> 2
                    neighbors[s, k] = number[u] + before[u >> PIECE_BITS] if number[u] >= 0 else -1
                maker[s] = -1 - nodes[t, CHILD]


def compact(
    nodes: np.ndarray, used: int, site: np.ndarray, threads: int = 1
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Finite triangles, their neighbours, and the threads that made them: int32 (m, 3), (m, 3), int16 (m,).

    ``site`` holds the number of each row of the points, int (n,).
    """
    pieces = -(-used >> PIECE_BITS)
    threads = min(threads, pieces)
    number, counts = np.empty(used, np.int32), np.empty(pieces, np.int32)
    run_short_tasks([partial(_number, nodes, used, k, threads, number, counts) for k in range(threads)])
    before = np.cumsum(counts, dtype=np.int32) - counts
    m = int(counts.sum())
    triangles, neighbors = np.empty((m, 3), np.int32), np.empty((m, 3), np.int32)
    maker = np.empty(m, np.int16)
    out = (number, before, site, triangles, neighbors, maker)
    run_short_tasks([partial(_collect, nodes, used, k, threads, *out) for k in range(threads)])
    return triangles, neighbors, maker
