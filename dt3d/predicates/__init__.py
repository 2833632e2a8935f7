"""Exact geometric predicates: signs that are right for all inputs in a range of exponents.

`orient3d` and `in_sphere` here take arrays and check them; the compiled forms that algorithms use are in
`filtered`, the exact stage in `exact`, the arithmetic in `expansions`.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from . import filtered
from .expansions import EXPONENTS, work_array

__all__ = ["EXPONENTS", "in_range", "in_sphere", "orient3d", "work_array"]


def in_range(coordinates: Any) -> bool:
    """Whether all coordinates are zero or have all their bits within `EXPONENTS`."""
    x = np.abs(np.asarray(coordinates, np.float64))
    low, high = EXPONENTS
    return bool(((x == 0) | ((x >= 2.0 ** (low + 53)) & (x < 2.0**high))).all())


def orient3d(a: Any, b: Any, c: Any, d: Any) -> Any:
    """Signs of det[b-a, c-a, d-a]: positive for the origin and the three unit vectors in order.

    Parameters
    ----------
    a, b, c, d : array_like of float64 (..., 3)
        Points; the leading shapes broadcast.

    Returns
    -------
    int8 (...)
        -1, 0 or 1; 0 exactly where the four are coplanar.

    Raises
    ------
    ValueError
        If a coordinate is not in the range of `EXPONENTS`; scale by a power of two.
    """
    return _signs(_orient3d_all, a, b, c, d)


def in_sphere(a: Any, b: Any, c: Any, d: Any, e: Any) -> Any:
    """Signs of the in-sphere determinant: for positive abcd 1 where e is inside their sphere, 0 where on it.

    Parameters, result and errors as for `orient3d`.
    """
    return _signs(_in_sphere_all, a, b, c, d, e)


def _signs(kernel: Any, *points: Any) -> Any:
    arrays = np.broadcast_arrays(*(np.asarray(p, np.float64) for p in points))
    if arrays[0].ndim == 0 or arrays[0].shape[-1] != 3:
        msg = f"points must have shape (..., 3), got {arrays[0].shape}"
        raise ValueError(msg)
    if not all(map(in_range, arrays)):
        msg = (
            f"coordinates must be zero or between 2^{EXPONENTS[0] + 53} and 2^{EXPONENTS[1]} in magnitude "
            f"for exact signs; scale by a power of two"
        )
        raise ValueError(msg)
    shape = arrays[0].shape[:-1]
    cases = np.stack([x.reshape(-1, 3) for x in arrays], axis=1)
    out = np.empty(len(cases), np.int8)
    kernel(cases, work_array(), out)
    return out.reshape(shape)[()]


@numba.njit(cache=True)
def _orient3d_all(cases, w, out):
    for i in range(len(out)):
        out[i] = filtered.orient3d(cases[i], 0, 1, 2, 3, w)


@numba.njit(cache=True)
def _in_sphere_all(cases, w, out):
    for i in range(len(out)):
        out[i] = filtered.in_sphere(cases[i], 0, 1, 2, 3, 4, w)
