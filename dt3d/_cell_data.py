"""What is said of each simplex where a triangulation is shown or leaves as a mesh: sizes, shapes, depths."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from ._topology import OUTSIDE, matched


class Simplices(Protocol):
    """What has cell data: a `Delaunay`, a `Subset`, or a `Mesh` from a file, which has no neighbors."""

    @property
    def points(self) -> np.ndarray:
        """Sites, float (n, d)."""

    @property
    def simplices(self) -> np.ndarray:
        """Vertices of each simplex, int (m, d + 1)."""


def cell_data(tri: Simplices) -> dict[str, np.ndarray]:
    """Arrays with an entry per simplex, all of them new, by name.

    ============= ============================================================================================
    volume        of the tetrahedron; in the plane "area"; float64
    longest_edge  its length, float64
    circumradius  the radius of the circumscribed sphere, in the plane circle; float64
    depth         how many facets lie between the simplex and the hull: 0 for those that have a facet of it;
                  in a part of a triangulation, of its boundary; int32
    iteration     in space, the iteration that found it, int32; left out where all are 1, as by insertion
    thread        in the plane, the thread that made it, int16; left out where it was one thread
    ============= ============================================================================================
    """
    from .geometry.circumcenters import circumcenters
    from .geometry.depths import depths
    from .geometry.edge_lengths import longest_edges
    from .geometry.measures import measures

    points = np.ascontiguousarray(tri.points, np.float64)
    simplices = np.ascontiguousarray(tri.simplices, np.int32)
    in_space = points.shape[1] == 3
    neighbors = getattr(tri, "neighbors", None)
    data = {
        "volume" if in_space else "area": measures(points, simplices),
        "longest_edge": longest_edges(points, simplices),
        "circumradius": circumcenters(points, simplices)[1],
        "depth": depths(neighbors_of(simplices) if neighbors is None else neighbors),
    }
    # constants say nothing; but if all of a part were found by one round after the first, that does
    if in_space:
        iteration = np.array(getattr(tri, "iteration", 1), np.int32)
        if (iteration != 1).any():
            data["iteration"] = iteration
    elif varies(thread := np.array(getattr(tri, "thread", 0), np.int16)):
        data["thread"] = thread
    return data


def varies(values: np.ndarray) -> bool:
    """Whether an array has more than one value, so that colours tell something."""
    return bool(values.size) and bool((values != values.flat[0]).any())


def neighbors_of(simplices: np.ndarray) -> np.ndarray:
    """The simplex across each facet, int64 (m, d + 1), for meshes that do not say; `OUTSIDE` for none.

    Where a damaged mesh has more than two simplices at a facet, each has one of the others.
    """
    m, corners = simplices.shape
    opposite = [np.delete(np.arange(corners), k) for k in range(corners)]
    pairs, _ = matched(simplices[:, opposite].reshape(-1, corners - 1))
    first, second = pairs.T
    neighbors = np.full(m * corners, OUTSIDE, np.int64)
    neighbors[first] = second // corners
    neighbors[second] = first // corners
    return neighbors.reshape(m, corners)
