"""Ridges in space: the circumspheres around each edge of a triangulation.

The ridge between sites p and q is a polygon whose vertices are the circumcenters of the tetrahedra around
edge pq. Each edge is found from the tetrahedron of least index at it, so that threads can share the work
without a table of edges.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._errors import InternalError
from .._input import exactly_scaled
from .._memory import require
from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from .._topology import OUTSIDE
from ..predicates import work_array
from ..predicates.space import orient3d
from .parts import run_in_parts
from .ridges import Ridges

# corners i, j, k, m, an even permutation: k, m is the way about edge ij that a right-handed screw turns
EDGES = (0, 1, 2, 3), (0, 2, 3, 1), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 2, 0), (2, 3, 0, 1)


LARGER_SHARE = 4  # room for a part of the ridges, beside its share of the tetrahedra
TOO_MANY = -1


class Mesh(NamedTuple):
    """A triangulation, and the Voronoi vertex of each tetrahedron."""

    simplices: npt.NDArray[np.int32]
    neighbors: npt.NDArray[np.int32]
    vertex: npt.NDArray[np.int32]


def ridges_in_space(
    points: np.ndarray,
    simplices: np.ndarray,
    neighbors: np.ndarray,
    vertex_of_simplex: np.ndarray,
    threads: int | None = None,
) -> Ridges:
    """All ridges that have an area.

    Parameters
    ----------
    points : float64 (n, 3)
        Sites.
    simplices, neighbors : int32 (m, 4)
        A triangulation, with indices in range.
    vertex_of_simplex : int32 (m,)
        As `merging.vertices_of_simplices` gives it.
    threads : int, optional
        The most threads.
    """
    m = len(simplices)
    # each tetrahedron is in six rings, an edge of the hull adds a place at infinity, a ridge has two places
    places = 6 * m + 3 * int(np.count_nonzero(neighbors == OUTSIDE))
    size = (4 + 8) * places  # bytes
    require(f"the ridges about {len(points)} sites", 2 * size, (LARGER_SHARE + 1) * size)
    mesh, sites = Mesh(simplices, neighbors, vertex_of_simplex), exactly_scaled(points)
    found: dict[int, Ridges] = {}

    def write(part: int, begin: int, end: int) -> None:
        # early tetrahedra are the least of more rings; only what is written takes memory
        for room in (min(places, LARGER_SHARE * places * (end - begin) // m), places):
            ridges = _ridges_of(mesh, sites, (begin, end), room)
            if ridges is not None:
                found[part] = ridges
                return
        msg = f"the ridges of {m} tetrahedra have more than {places} vertices"
        raise InternalError(msg)

    run_in_parts(write, m, threads)
    return _joined([found[part] for part in sorted(found)])


def _ridges_of(mesh: Mesh, sites: np.ndarray, part: tuple[int, int], places: int) -> Ridges | None:
    """The ridges of which some tetrahedra are the least; None if they have more vertices than places."""
    most = places // 2
    own = Ridges(np.empty((most, 2), np.int32), np.zeros(most + 1, np.int64), np.empty(places, np.int32))
    count = _write(mesh, sites, part, own, work_array(sites))
    if count == TOO_MANY:
        return None
    return Ridges(own.sites[:count], own.indptr[: count + 1], own.indices[: own.indptr[count]])


def _joined(parts: list[Ridges]) -> Ridges:
    """The ridges of several parts."""
    begin, indptr = 0, [np.zeros(1, np.int64)]
    for part in parts:
        indptr.append(part.indptr[1:] + begin)
        begin += len(part.indices)
    return Ridges(
        np.concatenate([part.sites for part in parts]),
        np.concatenate(indptr),
        np.concatenate([part.indices for part in parts]),
    )


@cached_njit
def _edge(mesh, t, e):
    """The e-th edge pq of tetrahedron t, p < q, and its other vertices r, s, positively oriented."""
    i, j, k, m = EDGES[e]
    p, q = np.int64(mesh.simplices[t, i]), np.int64(mesh.simplices[t, j])
    r, s = np.int64(mesh.simplices[t, k]), np.int64(mesh.simplices[t, m])
    return (p, q, r, s) if p < q else (q, p, s, r)


@cached_njit
def _beyond(mesh, t, r):
    """The neighbour of t opposite its vertex r."""
    for k in range(3):
        if mesh.simplices[t, k] == r:
            return np.int64(mesh.neighbors[t, k])
    return np.int64(mesh.neighbors[t, 3])


@cached_njit
def _fourth(mesh, t, three):
    """The vertex of t that makes up its sum with three others, whose sum is given."""
    v = mesh.simplices
    return np.int64(v[t, 0]) + v[t, 1] + v[t, 2] + v[t, 3] - three


@cached_njit
def _ring(mesh, t, edge, out, place):
    """Write the Voronoi vertices around an edge pqrs of t to out[place:], as far as there is room.

    Each once, where equal ones follow each other, in the order of a right-handed screw about pq. Those of a
    ring that the border opens begin with `OUTSIDE`. 0 if t is not the least tetrahedron of the ring.

    Returns
    -------
    int, bool, int, int
        The number, whether the ring is open, and the vertices that end its first and last facet, if so.
    """
    p, q, r, s = edge
    u, a, b, count, last = t, r, s, 1, mesh.vertex[t]
    if place < len(out):
        out[place] = last
    while True:
        beyond = _beyond(mesh, u, a)
        if beyond == t:
            return count - (count > 1 and last == mesh.vertex[t]), False, r, s
        if beyond == OUTSIDE:
            return _open_ring(mesh, t, edge, out, place)
        if beyond < t:
            return 0, False, r, s
        u, a, b = beyond, b, _fourth(mesh, beyond, p + q + b)
        if mesh.vertex[u] != last:
            last = mesh.vertex[u]
            if place + count < len(out):
                out[place + count] = last
            count += 1


@cached_njit
def _open_ring(mesh, t, edge, out, place):
    """The same for an edge of the hull."""
    p, q, r, s = edge
    u, a, b = t, r, s
    while True:  # back to where it begins
        beyond = _beyond(mesh, u, b)
        if beyond == OUTSIDE:
            break
        if beyond < t:
            return 0, True, r, s
        u, a, b = beyond, _fourth(mesh, beyond, p + q + a), a
    begin, count, last = a, 1, np.int32(OUTSIDE)
    if place < len(out):
        out[place] = OUTSIDE
    while True:
        if u < t:
            return 0, True, r, s
        if mesh.vertex[u] != last:
            last = mesh.vertex[u]
            if place + count < len(out):
                out[place + count] = last
            count += 1
        beyond = _beyond(mesh, u, a)
        if beyond == OUTSIDE:
            return count, True, begin, b
        u, a, b = beyond, b, _fourth(mesh, beyond, p + q + b)


@cached_njit(nogil=True)
def _write(mesh, points, part, ridges, w):
    """Write the ridges of all edges of which one of a part is the least; their number, or `TOO_MANY`."""
    mesh, points, ridges, w = unowned(mesh), unowned(points), unowned(ridges), unowned(w)
    found = place = 0
    for t in range(part[0], part[1]):
        for e in range(6):
            _, _, k, m = EDGES[e]
            if 0 <= mesh.neighbors[t, k] < t or 0 <= mesh.neighbors[t, m] < t:
                continue  # not the least, which saves a look at another tetrahedron
            edge = _edge(mesh, t, e)
            count, is_open, begin, end = _ring(mesh, t, edge, ridges.indices, place)
            # a wedge of one vertex has an area, unless its rays are parallel: facets of the hull in a plane
            if count >= 3 or (is_open and count and orient3d(points, edge[0], edge[1], begin, end, w) != 0):
                if found == len(ridges.sites) or place + count > len(ridges.indices):
                    return TOO_MANY
                ridges.sites[found, 0], ridges.sites[found, 1] = edge[0], edge[1]
                found, place = found + 1, place + count
                ridges.indptr[found] = place
    return found
