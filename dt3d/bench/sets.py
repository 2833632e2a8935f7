"""What is triangulated: generated sites of several distributions, and files."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

CLUSTERS = 50
SPREAD = 1e-3  # standard deviation of a cluster in the unit cube
THIN = 1e-3  # thickness of a shell of radius 1, and of a slab


@dataclass(frozen=True)
class Sites:
    """A named set: ``points`` float64 (n, 3)."""

    name: str
    points: np.ndarray


def _uniform(n: int, random: np.random.Generator) -> np.ndarray:
    return random.random((n, 3))


def _gauss(n: int, random: np.random.Generator) -> np.ndarray:
    return random.standard_normal((n, 3))


def _clusters(n: int, random: np.random.Generator) -> np.ndarray:
    centres = random.random((CLUSTERS, 3))
    return centres[random.integers(CLUSTERS, size=n)] + SPREAD * random.standard_normal((n, 3))


def _sphere(n: int, random: np.random.Generator) -> np.ndarray:
    sites = random.standard_normal((n, 3))
    return np.asarray(sites / np.linalg.norm(sites, axis=1, keepdims=True))


def _thin_sphere(n: int, random: np.random.Generator) -> np.ndarray:
    return _sphere(n, random) * (1 + THIN * random.random((n, 1)))


def _ball(n: int, random: np.random.Generator) -> np.ndarray:
    return _sphere(n, random) * np.cbrt(random.random((n, 1)))


def _grid(n: int, random: np.random.Generator) -> np.ndarray:
    """The grid of about n sites: of k^3, all ties."""
    k = max(2, round(n ** (1 / 3)))
    return np.indices((k, k, k)).reshape(3, -1).T.astype(float)


def _slab(n: int, random: np.random.Generator) -> np.ndarray:
    return np.asarray(random.random((n, 3)) * [1, 1, THIN])


DISTRIBUTIONS: dict[str, Callable[[int, np.random.Generator], np.ndarray]] = {
    "uniform": _uniform,
    "gauss": _gauss,
    "clusters": _clusters,
    "sphere": _sphere,
    "thin-sphere": _thin_sphere,
    "ball": _ball,
    "grid": _grid,
    "slab": _slab,
}


def generated(distribution: str, n: int, seed: int = 0) -> Sites:
    """About n sites of a distribution (`DISTRIBUTIONS`); a grid has the nearest cube of a whole number.

    Raises ValueError for an unknown distribution, and for less than four sites.
    """
    if distribution not in DISTRIBUTIONS:
        msg = f"there is no distribution {distribution!r}; there are {', '.join(DISTRIBUTIONS)}"
        raise ValueError(msg)
    if n < 4:
        msg = f"a triangulation needs at least four sites, got the size {n}"
        raise ValueError(msg)
    return Sites(distribution, DISTRIBUTIONS[distribution](n, np.random.default_rng(seed)))


def from_file(path: Path) -> Sites:
    """The points of a file, named after it; raises what `dt3d.files.read_points` raises."""
    from ..files import read_points

    return Sites(path.stem, read_points(path))
