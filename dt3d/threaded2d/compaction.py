"""What is left in the end: the triangles without infinite vertex, without gaps.

Nodes are numbered chunk by chunk; the threads take chunks in turn, as what is left is mostly of late.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import numpy as np

from .._numba.kernel_cache import cached_njit
from .._numba.threads import run_short_tasks
from . import columns as c
from .columns import triangle

CHUNK_BITS = 14  # of a node's number within its chunk


Room = Callable[[int], tuple[np.ndarray, np.ndarray]]


class Triangles(NamedTuple):
    """Finite triangles, their neighbours, and the threads that made them."""

    triangles: np.ndarray  # int32 (m, 3)
    neighbors: np.ndarray  # int32 (m, 3)
    thread: np.ndarray  # int16 (m,)


@cached_njit(nogil=True)
def _number(nodes, first, step, number, counts):
    """Number the finite leaves of each chunk from 0 on, -1 for other nodes, and count them.

    Of the chunks first, first + step, ...
    """
    for chunk in range(first, len(counts), step):
        m = 0
        for t in range(chunk << CHUNK_BITS, min((chunk + 1) << CHUNK_BITS, len(nodes))):
            if nodes[t, c.CHILD] < 0 and min(nodes[t, 0], nodes[t, 1], nodes[t, 2]) >= 0:
                number[t] = m
                m += 1
            else:
                number[t] = -1
        counts[chunk] = m


@cached_njit(nogil=True)
def _write(nodes, first, step, number, before, site, out):
    """Write the finite leaves of chunks; ``before`` counts those of the chunks before each."""
    for chunk in range(first, len(before), step):
        for t in range(chunk << CHUNK_BITS, min((chunk + 1) << CHUNK_BITS, len(nodes))):
            if number[t] >= 0:
                s = number[t] + before[chunk]
                for k in range(3):
                    out.triangles[s, k] = site[nodes[t, k]]
                    u = triangle(nodes[t, c.NEIGHBOR + k])
                    out.neighbors[s, k] = number[u] + before[u >> CHUNK_BITS] if number[u] >= 0 else -1
                out.thread[s] = -1 - nodes[t, c.CHILD]


def compact(
    nodes: np.ndarray,
    site: np.ndarray,
    threads: int = 1,
    room: Room | None = None,
) -> Triangles:
    """The finite triangles among the nodes that are used, int32 (used, 8).

    ``site`` holds the number of each row of the points, int (n,). ``room(m)`` gives the arrays that
    triangles and neighbours are written into, int32 (m, 3) in C order, and may raise where there is none; by
    default they are new.
    """
    used = len(nodes)
    chunks = -(-used >> CHUNK_BITS)
    threads = min(threads, chunks)
    number, counts = np.empty(used, np.int32), np.empty(chunks, np.int32)
    run_short_tasks([partial(_number, nodes, k, threads, number, counts) for k in range(threads)])
    before = np.cumsum(counts, dtype=np.int32) - counts
    m = int(counts.sum())
    triangles, neighbors = (room or _new)(m)
    out = Triangles(triangles, neighbors, np.empty(m, np.int16))
    run_short_tasks([partial(_write, nodes, k, threads, number, before, site, out) for k in range(threads)])
    return out


def _new(m: int) -> tuple[np.ndarray, np.ndarray]:
    return np.empty((m, 3), np.int32), np.empty((m, 3), np.int32)
