"""The distributions of Kohout et al. 2004, figures 3 and 9, in the unit square."""

from __future__ import annotations

import numpy as np


def uniform(n: int, seed: int = 0) -> np.ndarray:
    """n points at random, float64 (n, 2)."""
    return np.random.default_rng([seed, n]).random((n, 2))


def grid(n: int, seed: int = 0) -> np.ndarray:
    """The first n points, row by row, of the least square grid that has as many."""
    side = int(np.ceil(np.sqrt(n)))
    y, x = np.divmod(np.arange(n), side)
    return np.column_stack([x, y]) / side


def gauss(n: int, seed: int = 0) -> np.ndarray:
    """Normally distributed about the centre, with a tenth of the square as deviation."""
    return np.random.default_rng([seed, n]).normal(0.5, 0.1, (n, 2))


def cluster(n: int, seed: int = 0) -> np.ndarray:
    """Normally distributed about twenty centres, with a fiftieth of the square as deviation."""
    rng = np.random.default_rng([seed, n])
    return rng.random((20, 2))[rng.integers(0, 20, n)] + rng.normal(0, 0.02, (n, 2))


def arc(n: int, seed: int = 0) -> np.ndarray:
    """At random on a quarter of the unit circle, up to rounding: many narrow triangles and huge circles."""
    angle = np.random.default_rng([seed, n]).random(n) * np.pi / 2
    return np.column_stack([np.cos(angle), np.sin(angle)])


DISTRIBUTIONS = {"grid": grid, "uniform": uniform, "gauss": gauss, "cluster": cluster, "arc": arc}


def sizes(text: int | str) -> list[int]:
    """Numbers of points from an option such as 1000,5000."""
    return [int(float(part)) for part in str(text).split(",")]
