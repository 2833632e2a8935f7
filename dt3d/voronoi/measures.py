"""Areas of ridges and volumes of cells, from the Voronoi vertices."""

from __future__ import annotations

import math

import numpy as np

from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from .._topology import OUTSIDE
from .parts import run_in_parts
from .ridges import Ridges


def areas_of_ridges(vertices: np.ndarray, ridges: Ridges, threads: int | None = None) -> np.ndarray:
    """Areas of ridges in space, and lengths in the plane; infinite for unbounded ones: float64 (r,)."""
    if vertices.shape[1] == 2:
        right, left = ridges.indices.reshape(-1, 2).T
        with np.errstate(over="ignore", invalid="ignore"):
            lengths: np.ndarray = np.hypot(*(vertices[left] - vertices[right]).T)
        lengths[(right == OUTSIDE) | np.isnan(lengths)] = np.inf
        return lengths
    areas = np.empty(len(ridges.sites))

    def work(part: int, begin: int, end: int) -> None:
        _areas(vertices, ridges.indptr[begin : end + 1], ridges.indices, areas[begin:end])

    run_in_parts(work, len(areas), threads)
    return areas


@cached_njit(nogil=True)
def _areas(vertices, indptr, indices, areas):
    """Write the areas of ridges in space."""
    vertices, indices = unowned(vertices), unowned(indices)
    for i in range(len(areas)):
        begin, end = indptr[i], indptr[i + 1]
        first = indices[begin]  # -1 for infinity is always the first
        x = y = z = math.inf
        if first != OUTSIDE:
            x = y = z = 0.0
            ox, oy, oz = vertices[first, 0], vertices[first, 1], vertices[first, 2]
            v = indices[begin + 1]
            px, py, pz = vertices[v, 0] - ox, vertices[v, 1] - oy, vertices[v, 2] - oz
            for j in range(begin + 2, end):
                v = indices[j]
                qx, qy, qz = vertices[v, 0] - ox, vertices[v, 1] - oy, vertices[v, 2] - oz
                x, y, z = x + (py * qz - pz * qy), y + (pz * qx - px * qz), z + (px * qy - py * qx)
                px, py, pz = qx, qy, qz
        area = math.hypot(math.hypot(x, y), z) / 2.0
        # where vertices are beyond all numbers, so is the area
        areas[i] = math.inf if math.isnan(area) else area


def volumes_of_cells(points: np.ndarray, ridges: Ridges, areas: np.ndarray) -> np.ndarray:
    """Volumes of cells, areas in the plane: float64 (n,), infinite for unbounded ones, 0 for duplicates.

    A cell is made up of pyramids from its site to its ridges, as high as half the way to the other site.
    """
    d = points.shape[1]
    first, second = ridges.sites.T
    with np.errstate(over="ignore", under="ignore"):
        apart = np.hypot.reduce(points[second] - points[first], axis=1)
        pyramids = areas * apart / (2 * d)
        both: np.ndarray = np.bincount(first, pyramids, len(points)) + np.bincount(
            second, pyramids, len(points)
        )
    return both
