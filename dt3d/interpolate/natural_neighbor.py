"""Natural neighbour interpolation: weights and values."""

from __future__ import annotations

import os
import threading
from functools import cached_property, partial
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import numpy.typing as npt

from .._given import PointsLike
from .._memory import require
from .._numba.cores import available_cores
from .._numba.threads import run_short_tasks
from .._results import frozen
from .._star import Complex
from ..delaunay import Delaunay
from ..geometry.barycentric import barycentric_weights
from ..geometry.circumcenters import offsets_of_centers
from ..geometry.measures import scaled_sites
from ..ordering.along_curve import along_curve
from ..predicates import work_array
from .base import Interpolator
from .sibson import Scratch, Weights, natural_neighbors

if TYPE_CHECKING:
    import scipy.sparse

POINTS_AT_A_TIME = 2**17
LEAST_POINTS = 256  # worth a thread
ROOM = 32  # entries per point at first


class NaturalNeighbor(Interpolator):
    """Sibson's natural neighbour interpolation, in the plane and in space.

    The weight of a site is the part of the point's cell that the point would take from the site's cell, if it
    were a site itself (R. Sibson: A brief description of natural neighbour interpolation, 1981). It
    reproduces linear functions, has the data as its values at sites and is smooth elsewhere, but for the
    spheres through simplices, where the gradient is continuous.

    Parameters
    ----------
    points : array_like (n, 2) or (n, 3), or Delaunay
        The sites, or their triangulation.
    values : array_like, real or complex (n, ...)
        The value of each site, of any shape.
    fill_value : float or complex
        The value outside the convex hull, and at points that are not finite.
    rescale : bool
        Whether to scale points to a unit cube before they are triangulated; it changes who is a neighbour.

    Raises
    ------
    ValueError
        If the points or values are not what they should be; the message says what came.

    Notes
    -----
    On the convex hull, where what is taken has no bounds, values are limits from inside, to about 1e-11 of
    the local spacing, and there is no gradient. Where a cell is more than a billion times as long as wide,
    and rounding spoils its size, the value is that of linear interpolation.

    Examples
    --------
    >>> import numpy as np
    >>> from dt3d.interpolate import NaturalNeighbor
    >>> f = NaturalNeighbor([[0, 0], [1, 0], [0, 1], [1, 1]], [0, 1, 1, 0])
    >>> f([[0.5, 0.5], [0, 1], [2, 2]]).round(12).tolist()
    [0.5, 1.0, nan]
    >>> f.weights([[0.5, 0.5]]).toarray().round(12).tolist()
    [[0.25, 0.25, 0.25, 0.25]]
    """

    def __init__(
        self,
        points: PointsLike | Delaunay,
        values: npt.ArrayLike,
        fill_value: complex = np.nan,
        rescale: bool = False,
    ) -> None:
        super().__init__(points, values, fill_value, rescale)
        self._check_whole()

    _derived: ClassVar[tuple[str, ...]] = ("_arrays", "_scratch")

    def weights(self, *xi: npt.ArrayLike) -> scipy.sparse.csr_array:
        """The weight of each site at each point, as a sparse matrix.

        Parameters
        ----------
        *xi : array_like, real
            Points as in `__call__`, k in all.

        Returns
        -------
        scipy.sparse.csr_array, float64 (k, n)
            Rows sum to 1; those of points outside are empty. No weight is negative.

        Examples
        --------
        >>> from dt3d.interpolate import NaturalNeighbor
        >>> f = NaturalNeighbor([[0, 0], [2, 0], [0, 2], [2, 2]], [0, 1, 2, 3])
        >>> f.weights([[1, 1]]).toarray().round(12).tolist()
        [[0.25, 0.25, 0.25, 0.25]]
        """
        points, _ = self._queries(xi)
        return self._matrix(*self._weights(points, slopes=False)[:3])

    def gradient(self, *xi: npt.ArrayLike) -> np.ndarray:
        """The gradient of the interpolant.

        A cell that takes area or volume grows by the size of each of its faces times the distance between the
        point and the face's centroid, over the distance of the site beyond.

        Parameters
        ----------
        *xi : array_like, real
            Points as in `__call__`.

        Returns
        -------
        float64 or complex128 (..., d)
            The shape of the values there, and the d derivatives. NaN outside, at sites, where the
            interpolant has none, and on the hull.

        Examples
        --------
        >>> from dt3d.interpolate import NaturalNeighbor
        >>> f = NaturalNeighbor([[0, 0], [2, 0], [0, 2], [2, 2]], [0, 2, 4, 6])
        >>> f.gradient([[1, 0.5]]).round(12).tolist()
        [[1.0, 2.0]]
        """
        points, shape = self._queries(xi)
        columns, d = self._columns(), self.tri.ndim
        out = np.full((len(points), columns.shape[1], d), np.nan)
        for rows in _parts(points):
            counts, indices, _, slopes = self._weights(points[rows], slopes=True)
            for k in range(d):
                values = self._matrix(counts, indices, slopes[:, k]) @ columns
                out[rows, :, k] = np.where(counts[:, None] > 0, values, np.nan)
        return self._derivatives(out if self._scale is None else out / self._scale, shape)

    def _evaluate(self, points: np.ndarray, columns: np.ndarray) -> np.ndarray:
        out = np.empty((len(points), columns.shape[1]))
        for rows in _parts(points):
            counts, indices, weights, _ = self._weights(points[rows], slopes=False)
            values = self._matrix(counts, indices, weights) @ columns
            self._fill(values, counts == 0)
            out[rows] = values
        return out

    def _matrix(self, counts: np.ndarray, indices: np.ndarray, data: np.ndarray) -> scipy.sparse.csr_array:
        from scipy.sparse import csr_array

        indptr = np.concatenate([[0], np.cumsum(counts)])
        return csr_array((data, indices, indptr), shape=(len(counts), len(self.points)))

    @cached_property
    def _arrays(self) -> tuple[Complex, np.ndarray, float]:
        """The triangulation of scaled sites, its centers from first vertices, and the unit of the scale."""
        tri = self.tri
        sites, unit = scaled_sites(tri.points)
        threads = available_cores()
        require(f"natural neighbours among {len(sites)} sites", 8 * tri.ndim * len(tri.simplices))
        rows = np.concatenate([sites, np.empty((threads, tri.ndim))])
        offsets = frozen(offsets_of_centers(sites, tri.simplices))
        return Complex(rows, tri.simplices, tri.neighbors, True), offsets, unit

    @cached_property
    def _scratch(self) -> list[Scratch]:
        """The memory of each thread."""
        cells, offsets, _ = self._arrays
        return [_scratch(cells, offsets, len(self.points), 64) for _ in range(available_cores())]

    def _weights(
        self, points: np.ndarray, slopes: bool
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Counts per point, int32 (k,), and all neighbours, weights and derivatives, one after the other."""
        found = self.tri.find_simplex(points)
        with _ONE.at_a_time:
            return self._weights_at(points, found, slopes)

    def _weights_at(
        self, points: np.ndarray, found: np.ndarray, slopes: bool
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        unit = self._arrays[2]
        queries = np.ascontiguousarray(points if unit == 1.0 else points / unit)
        pieces = max(1, min(len(self._scratch), len(points) // LEAST_POINTS))
        bounds = [len(points) * k // pieces for k in range(pieces + 1)]
        parts: list[list[tuple[np.ndarray, np.ndarray, np.ndarray]]] = [[] for _ in range(pieces)]
        counts = np.zeros(len(points), np.int32)
        run_short_tasks(
            [
                partial(self._piece, k, queries, found, bounds[k : k + 2], counts, parts[k], slopes)
                for k in range(pieces)
            ]
        )
        done = [part for piece in parts for part in piece]
        indices, weights, gradients = (np.concatenate(arrays) for arrays in zip(*done, strict=True))
        self._complete(weights, counts, queries, found)
        return counts, indices, weights, gradients / unit if slopes else gradients

    def _complete(
        self, weights: np.ndarray, counts: np.ndarray, queries: np.ndarray, found: np.ndarray
    ) -> None:
        """Write the barycentric weights of points in simplices so flat that pairs of doubles do not tell."""
        left_open = np.flatnonzero(np.isinf(weights))
        if not len(left_open):
            return
        ends = np.cumsum(counts)
        rows = np.unique(np.searchsorted(ends, left_open, side="right"))
        corners = self.tri.ndim + 1
        sites = self._arrays[0].rows[: len(self.points)]
        exact = barycentric_weights(sites, self.tri.simplices, found[rows], queries[rows])
        weights[(ends[rows] - corners)[:, None] + np.arange(corners)] = np.maximum(exact, 0.0)

    def _piece(
        self,
        thread: int,
        queries: np.ndarray,
        found: np.ndarray,
        bounds: list[int],
        counts: np.ndarray,
        parts: list[tuple[np.ndarray, np.ndarray, np.ndarray]],
        slopes: bool,
    ) -> None:
        cells, offsets, _ = self._arrays
        d, (begin, end) = queries.shape[1], bounds
        row = len(cells.rows) - 1 - thread
        while True:
            scratch = self._scratch[thread]
            room = max(ROOM * (end - begin), 4 * len(scratch.ring))
            out = Weights(
                counts, np.empty(room, np.int32), np.empty(room), np.empty((room if slopes else 1, d))
            )
            at, written = natural_neighbors(cells, row, queries, found, begin, end, scratch, out)
            parts.append(
                (out.indices[:written], out.weights[:written], out.slopes[: written if slopes else 0])
            )
            if at == end:
                return
            if at < 0:  # a cavity for which there was no room
                at = -1 - at
                self._scratch[thread] = _scratch(cells, offsets, len(self.points), 4 * len(scratch.cavity))
            begin = at


def _parts(points: np.ndarray) -> list[np.ndarray]:
    """Rows of points (k, d), some at a time, along a curve; those that are not finite last.

    So the simplices around a point are still in the cache for the next.
    """
    finite = np.isfinite(points).all(axis=1)
    rows = np.flatnonzero(finite)
    order = np.concatenate([rows[along_curve(points[rows])], np.flatnonzero(~finite)])
    return [order[begin : begin + POINTS_AT_A_TIME] for begin in range(0, len(order), POINTS_AT_A_TIME)]


class _One:
    """A lock: rows for points at hand, and the threads' memory, have one user."""

    def __init__(self) -> None:
        self.renew()

    def renew(self) -> None:
        self.at_a_time = threading.Lock()


_ONE = _One()

if hasattr(os, "register_at_fork"):  # after a fork the thread that had the lock is not there to give it back
    os.register_at_fork(after_in_child=_ONE.renew)


def _scratch(cells: Complex, offsets: np.ndarray, n: int, most: int) -> Scratch:
    """Memory for cavities of so many simplices."""
    m, d = offsets.shape
    facets = 2 * most + 8
    return Scratch(
        offsets=offsets,
        seen=np.zeros(m, np.int32),
        place=np.full(len(cells.rows), -1, np.int32),
        stamp=np.zeros(1, np.int32),
        cavity=np.empty(most, np.int32),
        facets=np.empty((facets, 2), np.int32),
        edges=np.empty((3 * facets, 3), np.int32),
        sides=np.empty((facets, 2), np.int32),
        centers=np.empty((facets, d)),
        ring=np.empty(facets + 3, np.int32),
        taken=np.empty(facets + 3),
        growth=np.empty((facets + 3, d)),
        work=work_array(cells.rows[:n]),
    )
