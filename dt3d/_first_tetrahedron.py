"""The first tetrahedron, and with it the exact answer to whether the sites span a volume."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from ._input import no_volume
from .predicates import orient3d

# Of products of two or three differences of coordinates that are 1 at most, each rounded, by their greatest
# possible size: what is larger has the right sign, by a factor of a hundred. Smaller differences underflow.
CERTAIN = 1e-12
LEAST_DIFFERENCE = 2.0**-300


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
    offset = about_one(points).T  # rows are coordinates
    offset = offset - offset[:, a, None]
    distance = np.abs(offset).max(axis=0)
    distance[a] = -1  # all others may be as near, once they are rounded
    b = int(np.argmax(distance))
    (x, y, z), (u, v, w) = offset, offset[:, b].tolist()
    normals = np.stack([y * w - z * v, z * u - x * w, x * v - y * u])
    length = np.abs(normals).max(axis=0)
    c = int(np.argmax(length))
    extent = distance[b]
    filtered = extent > LEAST_DIFFERENCE
    if not (filtered and length[c] > CERTAIN * extent**2):
        c = _not_collinear(points, a, b, np.argsort(-length, kind="stable"))
    heights = normals[:, c] @ offset
    d = int(np.argmax(np.abs(heights)))
    if filtered and abs(heights[d]) > CERTAIN * extent**3:
        sign = -np.sign(heights[d])
    else:
        sign = orient3d(points[a], points[b], points[c], points[d])
    if not sign:
        signs = orient3d(points[a], points[b], points[c], points)
        if not signs.any():
            raise no_volume(2, len(points))
        d = int(np.flatnonzero(signs)[0])
        sign = signs[d]
    first, second = (a, b) if sign > 0 else (b, a)
    return np.array([first, second, c, d], np.int32)


def _not_collinear(points: np.ndarray, a: int, b: int, order: np.ndarray) -> int:
    """The first site in that order that is not on the line through a and b."""
    for c in order.tolist():
        if not _collinear(points[a], points[b], points[c]):
            return int(c)
    raise no_volume(1, len(points))


def about_one(points: np.ndarray) -> np.ndarray:
    """The points times a power of two, the greatest coordinate being about 1; what underflows is rounded."""
    scaled: np.ndarray = np.ldexp(points, -int(np.frexp(np.abs(points).max())[1]))
    return scaled


def _collinear(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> bool:
    """Whether the cross product of q - p and r - p is zero, in rational arithmetic."""
    u = [Fraction(y) - Fraction(x) for x, y in zip(p.tolist(), q.tolist(), strict=True)]
    v = [Fraction(y) - Fraction(x) for x, y in zip(p.tolist(), r.tolist(), strict=True)]
    return all(u[i] * v[j] == u[j] * v[i] for i, j in ((0, 1), (1, 2), (2, 0)))
