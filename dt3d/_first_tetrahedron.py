"""The first tetrahedron, and with it the exact answer to whether the sites span a volume."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from ._input import no_volume
from .predicates import orient3d


def first_tetrahedron(points: np.ndarray, a: int) -> np.ndarray:
    """Four of the distinct sites (n, 3), a among them, in positive orientation; int32 (4,).

    They are far apart where floating point can tell; what decides is exact.

    Raises
    ------
    DegenerateInputError
        If all sites lie on a point, a line or a plane.
    """
    if len(points) == 1:
        raise no_volume(0, 1)
    rounded = about_one(points)
    offset = rounded - rounded[a]
    distance = np.abs(offset).max(axis=1)
    distance[a] = -1  # all others may be as near, once they are rounded
    b = int(np.argmax(distance))
    normals = np.cross(offset, offset[b])
    for c in np.argsort(-np.abs(normals).max(axis=1), kind="stable"):
        if not _collinear(points[a], points[b], points[c]):
            break
    else:
        raise no_volume(1, len(points))
    heights = offset @ normals[c]
    d = int(np.argmax(np.abs(heights)))
    sign = orient3d(points[a], points[b], points[c], points[d])
    if not sign:
        signs = orient3d(points[a], points[b], points[c], points)
        if not signs.any():
            raise no_volume(2, len(points))
        d = int(np.flatnonzero(signs)[0])
        sign = signs[d]
    first, second = (a, b) if sign > 0 else (b, a)
    return np.array([first, second, c, d], np.int32)


def about_one(points: np.ndarray) -> np.ndarray:
    """The points times a power of two, the greatest coordinate being about 1; what underflows is rounded."""
    scaled: np.ndarray = np.ldexp(points, -int(np.frexp(np.abs(points).max())[1]))
    return scaled


def _collinear(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> bool:
    """Whether the cross product of q - p and r - p is zero, in rational arithmetic."""
    u = [Fraction(y) - Fraction(x) for x, y in zip(p.tolist(), q.tolist(), strict=True)]
    v = [Fraction(y) - Fraction(x) for x, y in zip(p.tolist(), r.tolist(), strict=True)]
    return all(u[i] * v[j] == u[j] * v[i] for i, j in ((0, 1), (1, 2), (2, 0)))
