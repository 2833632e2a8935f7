"""The value of the nearest site.

From any site that is not nearest to a point an edge of the Delaunay triangulation leads to a nearer one,
wherever the point lies (P. Bose, P. Morin: Online routing in triangulations, SIAM Journal on Computing 33,
2004). Points are taken along a space-filling curve, so that few steps lead from one's nearest site to the
next's. Sites that are as near lie on an empty sphere, and edges between them connect them: all are found.
"""

from __future__ import annotations

from functools import cached_property
from typing import ClassVar

import numba
import numpy as np
import numpy.typing as npt

from .._given import PointsLike
from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from .._topology import OUTSIDE
from ..delaunay import Delaunay
from ..geometry.measures import scaled_sites
from ..geometry.pairs import in_pieces
from ..ordering.along_curve import along_curve
from .base import Interpolator

# Squared distances that differ by less than this part of them may be in the wrong order, by rounding. Both
# sites are searched, so that no descent ends before the nearest.
ROUNDING = 2.0**-49


@cached_njit(inline="always")
def _square(sites, v, x, y, z):
    """The squared distance of site v; z is 0 in the plane."""
    dx, dy = sites[v, 0] - x, sites[v, 1] - y
    if sites.shape[1] == 2:
        return dx * dx + dy * dy
    dz = sites[v, 2] - z
    return dx * dx + dy * dy + dz * dz


@cached_njit(nogil=True)
def _descend(sites, graph, points, order, begin, end, out):
    """Write the site nearest to each of points[order[begin:end]], from that of the point before.

    ``out[order[begin]]`` says where to begin: with any site that has edges.
    """
    sites, indptr, indices = unowned(sites), unowned(graph[0]), unowned(graph[1])
    stack = np.empty(64, np.int64)  # sites whose neighbours are to be looked at
    seen = np.full(len(sites), -1, np.int32)  # the last point for which a site was on the stack
    v = numba.int64(out[order[begin]])
    for j in range(begin, end):
        i = order[j]
        x, y, z = points[i, 0], points[i, 1], 0.0
        if sites.shape[1] == 3:
            z = points[i, 2]
        least = _square(sites, v, x, y, z)
        stack[0], count, seen[v] = v, 1, j
        while count:
            count -= 1
            at = stack[count]
            for e in range(indptr[at], indptr[at + 1]):
                u = numba.int64(indices[e])
                square = _square(sites, u, x, y, z)
                if square > least * (1.0 + ROUNDING) or seen[u] == j:
                    continue
                seen[u] = j
                nearer = square < least * (1.0 - ROUNDING)
                if square < least or (square == least and u < v):
                    least, v = square, u
                if nearer:
                    count = 0  # what waits is farther
                elif count == len(stack):
                    longer = np.empty(2 * count, np.int64)
                    longer[:count] = stack
                    stack = longer
                stack[count] = u
                count += 1
                if nearer:
                    break
        out[i] = v


class Nearest(Interpolator):
    """The value of the nearest site.

    In place of `scipy.interpolate.NearestNDInterpolator` for points in the plane and in space. Of sites that
    are as near, in float64, it is the one of least index.

    Parameters
    ----------
    points : array_like (n, 2) or (n, 3), or Delaunay
        The sites, or their triangulation.
    values : array_like, real or complex (n, ...)
        The value of each site, of any shape.
    rescale : bool
        Whether to scale points to a unit cube first; the nearest is then the nearest of the scaled ones.

    Raises
    ------
    ValueError
        If the points or values are not what they should be; the message says what came.

    Examples
    --------
    >>> from dt3d.interpolate import Nearest
    >>> f = Nearest([[0, 0], [1, 0], [0, 1], [1, 1]], [0, 1, 2, 3])
    >>> f([[0.9, 0.2], [7, 9]]).tolist(), f.sites([[0.2, 0.8]]).tolist()
    ([1.0, 3.0], [2])
    """

    def __init__(self, points: PointsLike | Delaunay, values: npt.ArrayLike, rescale: bool = False) -> None:
        super().__init__(points, values, np.nan, rescale)
        self._check_whole()

    def sites(self, *xi: npt.ArrayLike) -> np.ndarray:
        """The site nearest to each point.

        Parameters
        ----------
        *xi : array_like, real
            Points as in `__call__`.

        Returns
        -------
        int32 (...)
            Rows of `points`; of several that are nearest, the least. -1 for points that are not finite.

        Examples
        --------
        >>> from dt3d.interpolate import Nearest
        >>> f = Nearest([[0, 0], [2, 0], [0, 2], [2, 2]], [0, 1, 2, 3])
        >>> f.sites([[0.5, 0.4], [9, 9]]).tolist()
        [0, 3]
        """
        points, shape = self._queries(xi)
        return self._nearest(points).reshape(shape)

    _derived: ClassVar[tuple[str, ...]] = ("_graph",)

    @cached_property
    def _graph(self) -> tuple[np.ndarray, np.ndarray]:
        assert isinstance(self.tri, Delaunay)
        return self.tri.vertex_neighbor_vertices

    def _nearest(self, points: np.ndarray) -> np.ndarray:
        tri = self.tri
        sites, unit = scaled_sites(tri.points)
        queries = np.ascontiguousarray(points if unit == 1.0 else points / unit)
        rows = np.flatnonzero(np.isfinite(queries).all(axis=1))
        order = rows[along_curve(queries[rows])]
        out = np.full(len(points), OUTSIDE, np.int32)
        out[rows] = tri.simplices[0, 0]
        graph = self._graph
        if len(order):
            in_pieces(lambda i, j: _descend(sites, graph, queries, order, i, j, out), len(order))
        return out

    def _evaluate(self, points: np.ndarray, columns: np.ndarray) -> np.ndarray:
        sites = self._nearest(points)
        out: np.ndarray = columns[sites]
        self._fill(out, sites < 0)
        return out
