"""Linear interpolation in each simplex."""

from __future__ import annotations

from functools import cached_property
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from .._numba.kernel_cache import cached_njit
from ..geometry.barycentric import barycentric_weights
from ..geometry.pairs import in_pieces
from .base import Interpolator


@cached_njit(nogil=True)
def _combine(weights, simplices, found, columns, begin, end, out):
    """Write the weighted sums of the columns at the vertices of the simplices found; 0 outside."""
    for i in range(begin, end):
        t = found[i]
        for c in range(columns.shape[1]):
            total = 0.0
            if t >= 0:
                for k in range(simplices.shape[1]):
                    total += weights[i, k] * columns[simplices[t, k], c]
            out[i, c] = total


class Linear(Interpolator):
    """Linear interpolation in the simplices of the Delaunay triangulation.

    In place of `scipy.interpolate.LinearNDInterpolator` for points in the plane and in space.

    Parameters
    ----------
    points : array_like (n, 2) or (n, 3), Delaunay or Subset
        The sites, or their triangulation. In the holes of a subset there is ``fill_value``.
    values : array_like, real or complex (n, ...)
        The value of each site, of any shape.
    fill_value : float or complex
        The value outside the convex hull, and at points that are not finite.
    rescale : bool
        Whether to scale points to a unit cube before they are triangulated.

    Raises
    ------
    ValueError
        If the points or values are not what they should be; the message says what came.

    Examples
    --------
    >>> import numpy as np
    >>> from dt3d.interpolate import Linear
    >>> f = Linear([[0, 0], [1, 0], [0, 1], [1, 1]], [0, 1, 2, 3])
    >>> f([[0.5, 0.25], [2, 2]]).tolist(), f(0.5, [0.25, 0.5]).tolist(), f.gradient(0.3, 0.2).tolist()
    ([1.0, nan], [1.0, 1.5], [1.0, 2.0])
    """

    _derived: ClassVar[tuple[str, ...]] = ("_slopes",)

    def _evaluate(self, points: np.ndarray, columns: np.ndarray) -> np.ndarray:
        tri, found = self.tri, self._located(points)
        weights = barycentric_weights(tri.points, tri.simplices, found, points)
        out = np.empty((len(points), columns.shape[1]))
        in_pieces(
            lambda begin, end: _combine(weights, tri.simplices, found, columns, begin, end, out), len(points)
        )
        self._fill(out, found < 0)
        return out

    @cached_property
    def _slopes(self) -> np.ndarray:
        """The gradient of each simplex's linear function, float64 (m, c, d)."""
        from .._lifting import weight_gradients

        corners = self._columns()[self.tri.simplices]
        by_weight = corners[:, :-1] - corners[:, -1:]
        of_weights = weight_gradients(self.tri.points, self.tri.simplices)
        slopes: np.ndarray = np.einsum("tkc,tkd->tcd", by_weight, of_weights)
        return slopes if self._scale is None else slopes / self._scale

    def gradient(self, *xi: npt.ArrayLike) -> np.ndarray:
        """The gradient in the simplex that contains each point; it jumps between simplices.

        Parameters
        ----------
        *xi : array_like, real
            Points as in `__call__`.

        Returns
        -------
        float64 or complex128 (..., d)
            The shape of the values there, and the d derivatives. NaN outside.

        Examples
        --------
        >>> from dt3d.interpolate import Linear
        >>> f = Linear([[0, 0], [1, 0], [0, 1], [1, 1]], [0, 1, 2, 3])
        >>> f.gradient([[0.3, 0.2], [2, 2]]).tolist()
        [[1.0, 2.0], [nan, nan]]
        """
        points, shape = self._queries(xi)
        found = self._located(points)
        out = np.full((len(points), *self._slopes.shape[1:]), np.nan)
        out[found >= 0] = self._slopes[found[found >= 0]]
        return self._derivatives(out, shape)
