"""How deep below the hull each simplex lies: a search through the simplices, level by level."""

from __future__ import annotations

import numpy as np

from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from .._topology import OUTSIDE


@cached_njit(nogil=True)
def _spread(neighbors, depth, queue):
    """Write the depths; ``depth`` is -1 at first, and ``queue`` has room for all simplices."""
    neighbors, depth, queue = unowned(neighbors), unowned(depth), unowned(queue)
    facets = neighbors.shape[1]
    end = 0
    for t in range(len(neighbors)):
        for k in range(facets):
            if neighbors[t, k] == OUTSIDE and depth[t] < 0:
                depth[t] = 0
                queue[end] = t
                end += 1
    begin = 0
    while begin < end:
        t = queue[begin]
        begin += 1
        for k in range(facets):
            beside = neighbors[t, k]
            if beside != OUTSIDE and depth[beside] < 0:
                depth[beside] = depth[t] + 1
                queue[end] = beside
                end += 1


def depths(neighbors: np.ndarray) -> np.ndarray:
    """How many facets lie between each simplex and the hull, int32 (m,).

    It is the distance in the graph of simplices with a common facet from those that have a facet without
    neighbour. -1 for simplices that no path joins with these, which damaged meshes may have.

    Parameters
    ----------
    neighbors : int (m, d + 1)
        `OUTSIDE` where there is none.
    """
    depth = np.full(len(neighbors), -1, np.int32)
    _spread(np.ascontiguousarray(neighbors, np.int32), depth, np.empty(len(neighbors), np.int32))
    return depth
