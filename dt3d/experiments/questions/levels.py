"""The depth of tetrahedra in a finished triangulation, from first facets of any choice.

A tetrahedron with a first facet has depth 1, any other one more than the least of its neighbours (Teng et al.
1993, section 3). The algorithm goes through the tetrahedra in this order, a depth in each iteration. So its
rounds and face expansions for other first facets are known without running it again.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..._topology import OUTSIDE, OUTWARD


@dataclass(frozen=True)
class Facets:
    """All facets of a triangulation, each once.

    Attributes
    ----------
    vertices : int32 (f, 3)
    tetrahedra : int32 (f, 2)
        On its two sides; the second is -1 on the hull.
    """

    vertices: np.ndarray
    tetrahedra: np.ndarray


def facets_of(simplices: np.ndarray, neighbors: np.ndarray) -> Facets:
    """The facets of tetrahedra int32 (k, 4) with their neighbours int32 (k, 4), -1 outside."""
    own, side = np.nonzero((neighbors == OUTSIDE) | (np.arange(len(simplices))[:, None] < neighbors))
    vertices = simplices[own[:, None], OUTWARD[side]]
    return Facets(vertices, np.column_stack([own, neighbors[own, side]]).astype(np.int32))


def least_circle(points: np.ndarray, facets: Facets) -> np.ndarray:
    """The paper's first facet of each site: with its nearest site, and the least circumcircle of those.

    Parameters
    ----------
    points : float64 (n, 3)
        Every one a vertex, no two pairs of which are equally far apart.
    facets : Facets
        Of their triangulation.

    Returns
    -------
    int64 (n,)
        Rows of the facets.
    """
    corners = points[facets.vertices]
    sides = np.stack([((corners[:, k - 1] - corners[:, k - 2]) ** 2).sum(axis=1) for k in range(3)], axis=1)
    nearest = np.full(len(points), np.inf)
    for k in range(3):  # the sides that meet in corner k are those opposite the two others
        np.minimum.at(nearest, facets.vertices[:, k], np.minimum(sides[:, k - 1], sides[:, k - 2]))
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    with np.errstate(divide="ignore"):
        circle = sides.prod(axis=1) / (normal**2).sum(axis=1)  # 4 squared radii
    least = nearest[facets.vertices]
    has_nearest = np.stack(
        [(sides[:, k - 1] == least[:, k]) | (sides[:, k - 2] == least[:, k]) for k in range(3)], axis=1
    )
    return _best(facets, np.where(has_nearest, circle[:, None], np.inf), len(points))


def random_facets(n: int, facets: Facets, rng: np.random.Generator) -> np.ndarray:
    """A facet of each of n sites, any with the same chance: int64 (n,), rows of the facets."""
    return _best(facets, rng.random(facets.vertices.shape), n)


def _best(facets: Facets, scores: np.ndarray, n: int) -> np.ndarray:
    """The row of the least score (f, 3) of each site."""
    least = np.full(n, np.inf)
    for k in range(3):
        np.minimum.at(least, facets.vertices[:, k], scores[:, k])
    if not np.isfinite(least).all():
        msg = f"{np.isinf(least).sum()} sites have no first facet"
        raise ValueError(msg)
    best = np.empty(n, np.int64)
    for k in range(3):
        site = facets.vertices[:, k]
        rows = np.flatnonzero(scores[:, k] == least[site])
        best[site[rows]] = rows
    return best


def depths(neighbors: np.ndarray, first: np.ndarray) -> np.ndarray:
    """The depth of each tetrahedron, int32 (k,), from tetrahedra that have a first facet: depth 1.

    Parameters
    ----------
    neighbors : int32 (k, 4)
        -1 outside.
    first : int (s,)
        Tetrahedra; some may come twice, and -1 is left out.
    """
    depth = np.zeros(len(neighbors) + 1, np.int32)
    depth[-1] = 1  # where -1 leads
    at = np.unique(first[first >= 0])
    seen_by = np.empty(len(neighbors), np.int64)
    level = 1
    depth[at] = level
    while len(at):
        level += 1
        near = neighbors[at].reshape(-1)
        near = near[depth[near] == 0]
        depth[near] = level
        number = np.arange(len(near))
        seen_by[near] = number
        at = near[seen_by[near] == number]
    return depth[:-1]


@dataclass(frozen=True)
class Growth:
    """What the algorithm would do from some first facets.

    Attributes
    ----------
    first : int
        Distinct first facets.
    depth : int
        The greatest of a tetrahedron.
    rounds : int
        Iterations, the paper's column "depth": one more where the deepest tetrahedra have facets on the hull.
    face_expansions : int
    """

    first: int
    depth: int
    rounds: int
    face_expansions: int


def growth(neighbors: np.ndarray, facets: Facets, first: np.ndarray) -> Growth:
    """Rounds and face expansions from first facets int (s,), rows of the facets."""
    first = np.unique(first)
    depth = depths(neighbors, facets.tetrahedra[first].reshape(-1))
    deepest = int(depth.max())
    hull = facets.tetrahedra[:, 1] == OUTSIDE
    opened = hull.copy()
    opened[first] = False  # its outer side is expanded in the first round
    outer = depth[facets.tetrahedra[opened, 0]]
    a, b = depth[facets.tetrahedra[~hull]].T
    # both sides of each first facet, then what leads on to the next depth, or to the outside
    expanded = 2 * len(first) + int((a != b).sum()) + int(opened.sum())
    last = bool((outer == deepest).any())
    return Growth(len(first), deepest, deepest + last, expanded)
