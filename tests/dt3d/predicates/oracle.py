"""The determinants of the predicates in Python integers, and perturbed with numbers for infinitesimals."""

from __future__ import annotations

import numpy as np

from ..exact import integers

POINTS = {"orient2d": 3, "orient3d": 4, "in_circle": 4, "in_sphere": 5}
DIMENSION = {"orient2d": 2, "orient3d": 3, "in_circle": 2, "in_sphere": 3}


def determinant(rows) -> int:
    """Expanded by the first column."""
    if len(rows) == 1:
        return rows[0][0]
    total = 0
    for i, row in enumerate(rows):
        rest = [other[1:] for k, other in enumerate(rows) if k != i]
        total += (-1) ** i * row[0] * determinant(rest)
    return total


def sign(predicate: str, points: np.ndarray) -> int:
    """Of one case, float64 (k, d)."""
    x = integers(points).tolist()
    if predicate.startswith("orient"):
        rows = [[p - q for p, q in zip(row, x[0], strict=True)] for row in x[1:]]
        return _sign(determinant(rows))
    return lifted_sign(x, [sum(c * c for c in p) for p in x])


def lifted_sign(points, heights) -> int:
    """1 where the last of d + 2 points is below the hyperplane of the others, a positive simplex."""
    rows = [[*p, h, 1] for p, h in zip(points, heights, strict=True)]
    return (-1) ** len(points[0]) * _sign(determinant(rows))


def inside_perturbed(points: np.ndarray, ranks) -> bool:
    """The lifted test at heights |p|^2 + e^k for the k-th of the points, e a number as good as infinitesimal.

    Determinants of small coordinates are integers below 2^60, so a power of 2^-100 is infinitely smaller than
    the one before. All heights are multiplied by 2^600.
    """
    x = points.astype(int).tolist()
    place = np.argsort(np.argsort(ranks)).tolist()
    heights = [(sum(c * c for c in p) << 600) + (1 << (500 - 100 * k)) for p, k in zip(x, place, strict=True)]
    return lifted_sign(x, heights) > 0


def _sign(x) -> int:
    return (x > 0) - (x < 0)
