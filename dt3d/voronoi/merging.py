"""Which simplices share a Voronoi vertex: those with one circumsphere, by exact in-sphere tests.

The triangulation decides cospherical sites by a symbolic perturbation, so several of its simplices may have
the same circumsphere. They make up one cell of the Delaunay complex, a polytope, and are joined by facets
within it. Its circumcenter is one Voronoi vertex.
"""

from __future__ import annotations

import numpy as np

from .._input import exactly_scaled
from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from .._results import damaged
from .._topology import OUTSIDE
from ..predicates import work_array
from ..predicates.plane import in_circle
from ..predicates.space import in_sphere
from .parts import run_in_parts

BROKEN = -(1 << 62)


def vertices_of_simplices(
    points: np.ndarray, simplices: np.ndarray, neighbors: np.ndarray, threads: int | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """The Voronoi vertex of each simplex, int32 (m,), and the first simplex of each vertex, int64 (k,).

    Vertices are numbered in the order of their first simplices.

    Parameters
    ----------
    points : float64 (n, d)
        Sites.
    simplices, neighbors : int32 (m, d + 1)
        A triangulation, with indices in range.
    threads : int, optional
        The most threads.

    Raises
    ------
    ValueError
        If neighbours do not share facets.
    """
    sites = exactly_scaled(points)
    tied = np.zeros(simplices.shape, np.bool_)
    kernel = _tied_in_plane if points.shape[1] == 2 else _tied_in_space

    more: list[int] = []

    def work(part: int, begin: int, end: int) -> None:
        more.append(kernel(sites, simplices, neighbors, (begin, end), tied, work_array(sites)))

    run_in_parts(work, len(simplices), threads)
    # As many neighbours are earlier as later ones, which were seen to share facets. So those do, too, and
    # walks about edges end.
    if min(more) == BROKEN or sum(more) != 0:
        damaged("neighbors do not share facets")
    simplex, k = np.nonzero(tied)
    labels = np.arange(len(simplices), dtype=np.int32)
    if not len(simplex):
        return labels, np.arange(len(simplices))
    count = _merge(simplex, neighbors[simplex, k], labels)
    first = np.empty(count, np.int64)
    # of equal labels the last that is assigned stays: the first simplex
    first[labels[::-1]] = np.arange(len(labels))[::-1]
    return labels, first


@cached_njit
def _opposite(simplices, neighbors, t, k, corners):
    """The vertex of the neighbour opposite the k-th vertex that is not on the facet between, or -1.

    That is the answer where the two do not share a facet, and each lies beyond it for the other. ``corners``
    is their number, d + 1, as a constant.
    """
    u, found = neighbors[t, k], -1
    for j in range(corners):
        shared = False
        for i in range(corners):
            shared |= i != k and simplices[t, i] == simplices[u, j]
        if not shared:
            if found >= 0 or neighbors[u, j] != t:
                return -1
            found = simplices[u, j]
    return found


@cached_njit
def _has_repetition(simplices, t, corners):
    found = False
    for i in range(1, corners):
        for j in range(i):
            found |= simplices[t, i] == simplices[t, j]
    return found


@cached_njit(nogil=True)
def _tied_in_space(points, simplices, neighbors, part, tied, w):
    """Mark the facets towards a later neighbour that has its opposite vertex on the same sphere.

    Returns how many more neighbours are later than earlier ones, or `BROKEN` where one of the former does not
    share the facet.
    """
    points, simplices, neighbors, w = unowned(points), unowned(simplices), unowned(neighbors), unowned(w)
    more = 0
    for t in range(part[0], part[1]):
        a, b, c, d = simplices[t, 0], simplices[t, 1], simplices[t, 2], simplices[t, 3]
        if _has_repetition(simplices, t, 4):
            return BROKEN
        for k in range(4):
            u = neighbors[t, k]
            if u > t:
                opposite = _opposite(simplices, neighbors, t, k, 4)
                if opposite < 0:
                    return BROKEN
                tied[t, k] = in_sphere(points, a, b, c, d, opposite, w) == 0
                more += 1
            elif u != OUTSIDE:
                more -= 1
    return more


@cached_njit(nogil=True)
def _tied_in_plane(points, simplices, neighbors, part, tied, w):
    """The same for triangles and circles."""
    points, simplices, neighbors, w = unowned(points), unowned(simplices), unowned(neighbors), unowned(w)
    more = 0
    for t in range(part[0], part[1]):
        a, b, c = simplices[t, 0], simplices[t, 1], simplices[t, 2]
        if _has_repetition(simplices, t, 3):
            return BROKEN
        for k in range(3):
            u = neighbors[t, k]
            if u > t:
                opposite = _opposite(simplices, neighbors, t, k, 3)
                if opposite < 0:
                    return BROKEN
                tied[t, k] = in_circle(points, a, b, c, opposite, w) == 0
                more += 1
            elif u != OUTSIDE:
                more -= 1
    return more


@cached_njit
def _root(labels, t):
    while labels[t] != t:
        labels[t] = labels[labels[t]]
        t = labels[t]
    return t


@cached_njit
def _merge(these, those, labels):
    """Join pairs of simplices, each labelled by itself; label each by the number of its set; their count."""
    for i in range(len(these)):
        s, t = _root(labels, these[i]), _root(labels, those[i])
        # the first of a set is its root
        labels[max(s, t)] = min(s, t)
    count = 0
    for t in range(len(labels)):
        if labels[t] == t:
            labels[t] = count
            count += 1
        else:
            labels[t] = labels[labels[t]]
    return count
