"""The predicates on arrays of points, checked, for one of two backends."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Signs = NDArray[np.int8]


def orient2d(a: ArrayLike, b: ArrayLike, c: ArrayLike, *, backend: str = "numba") -> Signs:
    """Signs of det[b-a, c-a]: positive for a turn to the left.

    Parameters
    ----------
    a, b, c : array_like of float64 (..., 2)
        Points; the leading shapes broadcast.
    backend : "numba" or "jax"
        A floating-point filter before exact stages, on one thread of a CPU; or integers, on whatever JAX
        runs on. The signs are the same.

    Returns
    -------
    int8 (...)
        -1, 0 or 1; 0 exactly where the three are collinear.

    Raises
    ------
    ValueError
        If a coordinate is not finite, the points have another shape, or there is no such backend.

    Examples
    --------
    >>> from dt3d.predicates import orient2d
    >>> orient2d([0, 0], [1, 0], [[0, 1], [2, 0], [0, -1]]).tolist()
    [1, 0, -1]
    """
    return _signs("orient2d", 2, backend, a, b, c)


def orient3d(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike, *, backend: str = "numba") -> Signs:
    """Signs of det[b-a, c-a, d-a]: positive for the origin and the three unit vectors in order.

    0 exactly where the four are coplanar. Points are (..., 3); the rest is as for `orient2d`.

    Examples
    --------
    >>> from dt3d.predicates import orient3d
    >>> int(orient3d([0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]))
    1
    """
    return _signs("orient3d", 3, backend, a, b, c, d)


def in_circle(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike, *, backend: str = "numba") -> Signs:
    """Signs of the in-circle determinant: for positive abc 1 where d is inside their circle, 0 where on it.

    Points are (..., 2); the rest is as for `orient2d`.

    Examples
    --------
    >>> from dt3d.predicates import in_circle
    >>> in_circle([0, 0], [1, 0], [0, 1], [[0.5, 0.5], [1, 1], [2, 2]]).tolist()
    [1, 0, -1]
    """
    return _signs("in_circle", 2, backend, a, b, c, d)


def in_sphere(
    a: ArrayLike,
    b: ArrayLike,
    c: ArrayLike,
    d: ArrayLike,
    e: ArrayLike,
    *,
    backend: str = "numba",
) -> Signs:
    """Signs of the in-sphere determinant: for positive abcd 1 where e is inside their sphere, 0 where on it.

    Points are (..., 3); the rest is as for `orient2d`.

    Examples
    --------
    >>> from dt3d.predicates import in_sphere
    >>> int(in_sphere([0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0.5]))
    1
    """
    return _signs("in_sphere", 3, backend, a, b, c, d, e)


def _signs(predicate: str, dimension: int, backend: str, *points: ArrayLike) -> Signs:
    if backend not in BACKENDS:
        msg = f"backend must be one of {', '.join(map(repr, BACKENDS))}, got {backend!r}"
        raise ValueError(msg)
    arrays = np.broadcast_arrays(*(np.asarray(p, np.float64) for p in points))
    if arrays[0].ndim == 0 or arrays[0].shape[-1] != dimension:
        msg = f"points must have shape (..., {dimension}), got {arrays[0].shape}"
        raise ValueError(msg)
    if not all(np.isfinite(x).all() for x in arrays):
        msg = "coordinates must be finite, got NaN or infinity; drop those points first"
        raise ValueError(msg)
    shape = arrays[0].shape[:-1]
    cases = np.stack([x.reshape(-1, dimension) for x in arrays], axis=1)
    signs: Signs = BACKENDS[backend](predicate, cases).reshape(shape)[()]
    return signs


def _compiled(predicate: str, cases: np.ndarray) -> np.ndarray:
    """Return the signs of cases float64 (m, k, d), int8 (m,), by the compiled predicates."""
    from . import plane, space
    from .workspace import scaled, work_array

    out = np.empty(len(cases), np.int8)
    cases = scaled(cases)
    loop = getattr(plane if cases.shape[2] == 2 else space, f"{predicate}_of_cases")
    loop(cases, work_array(cases), out)
    return out


def _traced(predicate: str, cases: np.ndarray) -> np.ndarray:
    """Return the same by JAX."""
    from .traced.mapped import signs

    return signs(predicate, cases)


BACKENDS = {"numba": _compiled, "jax": _traced}  # what returns signs, int8 (m,), of cases float64 (m, k, d)
