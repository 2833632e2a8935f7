"""Sites lifted onto a paraboloid, as Qhull does, and barycentric maps: arrays that SciPy's class has.

The lower hull of sites lifted to z = s |x|^2 + t is their Delaunay triangulation (K. Brown: Voronoi diagrams
from convex hulls, Information Processing Letters 9, 1979).
"""

from __future__ import annotations

import math

import numpy as np

LEAST_ROWS = 20_000  # worth a thread of NumPy's functions


def paraboloid(points: np.ndarray) -> tuple[float, float]:
    """The scale s and the shift t of the paraboloid s |x|^2 + t, as Qhull's options Qbb and Qz give them.

    Heights go from 0 to the greatest magnitude of a coordinate, which the point at infinity of option Qz has,
    a tenth above the greatest square.
    """
    squares = (points**2).sum(axis=1)
    least, greatest = float(squares.min()), 1.1 * float(squares.max())
    with np.errstate(over="ignore", invalid="ignore"):
        scale = float(np.abs(points).max()) / (greatest - least)
    return scale, -least * scale


def lifted(points: np.ndarray, scale: float, shift: float) -> np.ndarray:
    """Points (k, d) with their heights: float64 (k, d + 1)."""
    return np.column_stack([points, scale * (points**2).sum(axis=1) + shift])


def hyperplanes(points: np.ndarray, simplices: np.ndarray, scale: float, shift: float) -> np.ndarray:
    """The hyperplanes through lifted simplices, float64 (m, d + 2): lower unit normals and offsets.

    That of a simplex with circumcenter c has the normal (2 s c, -1) before it is scaled: on it heights are
    s (|x|^2 - power of x with respect to the sphere) + t.
    """
    from .geometry.circumcenters import circumcenters

    normals = np.column_stack(
        [2 * scale * circumcenters(points, simplices)[0], np.full(len(simplices), -1.0)]
    )
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    on_it = lifted(points[simplices[:, 0]], scale, shift)
    return np.column_stack([normals, -np.einsum("ij,ij->i", normals, on_it)])


# SciPy's bound: beyond it a matrix is not inverted, since nothing is left of rounded coordinates
WORST_CONDITION = 1 / (1000 * np.finfo(np.float64).eps)


def barycentric_transforms(points: np.ndarray, simplices: np.ndarray) -> np.ndarray:
    """SciPy's ``transform``, float64 (m, d + 1, d): gradients of weights, and the last vertices.

    NaN where the condition number of the matrix, by the sums of columns, exceeds `WORST_CONDITION`.
    """
    from .geometry.pairs import in_pieces

    m, d = len(simplices), points.shape[1]
    out = np.empty((m, d + 1, d))
    gradients = weight_gradients(points, simplices)

    def rows(begin: int, end: int) -> None:
        corners = points[simplices[begin:end]]
        sides = corners[:, :-1] - corners[:, -1:]
        with np.errstate(over="ignore", invalid="ignore"):
            condition = _norm(sides) * _norm(gradients[begin:end].swapaxes(1, 2))
        out[begin:end, :d] = gradients[begin:end]
        out[begin:end, :d][~(condition <= WORST_CONDITION)] = np.nan
        out[begin:end, d] = corners[:, -1]

    in_pieces(rows, m, LEAST_ROWS)
    return out


def weight_gradients(points: np.ndarray, simplices: np.ndarray) -> np.ndarray:
    """The gradients of the first d barycentric weights in each simplex, float64 (m, d, d).

    They are the rows of the inverse of the matrix whose columns are the sides that end in the last vertex.
    """
    from .geometry.measures import measures, scaled_sites
    from .geometry.pairs import in_pieces

    points, unit = scaled_sites(points)
    m, d = len(simplices), points.shape[1]
    out = np.empty((m, d, d))
    signed = math.factorial(d) * measures(points, simplices)  # never zero, where rounding would lose it
    if d == 3:
        signed = -signed  # the determinant of the sides that end in the last vertex

    def rows(begin: int, end: int) -> None:
        corners = points[simplices[begin:end]]
        sides = corners[:, :-1] - corners[:, -1:]
        inverse = out[begin:end]
        if d == 2:
            inverse[:, 0, 0], inverse[:, 0, 1] = sides[:, 1, 1], -sides[:, 1, 0]
            inverse[:, 1, 0], inverse[:, 1, 1] = -sides[:, 0, 1], sides[:, 0, 0]
        else:
            for k in range(3):
                inverse[:, k] = np.cross(sides[:, (k + 1) % 3], sides[:, (k + 2) % 3])
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            inverse /= signed[begin:end, None, None]
            inverse /= unit

    in_pieces(rows, m, LEAST_ROWS)
    return out


def _norm(rows: np.ndarray) -> np.ndarray:
    """The greatest sum of magnitudes of a row of each matrix (k, d, d): float64 (k,)."""
    greatest: np.ndarray = np.abs(rows).sum(axis=2).max(axis=1)
    return greatest
