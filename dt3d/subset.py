"""A part of a triangulation: some of its tetrahedra, as for meshes with holes and alpha shapes."""

from __future__ import annotations

from ._triangulation import InSpace, Part


class Subset(Part, InSpace):
    """Some of the tetrahedra of a triangulation, as `dt3d.Delaunay.subset` makes it.

    Read-only, as the triangulation. It need be neither convex nor connected. Sites keep their numbers, those
    that no tetrahedron uses included.

    Examples
    --------
    >>> import numpy as np, dt3d
    >>> tri = dt3d.Delaunay(np.random.default_rng(0).random((200, 3)))
    >>> corners = tri.points[tri.simplices]
    >>> longest = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=-1).max(axis=(1, 2))
    >>> part = tri.subset(longest < 0.5)
    >>> part.find_simplex([0.5, 0.5, 0.5]) >= 0, part.find_simplex([9, 9, 9]) == dt3d.OUTSIDE
    (np.True_, np.True_)
    """
