"""What interpolators have in common: a triangulation, values at its sites, and points to evaluate at."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, cast

import numpy as np
import numpy.typing as npt

from .._given import PointsLike
from .._input import check_points, check_queries
from ..delaunay import Delaunay
from ..subset import Subset

if TYPE_CHECKING:
    from .._geometry import Geometry


class Interpolator:
    """A function of values at the sites of a triangulation.

    Points and points to evaluate at may be given as a tuple of coordinates, too, as SciPy takes them.

    Attributes
    ----------
    tri : Delaunay or Subset
        The triangulation; of scaled points with ``rescale=True``.
    points : float64 (n, d)
        The sites as given.
    values : float64 or complex128 (n, ...)
        The value of each site. That of a duplicate is not used: the one of the site at its place is.
    fill_value : float or complex
        The value outside.
    """

    _derived: ClassVar[tuple[str, ...]] = ()
    """Names of what is computed when it is first needed."""

    def __init__(
        self,
        points: PointsLike | Geometry,
        values: npt.ArrayLike,
        fill_value: complex = np.nan,
        rescale: bool = False,
    ) -> None:
        self._offset: np.ndarray | None = None
        self._scale: np.ndarray | None = None
        if isinstance(points, Delaunay | Subset):
            if rescale:
                msg = (
                    "Rescaling is not supported when passing a Delaunay triangulation as ``points``. Pass "
                    "the points themselves, or leave rescale=True out"
                )
                raise ValueError(msg)
            self.tri: Geometry = points
            self.points = points.points
        else:
            if isinstance(points, tuple):  # of coordinates, as in SciPy
                points = np.stack(np.broadcast_arrays(*points), axis=-1)
            self.points = check_points(cast(PointsLike, points))
            sites = self.points
            if rescale:
                self._offset, self._scale = sites.mean(axis=0), np.ptp(sites, axis=0)
                self._scale[self._scale == 0] = 1.0
                sites = (sites - self._offset) / self._scale
            self.tri = Delaunay(sites)
        self.values = _check_values(values, len(self.points))
        self.fill_value = _check_fill(fill_value, self.values)

    def __call__(self, *xi: npt.ArrayLike) -> np.ndarray:
        """Evaluate at points.

        Parameters
        ----------
        *xi : array_like, real
            Points of shape (..., d), or d arrays of coordinates that are broadcast against each other. A
            single point (d,) counts as (1, d), as in SciPy.

        Returns
        -------
        float64 or complex128
            The shape of the points without the coordinate, and then that of a site's value.

        Raises
        ------
        ValueError
            If the points are not real, or of another shape.

        Examples
        --------
        >>> from dt3d.interpolate import Linear
        >>> f = Linear([[0, 0], [1, 0], [0, 1], [1, 1]], [0, 1, 2, 3])
        >>> f([[0.5, 0.25]]).tolist(), f(0.5, 0.25).tolist(), f(0.5, [0.25, 0.5]).tolist()
        ([1.0], 1.0, [1.0, 1.5])
        """
        points, shape = self._queries(xi)
        out = self._evaluate(points, self._columns())
        return self._shaped(out, shape)

    def _check_whole(self) -> None:
        """Raise a ValueError for a triangulation in which the search may not find its way."""
        name = type(self).__name__
        if not isinstance(self.tri, Delaunay):
            msg = f"{name} needs a whole triangulation, got a part of one; pass part.whole"
            raise ValueError(msg)
        if not self.tri._exact:
            msg = f'{name} needs an exact triangulation, got one of robustness="perturb"; pass its points'
            raise ValueError(msg)

    def _evaluate(self, points: np.ndarray, columns: np.ndarray) -> np.ndarray:
        """The values at points (k, d) by columns float64 (n, c): float64 (k, c)."""
        raise NotImplementedError

    def _queries(self, xi: tuple[npt.ArrayLike, ...]) -> tuple[np.ndarray, tuple[int, ...]]:
        """The points in the coordinates of the triangulation, float64 (k, d), and the answers' shape."""
        d = self.tri.ndim
        if len(xi) == 1 and isinstance(xi[0], tuple):
            xi = xi[0]
        if len(xi) == 1:
            points, shape = check_queries(xi[0], d)
            shape = shape or (1,)  # as in SciPy
        elif len(xi) == d:
            points, shape = check_queries(np.stack(np.broadcast_arrays(*xi), axis=-1), d)
        else:
            msg = f"pass one array of points, shape (..., {d}), or {d} arrays of coordinates; got {len(xi)}"
            raise ValueError(msg)
        if self._scale is not None:
            points = (points - self._offset) / self._scale
        return points, shape

    def _columns(self) -> np.ndarray:
        """The values as columns, float64 (n, c): a complex one is two."""
        n = len(self.values)
        columns: np.ndarray = np.ascontiguousarray(self.values.reshape(n, -1)).view(np.float64)
        return columns

    def _fill(self, out: np.ndarray, outside: np.ndarray) -> None:
        """Put ``fill_value`` into these rows of columns, float64 (k, c)."""
        parts = np.array([self.fill_value], self.values.dtype).view(np.float64)
        out[outside] = np.tile(parts, out.shape[1] // len(parts))

    def _shaped(self, out: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
        """Columns, float64 (k, c), as values: float64 or complex128 (*shape, ...)."""
        values = np.ascontiguousarray(out).view(self.values.dtype)
        result: np.ndarray = values.reshape((*shape, *self.values.shape[1:]))
        return result

    def _derivatives(self, out: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
        """Derivatives of columns, float64 (k, c, d), as those of values: (*shape, ..., d)."""
        k, c, d = out.shape
        parts = self.values.itemsize // 8
        together = np.ascontiguousarray(out.reshape(k, c // parts, parts, d).swapaxes(2, 3))
        values: np.ndarray = together.view(self.values.dtype).reshape((*shape, *self.values.shape[1:], d))
        return values

    def _located(self, points: np.ndarray) -> np.ndarray:
        return self.tri.find_simplex(points)

    def __getstate__(self) -> dict[str, object]:
        """What a pickle has: all but what can be computed again."""
        return {name: value for name, value in self.__dict__.items() if name not in self._derived}

    def __repr__(self) -> str:
        """Of how many sites."""
        kind = f"dt3d.interpolate.{type(self).__name__}"
        return f"<{kind}: {len(self.points)} sites, values of shape {self.values.shape[1:]}>"


def _check_values(values: npt.ArrayLike, n: int) -> np.ndarray:
    array = np.asarray(values)
    if array.dtype.kind not in "biufc":
        msg = f"values must be real or complex numbers, got dtype {array.dtype}"
        raise ValueError(msg)
    if not array.ndim or len(array) != n:
        msg = f"values must have one entry per site, shape ({n}, ...), got shape {array.shape}"
        raise ValueError(msg)
    return np.array(array, np.complex128 if array.dtype.kind == "c" else np.float64, order="C")


def _check_fill(fill_value: Any, values: np.ndarray) -> complex:  # whatever a user says
    number = np.asarray(fill_value)
    if number.ndim or number.dtype.kind not in "biufc":
        msg = f"fill_value must be a number, got {fill_value!r}"
        raise ValueError(msg)
    if number.dtype.kind == "c" and values.dtype.kind != "c":
        msg = f"fill_value must be real as the values are, got {fill_value!r}"
        raise ValueError(msg)
    return complex(number) if values.dtype.kind == "c" else float(number)
