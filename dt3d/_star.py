"""Simplices that contain a point on a border of them: the star of the face on which it lies."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ._numba.kernel_cache import cached_njit
from ._numba.unowned import unowned
from ._topology import OUTSIDE
from .predicates.plane import orient2d
from .predicates.space import orient3d


class Complex(NamedTuple):
    """Simplices in the plane or in space, and rows for the points that are located in them."""

    rows: npt.NDArray[np.float64]  # (n + threads, d): the sites; then for each thread the point at hand
    simplices: npt.NDArray[np.int32]  # (m, d + 1)
    neighbors: npt.NDArray[np.int32]  # (m, d + 1)
    convex: bool  # whether the simplices are known to fill a convex hull


@cached_njit
def side_of_facet(cells, t, k, q, w):
    """Where row q lies of the facet opposite the k-th vertex of t: positive on the side of t, 0 on it."""
    rows, simplices = cells.rows, cells.simplices
    a = q if k == 0 else simplices[t, 0]
    b = q if k == 1 else simplices[t, 1]
    c = q if k == 2 else simplices[t, 2]
    if simplices.shape[1] == 3:
        return orient2d(rows, a, b, c, w)
    d = q if k == 3 else simplices[t, 3]
    return orient3d(rows, a, b, c, d, w)


@cached_njit(nogil=True)
def find_beside(cells, kept, q, points, found, out, w):
    """For each point, copied to row q and in simplex found, write a kept simplex that contains it, if any.

    Facets with the point on them lead from one simplex of its star to all others.
    """
    cells, w = unowned(cells), unowned(w)
    seen = np.zeros(len(cells.simplices), np.bool_)
    star = np.empty(64, np.int32)
    for i in range(len(points)):
        for k in range(points.shape[1]):
            cells.rows[q, k] = points[i, k]
        star[0], count, done = found[i], 1, 0
        seen[found[i]] = True
        while done < count and out[i] == OUTSIDE:
            t = star[done]
            done += 1
            if kept[t]:
                out[i] = t
                break
            for k in range(cells.simplices.shape[1]):
                u = cells.neighbors[t, k]
                if u == OUTSIDE or seen[u] or side_of_facet(cells, t, k, q, w) != 0:
                    continue
                if count == len(star):
                    longer = np.empty(2 * count, np.int32)
                    longer[:count] = star
                    star = longer
                star[count] = u
                count += 1
                seen[u] = True
        for j in range(count):
            seen[star[j]] = False
