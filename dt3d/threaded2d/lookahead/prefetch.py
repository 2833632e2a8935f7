"""Asking for what the next steps need: around a triangle, and beyond its neighbours."""

from __future__ import annotations

from ..._numba.kernel_cache import cached_njit
from ..._numba.prefetch import prefetch
from ..mesh import NEIGHBOR


@cached_njit(forceinline=True)
def prefetch_around(points, nodes, t):
    """Ask for the vertices of t, which is at hand, and for its neighbours."""
    for k in range(3):
        prefetch(nodes, nodes[t, NEIGHBOR + k] >> 2)
        prefetch(points, nodes[t, k])


@cached_njit(forceinline=True)
def prefetch_beyond(points, nodes, t):
    """Ask for the far vertices of the neighbours of t, which are at hand, and what lies beyond them."""
    for k in range(3):
        edge = nodes[t, NEIGHBOR + k]
        u, j = edge >> 2, edge & 3
        prefetch(points, nodes[u, j])
        prefetch(nodes, nodes[u, NEIGHBOR + (j + 1) % 3] >> 2)
        prefetch(nodes, nodes[u, NEIGHBOR + (j + 2) % 3] >> 2)
