"""The value of the nearest site."""

from __future__ import annotations

from functools import cached_property
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from .._numba.kernel_cache import cached_njit
from .._topology import OUTSIDE
from ..delaunay import Delaunay
from ..geometry.measures import scaled_sites
from ..geometry.pairs import in_pieces
from .base import Interpolator


@cached_njit(nogil=True)
def _descend(points, indptr, indices, start, xi, begin, end, out):
    """Write the site nearest to each point, by steps to nearer neighbours from the sites of ``start``."""
    d = points.shape[1]
    for i in range(begin, end):
        site = start[i]
        if site < 0:
            out[i] = OUTSIDE
            continue
        least = 0.0
        for j in range(d):
            least += (points[site, j] - xi[i, j]) ** 2
        moved = True
        while moved:
            moved = False
            for e in range(indptr[site], indptr[site + 1]):
                square = 0.0
                for j in range(d):
                    square += (points[indices[e], j] - xi[i, j]) ** 2
                # of the least distances the least number, so that no two sites are taken in turn for ever
                if square < least or (square == least and indices[e] < site):
                    site, least, moved = indices[e], square, True
                    break
        out[i] = site


class Nearest(Interpolator):
    """The value of the nearest site.

    In place of `scipy.interpolate.NearestNDInterpolator` for points in the plane and in space. The search
    goes to a nearer neighbour until there is none: in a Delaunay triangulation that is the nearest of all
    sites (P. Bose, P. Morin: Online routing in triangulations, SIAM Journal on Computing 33, 2004).

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

    def __init__(
        self, points: npt.ArrayLike | Delaunay, values: npt.ArrayLike, rescale: bool = False
    ) -> None:
        super().__init__(points, values, np.nan, rescale)
        if not isinstance(self.tri, Delaunay):
            msg = "Nearest needs a whole triangulation, got a part of one; pass part.whole"
            raise ValueError(msg)

    def sites(self, *xi: npt.ArrayLike) -> np.ndarray:
        """The site nearest to each point.

        Parameters
        ----------
        *xi : array_like, real
            Points as in `__call__`.

        Returns
        -------
        int32 (...)
            Rows of `points`; of several that are nearest, one. -1 for points that are not finite.
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
        assert isinstance(tri, Delaunay)
        found = tri._locator.nearby(points)
        start = tri.simplices[found, 0]
        start[found < 0] = OUTSIDE
        # a walk may not find a point outside where the hull is not exact
        lost = (found < 0) & np.isfinite(points).all(axis=1)
        start[lost] = tri.simplices[0, 0]
        out = np.empty(len(points), np.int32)
        indptr, indices = self._graph
        sites, unit = scaled_sites(tri.points)
        queries = np.ascontiguousarray(points if unit == 1.0 else points / unit)
        in_pieces(
            lambda begin, end: _descend(sites, indptr, indices, start, queries, begin, end, out), len(points)
        )
        return out

    def _evaluate(self, points: np.ndarray, columns: np.ndarray) -> np.ndarray:
        sites = self._nearest(points)
        out: np.ndarray = columns[sites]
        self._fill(out, sites < 0)
        return out
