"""Proving that triangles are the Delaunay triangulation of their sites, with exact arithmetic.

If all triangles turn to the left, no two neighbours have the far vertex of one inside the circle of the
other, and what borders nothing is one convex polygon, then they are the Delaunay triangulation (B. Delaunay,
Sur la sphere vide, 1934). Ties are checked too: the result must be the one that the symbolic perturbation
defines.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np

from .._input import exactly_scaled
from .._memory import require
from ..predicates import work_array
from ..predicates.filtered2d import orient2d
from ..verification import Verification
from .geometry import conflicts

BYTES_PER_TRIANGLE = 170  # as measured


def verify(points: Any, triangles: Any, neighbors: Any, duplicates: Any) -> Verification:
    """Check every invariant of a 2D Delaunay triangulation exactly.

    Parameters
    ----------
    points : float64 (n, 2)
    triangles, neighbors : int (m, 3)
    duplicates : int (k, 2)

    Raises
    ------
    ValueError
        If triangles name sites that there are not.
    MemoryError
        If the system does not have the memory.
    """
    points, triangles = np.asarray(points, np.float64), np.asarray(triangles, np.int64).reshape(-1, 3)
    if len(triangles) and not 0 <= triangles.min() <= triangles.max() < len(points):
        msg = (
            f"triangles name sites {triangles.min()} to {triangles.max()}, but there are {len(points)} points"
        )
        raise ValueError(msg)
    require(f"verifying {len(triangles)} triangles", BYTES_PER_TRIANGLE * len(triangles))
    sites = np.ascontiguousarray(exactly_scaled(points))
    w = work_array(sites)
    adjacent, crowded = _adjacent(triangles)
    turned, inside = _count_broken(sites, triangles, adjacent, w)
    t, k = np.nonzero(adjacent < 0)
    hull = np.column_stack([triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]])
    used = np.unique(triangles)
    edges = (3 * len(triangles) + len(hull)) // 2
    return Verification(
        (
            ("every site is a vertex, or a duplicate of one", _lost(points, used, duplicates)),
            ("every triangle turns to the left", turned),
            ("every edge is shared by at most two triangles", crowded),
            ("neighbors says which ones", int((np.asarray(neighbors) != adjacent).sum())),
            ("no site is inside the circle across an edge, ties decided by the perturbation", inside),
            ("the hull is one convex polygon", _dents(sites, hull, w)),
            ("vertices - edges + triangles = 1 (Euler)", abs(len(used) - edges + len(triangles) - 1)),
        )
    )


def _lost(points: np.ndarray, used: np.ndarray, duplicates: Any) -> int:
    """Sites that are in no triangle and not listed, and listed ones that equal no vertex."""
    pairs = np.asarray(duplicates).reshape(-1, 2)
    named = np.zeros(len(points), np.int64)
    named[used] += 1
    np.add.at(named, pairs[:, 0], 1)
    false = (points[pairs[:, 0]] != points[pairs[:, 1]]).any(axis=1) | ~np.isin(pairs[:, 1], used)
    return int((named != 1).sum() + false.sum())


def _adjacent(triangles: np.ndarray) -> tuple[np.ndarray, int]:
    """Neighbours by their common edges, int64 (m, 3), and the number of edges with more than two sides."""
    ends = np.sort(triangles[:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2), axis=1)
    key = ends[:, 0] << 32 | ends[:, 1]
    order = np.argsort(key, kind="stable")
    same = key[order][1:] == key[order][:-1]
    adjacent = np.full(3 * len(triangles), -1, np.int64)
    first, second = order[:-1][same], order[1:][same]
    adjacent[first], adjacent[second] = second // 3, first // 3
    return adjacent.reshape(-1, 3), int((same[1:] & same[:-1]).sum())


@numba.njit(cache=True)
def _count_broken(points, triangles, adjacent, w):
    """Triangles that do not turn to the left, and pairs of neighbours that the circle test forbids."""
    turned = inside = 0
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        if orient2d(points, a, b, c, w) <= 0:
            turned += 1
            continue
        for k in range(3):
            u = adjacent[t, k]
            if u < 0:
                continue
            for j in range(3):
                far = triangles[u, j]
                if far != a and far != b and far != c:
                    inside += conflicts(points, a, b, c, far, w)
    return turned, inside


def _dents(sites: np.ndarray, hull: np.ndarray, w: np.ndarray) -> int:
    """Vertices where the border is not one line that turns to the left or goes straight on."""
    if not len(hull):
        return 1
    following = np.full(len(sites), -1, np.int64)
    following[hull[:, 0]] = hull[:, 1]
    at, around = hull[0, 0], 0
    while around < len(hull):
        at, around = following[at], around + 1
        if at < 0 or at == hull[0, 0]:
            break
    if at != hull[0, 0] or around != len(hull):
        return abs(len(hull) - around) + 1
    return int(_right_turns(sites, hull, following, w))


@numba.njit(cache=True)
def _right_turns(points, hull, following, w):
    count = 0
    for i in range(len(hull)):
        a, b = hull[i, 0], hull[i, 1]
        count += orient2d(points, a, b, following[b], w) < 0
    return count
