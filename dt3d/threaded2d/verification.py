"""Proving that triangles are the Delaunay triangulation of their sites, with exact arithmetic.

If triangles that share an edge lie on opposite sides of it and none has the far vertex of a neighbour inside
its circumcircle, and if what borders nothing is one polygon, convex at every vertex, that goes once around
them, then they are the Delaunay triangulation of their vertices. `dt3d._proof` has the sentences that are
checked and the theorem that they imply it; here are the exact signs that they need in the plane.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .. import _topology
from .._numba.kernel_cache import cached_njit
from .._proof import Space, Verification, prove
from ..predicates.plane import in_circle, orient2d
from .geometry import conflicts

__all__ = ["Verification", "verify"]


def verify(
    points: npt.ArrayLike,
    triangles: npt.ArrayLike,
    *,
    neighbors: npt.ArrayLike | None = None,
    duplicates: npt.ArrayLike | None = None,
    perturbed: bool = False,
    oriented: bool = False,
) -> Verification:
    """Prove with exact arithmetic that triangles are a Delaunay triangulation of points.

    True if and only if they are: each site is a vertex or equals one, the triangles cover the convex hull
    without overlap and meet edge to edge, and no site is inside a circumcircle. The sentences of the outcome
    imply that together, not each alone; ``dt3d._proof`` shows why. A sentence that has no meaning while an
    earlier one is broken is reported as not checked.

    Parameters
    ----------
    points : float64 (n, 2)
        The sites.
    triangles : int (m, 3)
        Of either orientation: those that turn to the right are turned first, which is a remark.
    neighbors : int (m, 3), optional
        Checked where given: the k-th opposite the k-th vertex, -1 beyond the hull.
    duplicates : int (k, 2), optional
        Sites that need no triangle, and the equal ones that have; found here if left out.
    perturbed : bool
        Also decide cocircular sites: the triangulation must be the one that the symbolic perturbation gives.
    oriented : bool
        Also demand that all triangles turn to the left, as those of `dt3d.threaded2d.Delaunay` do.

    Raises
    ------
    ValueError
        If points are not real, finite and of shape (n, 2), or triangles, neighbors or duplicates are not
        integers, have another shape, or name what there is not.
    MemoryError
        If the system does not have the memory.

    Examples
    --------
    >>> from dt3d.threaded2d import verify
    >>> sites = [[0, 0], [2, 0], [0, 2], [0.5, 0.5]]
    >>> bool(verify(sites[:3], [[0, 1, 2]])), bool(verify(sites, [[0, 1, 2]]))
    (True, False)
    """
    return prove(
        PLANE,
        points,
        triangles,
        neighbors=neighbors,
        duplicates=duplicates,
        perturbed=perturbed,
        oriented=oriented,
    )


@cached_njit
def _orientations(sites, triangles, w):
    signs = np.empty(len(triangles), np.int8)
    for i in range(len(triangles)):
        signs[i] = orient2d(sites, triangles[i, 0], triangles[i, 1], triangles[i, 2], w)
    return signs


@cached_njit
def _count_inside(sites, triangles, apex, perturbed, w):
    count = 0
    for i in range(len(apex)):
        a, b, c = triangles[i, 0], triangles[i, 1], triangles[i, 2]
        if perturbed:
            count += conflicts(sites, a, b, c, apex[i], w)
        else:
            count += in_circle(sites, a, b, c, apex[i], w) > 0
    return count


@cached_njit
def _side(sites, triangle, a, b, w):
    """Where x lies from the line ab, never 0: the first vertex of the triangle that is not on it tells."""
    for j in range(3):
        if triangle[j] != a and triangle[j] != b:
            sign = orient2d(sites, a, b, triangle[j], w)
            if sign != 0:
                return sign
    return 0


@cached_njit
def _count_containing(sites, triangles, w):
    count = 0
    for i in range(1, len(triangles)):
        a, b, c = triangles[i, 0], triangles[i, 1], triangles[i, 2]
        count += (
            _side(sites, triangles[0], a, b, w) >= 0
            and _side(sites, triangles[0], b, c, w) >= 0
            and _side(sites, triangles[0], c, a, w) >= 0
        )
    return count


@cached_njit
def _count_facing(sites, triangle, hull, w):
    count = 0
    for i in range(len(hull)):
        count += _side(sites, triangle, hull[i, 0], hull[i, 1], w) <= 0
    return count


def _dents(sites: np.ndarray, hull: np.ndarray, w: np.ndarray) -> int:
    ends = np.concatenate([hull[:, 1], hull[:, 0]])
    others = np.concatenate([hull[:, 0], hull[:, 1]])
    begins = np.arange(len(ends)) >= len(hull)
    # none is left alone, since the hull is the boundary of a sum of triangles
    pairs, repeated = _topology.matched(ends[:, None], begins)
    if repeated:
        return repeated
    before, after = pairs.T  # the edge that ends at the vertex, and the one that begins there
    corners = np.column_stack([others[before], ends[before], others[after]])
    return int((_orientations(sites, corners, w) < 0).sum())


PLANE = Space(
    words={
        "simplex": "triangle",
        "simplices": "triangles",
        "facet": "edge",
        "a facet": "an edge",
        "ball": "circle",
        "at every ridge": "at every vertex",
    },
    outward=_topology.OUTWARD_IN_PLANE,
    orientations=_orientations,
    count_inside=_count_inside,
    count_containing=_count_containing,
    count_facing=_count_facing,
    dents=_dents,
)
