"""Which tetrahedron, or triangle in the plane, contains a point: visibility walks, with exact orientations.

A walk crosses any facet that has the point on its other side, which ends in a Delaunay triangulation (O.
Devillers, S. Pion, M. Teillaud: Walking in a triangulation, International Journal of Foundations of Computer
Science 13, 2002). Many points are taken along a space-filling curve, each from where the one before was.
"""

from __future__ import annotations

import os
import threading
import weakref
from collections.abc import Callable
from functools import partial

import numpy as np
import numpy.typing as npt

from ._errors import InternalError
from ._input import check_queries
from ._memory import require
from ._numba.cores import available_cores
from ._numba.kernel_cache import cached_njit
from ._numba.threads import run_short_tasks
from ._numba.unowned import unowned
from ._results import check_complex, check_range, frozen
from ._star import Complex, find_beside, side_of_facet
from ._topology import OUTSIDE
from .ordering.along_curve import along_curve
from .predicates import work_array

LEAST_POINTS_PER_THREAD = 4096
POINTS_AT_A_TIME = 2**22  # that are put in order together
BYTES_PER_POINT = 110  # of those, in space, as measured, without the result
LOST = -2  # a walk of more steps than there are simplices, which no Delaunay triangulation has


@cached_njit
def _walk(cells, t, q, w):
    """Where the walk from t to row q ends, `OUTSIDE` or `LOST`; and the simplex where it ended.

    Each step goes to a simplex of whose sphere, perturbed, q has a lesser power, so none is visited twice.
    """
    previous, facets = OUTSIDE, cells.simplices.shape[1]
    for step in range(len(cells.simplices)):
        ahead = t
        for i in range(facets):
            k = (i + step) % facets  # another first facet each time
            u = cells.neighbors[t, k]
            if (u != previous or u == OUTSIDE) and side_of_facet(cells, t, k, q, w) < 0:
                if u == OUTSIDE:
                    return OUTSIDE, t
                ahead = u
                break
        if ahead == t:
            return t, t
        previous, t = t, ahead
    return LOST, t


@cached_njit
def _search(cells, q, w):
    """The first simplex that contains row q, or `OUTSIDE`."""
    for t in range(len(cells.simplices)):
        contained = True
        for k in range(cells.simplices.shape[1]):
            contained = contained and side_of_facet(cells, t, k, q, w) >= 0
        if contained:
            return t
    return OUTSIDE


@cached_njit(nogil=True)
def _find(cells, t, q, points, order, out, w):
    """Locate points[order] by walks from t on, each point copied to row q.

    For a point outside it writes -2 - u, where u is the simplex at which the walk left the hull, or `OUTSIDE`
    where all simplices were searched. Returns where the last walk ended, or `LOST` where a walk did not.
    """
    cells, w = unowned(cells), unowned(w)
    for i in order:
        for k in range(points.shape[1]):  # numba compiles a whole array's assignment for a second
            cells.rows[q, k] = points[i, k]
        out[i], t = _walk(cells, t, q, w)
        if out[i] < 0:
            if not cells.convex:
                out[i] = _search(cells, q, w)
            elif out[i] == LOST:
                return LOST
            else:
                out[i] = -2 - t
    return t


class Locator:
    """What locates points in one triangulation.

    Parameters
    ----------
    sites : float64 (n, d)
        d is 2 or 3.
    simplices, neighbors : int32 (m, d + 1)
    convex : bool
        Whether the simplices are known to fill a convex hull. Otherwise all are searched for a point that no
        walk has found.

    Raises
    ------
    ValueError
        If an array is not of its dtype and shape, has an index out of range, or a site that is not finite:
        walks do not check what they index with.
    """

    def __init__(
        self, sites: np.ndarray, simplices: np.ndarray, neighbors: np.ndarray, convex: bool = True
    ) -> None:
        # first frozen, then checked, so that nothing can change between; and one type to numba
        self.simplices, self.neighbors = frozen(simplices), frozen(neighbors)
        check_complex(sites, self.simplices, self.neighbors)
        self.low, self.high = sites.min(axis=0), sites.max(axis=0)
        threads = available_cores()
        # predicates take rows of one array, so every thread has a row for the point at hand
        rows = np.concatenate([sites, np.empty((threads, sites.shape[1]))])
        self.cells = Complex(rows, self.simplices, self.neighbors, bool(convex))
        self.works = [work_array(sites) for _ in range(threads)]
        self.last = [0] * threads
        self.lock = threading.Lock()  # the rows for points at hand have one user
        _LOCATORS.add(self)

    def find(self, xi: npt.ArrayLike, tol: float = 0.0) -> np.ndarray:
        """The simplex that contains each point of xi, real (..., d): int32 (...), or `OUTSIDE`.

        Parameters
        ----------
        xi : array_like, real (..., d)
            Those that are not finite are outside.
        tol : float
            A point outside the hull counts as in the simplex at which the walk to it left the hull, if its
            barycentric coordinates there are not less than ``-tol``.

        Raises
        ------
        ValueError
            If the points are not real and of shape (..., d).
        InternalError
            If a walk does not end.
        """
        points, shape = check_queries(xi, len(self.low))
        return self.find_checked(points, tol).reshape(shape)

    def find_checked(self, points: np.ndarray, tol: float = 0.0) -> np.ndarray:
        """The same for float64 (k, d): int32 (k,). Of millions of points some are taken at a time."""
        if tol == 0:
            return self._found(points, lambda part, found: None, False)
        return self._found(points, partial(self._admit, tol=tol), True)

    def _found(
        self, points: np.ndarray, outside: Callable[[np.ndarray, np.ndarray], object], beyond: bool
    ) -> np.ndarray:
        """Locate points, with ``beyond`` those outside the bounding box, too.

        ``outside(part, found)`` may change what `_find` has written for a part of the points.
        """
        at_a_time = min(len(points), POINTS_AT_A_TIME)
        require(f"locating {len(points)} points", 4 * len(points) + BYTES_PER_POINT * at_a_time)
        out = np.full(len(points), OUTSIDE, np.int32)
        for begin in range(0, len(points), POINTS_AT_A_TIME):
            # a copy is contiguous, and nobody else changes it
            part = np.array(points[begin : begin + POINTS_AT_A_TIME], order="C")
            # comparisons with NaN are false
            within = np.isfinite(part) if beyond else (part >= self.low) & (part <= self.high)
            rows = np.flatnonzero(within.all(axis=1))
            found = out[begin : begin + POINTS_AT_A_TIME]
            with self.lock:
                self._find(part, rows[along_curve(part[rows])], found)
            outside(part, found)
            np.maximum(found, OUTSIDE, out=found)
        return out

    def _admit(self, points: np.ndarray, found: np.ndarray, tol: float) -> None:
        """Put points that are as near as that into the simplices at which the walks to them left the hull."""
        from .geometry.barycentric import barycentric_weights

        outside = np.flatnonzero(found < OUTSIDE)
        left = -2 - found[outside]
        sites = self.cells.rows[: len(self.cells.rows) - len(self.works)]
        weights = barycentric_weights(sites, self.simplices, left, points[outside])
        near = weights.min(axis=1, initial=np.inf) >= -tol
        found[outside[near]] = left[near]

    def find_kept(self, points: np.ndarray, found: np.ndarray, kept: np.ndarray) -> np.ndarray:
        """For points that lie in the simplices found, the ones that contain them, too, and are kept.

        Parameters
        ----------
        points : float64 (k, d)
            Finite.
        found : int32 (k,)
            A simplex that contains each.
        kept : bool (m,)
            Which simplices are kept.

        Returns
        -------
        int32 (k,)
            Or `OUTSIDE`. It differs from found for points on a border only.
        """
        out = np.full(len(points), OUTSIDE, np.int32)
        check_range("found", found, 0, len(self.simplices))
        with self.lock:
            part = np.array(points, order="C")
            find_beside(self.cells, kept.copy(), len(self.cells.rows) - 1, part, found, out, self.works[0])
        return out

    def _find(self, points: np.ndarray, order: np.ndarray, out: np.ndarray) -> None:
        threads = max(1, min(len(self.last), len(order) // LEAST_POINTS_PER_THREAD))
        bounds = [len(order) * k // threads for k in range(threads + 1)]

        def work(k: int) -> None:
            part, row = order[bounds[k] : bounds[k + 1]], len(self.cells.rows) - 1 - k
            last = _find(self.cells, self.last[k], row, points, part, out, self.works[k])
            if last == LOST:
                most = len(self.simplices)
                msg = f"a walk to a point does not end after {most} steps, one for each simplex"
                raise InternalError(msg)
            self.last[k] = last

        fewer = f"locate fewer than {2 * LEAST_POINTS_PER_THREAD} points at a time"
        run_short_tasks([partial(work, k) for k in range(threads)], fewer)


_LOCATORS: weakref.WeakSet[Locator] = weakref.WeakSet()


def _in_child() -> None:
    """After a fork the thread that had a lock is not there to give it back."""
    for locator in _LOCATORS:
        locator.lock = threading.Lock()


if hasattr(os, "register_at_fork"):  # not on Windows, which has no fork
    os.register_at_fork(after_in_child=_in_child)
