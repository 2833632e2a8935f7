"""The first triangle, and with it the exact answer to whether the sites span an area."""

from __future__ import annotations

import numpy as np

from .._input import no_area
from .._numba.kernel_cache import cached_njit
from ..predicates import work_array
from ..predicates.plane import orient2d


@cached_njit(nogil=True)
def _first(points, order, w):
    for i in range(2, len(order)):
        sign = orient2d(points, order[0], order[1], order[i], w)
        if sign != 0:
            return i, sign
    return -1, 0


def first_triangle(
    points: np.ndarray, order: np.ndarray, bounds: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The first two of the order and the first that is not on a line with them; and what is left to insert.

    Parameters
    ----------
    points : float64 (n, 2)
        The sites, in the range of the exact predicates.
    order : int64 (n,)
        All sites, part by part.
    bounds : int64 (parts + 1,)
        Where the parts begin, and where the last one ends.

    Returns
    -------
    vertices : int64 (3,)
        Of a positive triangle.
    order : int64 (n - 3,)
    bounds : int64 (parts + 1,)

    Raises
    ------
    DegenerateInputError
        If all of the distinct sites lie on a point or a line.
    """
    if len(order) < 2:
        raise no_area(0, 1)
    i, sign = _first(points, order, work_array(points))
    if not sign:
        raise no_area(1, len(order))
    a, b = order[:2] if sign > 0 else order[1::-1]
    taken = np.array([0, 1, i])
    left = np.concatenate([order[2:i], order[i + 1 :]])
    return np.array([a, b, order[i]], np.int64), left, bounds - np.searchsorted(taken, bounds)
