"""Regions: the Voronoi vertices of each site's cell."""

from __future__ import annotations

import gc
from itertools import pairwise

import numpy as np

from .._numba.kernel_cache import cached_njit
from .._topology import OUTSIDE, hull_facets


def regions_of_sites(
    simplices: np.ndarray, neighbors: np.ndarray, vertex_of_simplex: np.ndarray, n: int
) -> tuple[np.ndarray, np.ndarray]:
    """The vertices of each of n regions: (indptr, indices), int64 (n + 1,) and int32 (k,).

    Those of region k are indices[indptr[k]:indptr[k + 1]], each once; -1 for infinity, where there is one, is
    the first. In the plane they are counter-clockwise around the region, in space ascending. Sites that are
    not used have none.
    """
    begin = np.zeros(n + 1, np.int64)
    begin[1:] = np.bincount(simplices.ravel(), minlength=n)
    on_hull = np.zeros(n, np.bool_)
    on_hull[hull_facets(simplices, neighbors)] = True
    begin[1:] += on_hull
    np.cumsum(begin, out=begin)
    if simplices.shape[1] == 3:
        indptr, indices = _around_sites(simplices, neighbors, vertex_of_simplex, begin)
    else:
        indptr, indices = _at_sites(simplices, vertex_of_simplex, begin, on_hull)
    return indptr, indices


@cached_njit
def _at_sites(simplices, vertex, begin, on_hull):
    """The vertices of all simplices at each site, ascending."""
    at, indices = begin[:-1].copy(), np.empty(begin[-1], np.int32)
    for v in range(len(at)):
        if on_hull[v]:
            indices[at[v]] = OUTSIDE
            at[v] += 1
    for t in range(len(simplices)):
        for k in range(simplices.shape[1]):
            v = simplices[t, k]
            indices[at[v]] = vertex[t]
            at[v] += 1
    indptr, end = np.zeros_like(begin), 0
    for v in range(len(at)):
        found = indices[begin[v] : at[v]]
        for i in range(1, len(found)):
            if found[i] < found[i - 1]:
                found.sort()
                break
        for i in range(len(found)):
            if i == 0 or found[i] != indices[end - 1]:
                indices[end] = found[i]
                end += 1
        indptr[v + 1] = end
    return indptr, indices[:end].copy()


@cached_njit
def _around_sites(triangles, neighbors, vertex, begin):
    """The vertices of the triangles around each site in the plane, counter-clockwise."""
    n = len(begin) - 1
    start = np.full(n, OUTSIDE, np.int32)
    for t in range(len(triangles)):
        for k in range(3):
            v = triangles[t, k]
            # an open fan begins at the border
            if start[v] == OUTSIDE or neighbors[t, (k + 2) % 3] == OUTSIDE:
                start[v] = t
    indptr, indices, end = np.zeros_like(begin), np.empty(begin[-1], np.int32), 0
    for v in range(n):
        t, first = start[v], end
        if t != OUTSIDE and neighbors[t, (_corner(triangles, t, v) + 2) % 3] == OUTSIDE:
            indices[end] = OUTSIDE
            end += 1
        while t != OUTSIDE:
            if end == first or indices[end - 1] != vertex[t]:
                indices[end] = vertex[t]
                end += 1
            t = neighbors[t, (_corner(triangles, t, v) + 1) % 3]
            if t == start[v]:
                break
        if end - first > 1 and indices[end - 1] == indices[first]:
            end -= 1
        indptr[v + 1] = end
    return indptr, indices[:end].copy()


@cached_njit
def _corner(triangles, t, v):
    return 0 if triangles[t, 0] == v else (1 if triangles[t, 1] == v else 2)


def as_lists(indptr: np.ndarray, indices: np.ndarray) -> list[list[int]]:
    """The rows that indptr divides indices into, as lists."""
    # Python's collector would look through all these lists again and again, for cycles that they do not have
    collecting = gc.isenabled()
    gc.disable()
    try:
        flat = indices.tolist()
        return [flat[begin:end] for begin, end in pairwise(indptr.tolist())]
    finally:
        if collecting:
            gc.enable()
