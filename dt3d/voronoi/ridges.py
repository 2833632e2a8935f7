"""Ridges: the facets that regions of two sites share; those in the plane."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._topology import OUTSIDE


class Ridges(NamedTuple):
    """Ridges and their vertices.

    Attributes
    ----------
    sites : int32 (r, 2)
        The two sites of each.
    indptr, indices : int64 (r + 1,) and int32 (k,)
        The vertices of ridge i are indices[indptr[i]:indptr[i + 1]], in their order around it; -1 for one at
        infinity.
    """

    sites: npt.NDArray[np.int32]
    indptr: npt.NDArray[np.int64]
    indices: npt.NDArray[np.int32]


def ridges_in_plane(simplices: np.ndarray, neighbors: np.ndarray, vertex_of_simplex: np.ndarray) -> Ridges:
    """All ridges that have a length: those of edges whose two triangles have different circumcircles.

    The second vertex is to the left of the way from the first site to the second one.

    Parameters
    ----------
    simplices, neighbors : int32 (m, 3)
        A triangulation, with indices in range.
    vertex_of_simplex : int32 (m,)
        The Voronoi vertex of each.
    """
    # each edge once, from the later of its triangles; those of the hull have no other
    triangle, k = np.nonzero(neighbors < np.arange(len(simplices), dtype=np.int32)[:, None])
    beyond = neighbors[triangle, k]
    left = vertex_of_simplex[triangle]
    right = np.where(beyond == OUTSIDE, OUTSIDE, vertex_of_simplex[beyond])
    kept = left != right
    triangle, k = triangle[kept], k[kept]
    sites = np.column_stack([simplices[triangle, (k + 1) % 3], simplices[triangle, (k + 2) % 3]])
    indices = np.column_stack([right[kept], left[kept]]).astype(np.int32)
    return Ridges(sites, 2 * np.arange(len(sites) + 1), indices.ravel())
