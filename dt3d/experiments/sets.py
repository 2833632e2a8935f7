"""Point sets of Teng et al. 1993, Table 1, as far as they can be made again; and one of clusters."""

from __future__ import annotations

import itertools

import numpy as np


def rand(n: int, seed: int = 0) -> np.ndarray:
    """``rand.n``: n sites at random in the unit cube, float64 (n, 3).

    The paper's own sets are not published; each size and seed gives another set of their kind.
    """
    return np.random.default_rng([seed, n]).random((n, 3))


def cube(side: int = 7) -> np.ndarray:
    """``cube``: the grid of side^3 integer sites, float64. The paper's has 343 sites, so 7 a side."""
    return np.array(list(itertools.product(range(side), repeat=3)), float)


def dodecahedron() -> np.ndarray:
    """``dodecahedron``: the 20 vertices of the regular dodecahedron, all on one sphere; float64 (20, 3)."""
    phi = (1 + 5**0.5) / 2
    vertices: list[tuple[float, ...]] = list(itertools.product((-1.0, 1.0), repeat=3))
    for s, t in itertools.product((-1, 1), repeat=2):
        vertices += [(0, s / phi, t * phi), (s / phi, t * phi, 0), (s * phi, 0, t / phi)]
    return np.array(vertices, float)


def clusters(n: int, seed: int = 0, *, count: int = 20, spread: float = 0.01) -> np.ndarray:
    """n sites in ``count`` normal clusters of that standard deviation in the unit cube, float64 (n, 3)."""
    rng = np.random.default_rng([seed, n])
    centres = rng.random((count, 3))
    return centres[rng.integers(0, count, n)] + spread * rng.standard_normal((n, 3))
