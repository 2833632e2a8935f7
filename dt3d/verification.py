"""Proving that tetrahedra are the Delaunay triangulation of their sites, with exact arithmetic.

If tetrahedra that share a facet lie on opposite sides of it and none has the far vertex of a neighbour inside
its circumsphere, and if what borders nothing is a surface, convex along every edge, that goes once around
them, then they are the Delaunay triangulation of their vertices. `dt3d._proof` has the sentences that are
checked and the theorem that they imply it; here are the exact signs that they need in space.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from . import _topology
from ._numba.kernel_cache import cached_njit
from ._proof import Space, Verification, prove
from .predicates.space import in_sphere, inside, orient3d, orientation_with

__all__ = ["Verification", "verify"]


def verify(
    points: npt.ArrayLike,
    simplices: npt.ArrayLike,
    *,
    neighbors: npt.ArrayLike | None = None,
    duplicates: npt.ArrayLike | None = None,
    perturbed: bool = False,
    oriented: bool = False,
) -> Verification:
    """Prove with exact arithmetic that simplices are a Delaunay triangulation of points.

    True if and only if they are: each site is a vertex or equals one, the tetrahedra cover the convex hull
    without overlap and meet face to face, and no site is inside a circumsphere. The sentences of the outcome
    imply that together, not each alone; ``dt3d._proof`` shows why. A sentence that has no meaning while an
    earlier one is broken is reported as not checked.

    Parameters
    ----------
    points : float64 (n, 3)
        The sites.
    simplices : int (m, 4)
        Of either orientation: those with det[b-a, c-a, d-a] < 0 are turned first, which is a remark.
    neighbors : int (m, 4), optional
        Checked where given: the k-th opposite the k-th vertex, -1 beyond the hull.
    duplicates : int (k, 2), optional
        Sites that need no tetrahedron, and the equal ones that have; found here if left out.
    perturbed : bool
        Also decide cospherical sites: the triangulation must be the one that dt3d's symbolic perturbation
        gives.
    oriented : bool
        Also demand that all tetrahedra are positively oriented, as those of `dt3d.Delaunay` are.

    Raises
    ------
    ValueError
        If points are not real, finite and of shape (n, 3), or simplices, neighbors or duplicates are not
        integers, have another shape, or name what there is not.
    MemoryError
        If the system does not have the memory.

    Examples
    --------
    >>> from dt3d.verification import verify
    >>> sites = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.1, 0.1, 0.1]]
    >>> bool(verify(sites[:4], [[0, 1, 2, 3]])), bool(verify(sites, [[0, 1, 2, 3]]))
    (True, False)
    """
    return prove(
        SPACE,
        points,
        simplices,
        neighbors=neighbors,
        duplicates=duplicates,
        perturbed=perturbed,
        oriented=oriented,
    )


@cached_njit
def _orientations(sites, simplices, w):
    signs = np.empty(len(simplices), np.int8)
    for i in range(len(simplices)):
        v = simplices[i]
        signs[i] = orient3d(sites, v[0], v[1], v[2], v[3], w)
    return signs


@cached_njit
def _count_inside(sites, simplices, apex, perturbed, w):
    count = 0
    for i in range(len(apex)):
        v = simplices[i, 0], simplices[i, 1], simplices[i, 2], simplices[i, 3]
        if perturbed:
            count += inside(sites, v, apex[i], w)
        else:
            count += in_sphere(sites, v[0], v[1], v[2], v[3], apex[i], w) > 0
    return count


@cached_njit
def _count_containing(sites, simplices, w):
    """Tetrahedra but the first that contain x: with x in place of any vertex they stay positive."""
    count = 0
    for i in range(1, len(simplices)):
        v = simplices[i, 0], simplices[i, 1], simplices[i, 2], simplices[i, 3]
        contained = True
        for k in range(4):
            sign = 0
            for j in range(4):
                x = simplices[0, j]
                if x == v[k] or not (x == v[0] or x == v[1] or x == v[2] or x == v[3]):
                    sign = orientation_with(sites, v, k, x, w)
                if sign != 0:
                    break
            if sign < 0:
                contained = False
                break
        count += contained
    return count


@cached_njit
def _count_facing(sites, simplex, hull, w):
    count = 0
    for i in range(len(hull)):
        a, b, c = hull[i, 0], hull[i, 1], hull[i, 2]
        sign = 0
        for j in range(4):
            # seen from outside a facet turns to the left: what is behind it has negative orientation
            if simplex[j] != a and simplex[j] != b and simplex[j] != c:
                sign = orient3d(sites, a, b, c, simplex[j], w)
            if sign != 0:
                break
        count += sign >= 0
    return count


def _dents(sites: np.ndarray, hull: np.ndarray, w: np.ndarray) -> int:
    edges = np.concatenate([hull[:, [0, 1]], hull[:, [1, 2]], hull[:, [2, 0]]])
    opposite = np.concatenate([hull[:, 2], hull[:, 0], hull[:, 1]])
    # none is left alone, since the hull is the boundary of a sum of tetrahedra
    pairs, repeated = _topology.matched(edges)
    if repeated:
        return repeated
    left, right = pairs.T
    return int(_count_bent(sites, np.column_stack([edges[left], opposite[left], opposite[right]]), w))


@cached_njit
def _count_bent(sites, rows, w):
    count = 0
    for i in range(len(rows)):
        # a vertex behind a facet, or on its plane
        count += orient3d(sites, rows[i, 0], rows[i, 1], rows[i, 2], rows[i, 3], w) > 0
    return count


SPACE = Space(
    words={
        "simplex": "tetrahedron",
        "simplices": "simplices",
        "facet": "facet",
        "a facet": "a facet",
        "ball": "sphere",
        "at every ridge": "along every edge",
    },
    outward=_topology.OUTWARD,
    orientations=_orientations,
    count_inside=_count_inside,
    count_containing=_count_containing,
    count_facing=_count_facing,
    dents=_dents,
)
