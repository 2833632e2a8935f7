"""What is measured in a triangulation: sizes, circumcenters, edges, weights; in the plane and in space.

All is computed when it is first asked for, by threads, and is read-only. d is the dimension, n the number of
sites, m that of simplices.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np
import numpy.typing as npt

from ._input import check_queries
from ._results import check_range, frozen
from ._triangulation import Triangulation

if TYPE_CHECKING:
    import scipy.sparse


class Geometry(Triangulation):
    """A triangulation or a part of one, with what is measured in it."""

    @cached_property
    def volumes(self) -> np.ndarray:
        """The volume of each tetrahedron, in the plane the area of each triangle: float64 (m,).

        Positive and accurate to some units in the last place, for slivers, too.

        Examples
        --------
        >>> import dt3d
        >>> dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [2, 2]]).volumes.tolist()
        [2.0, 2.0]
        """
        from .geometry.measures import measures

        self._check_simplices()
        return frozen(measures(self.points, self.simplices))

    @cached_property
    def _circumspheres(self) -> tuple[np.ndarray, np.ndarray]:
        from .geometry.circumcenters import circumcenters

        self._check_simplices()
        centers, radii = circumcenters(self.points, self.simplices)
        return frozen(centers), frozen(radii)

    @property
    def circumcenters(self) -> np.ndarray:
        """The center of each simplex's circumscribed sphere, in the plane circle: float64 (m, d).

        They are vertices of the Voronoi diagram. Those of slivers lie far outside, accurately: up to rounding
        of the coordinates, the distance to all vertices is the radius.

        Examples
        --------
        >>> import dt3d
        >>> dt3d.Delaunay([[0, 0], [2, 0], [0, 2]]).circumcenters.tolist()
        [[1.0, 1.0]]
        """
        return self._circumspheres[0]

    @property
    def circumradii(self) -> np.ndarray:
        """The radius of each simplex's circumscribed sphere, in the plane circle: float64 (m,).

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [3, 0], [0, 4]])
        >>> tri.circumradii.tolist(), tri.circumcenters.tolist()
        ([2.5], [[1.5, 2.0]])
        """
        return self._circumspheres[1]

    @cached_property
    def edges(self) -> np.ndarray:
        """Each edge once, int32 (e, 2): the lesser site first, rows in ascending order.

        Examples
        --------
        >>> import dt3d
        >>> dt3d.Delaunay([[0, 0], [2, 0], [0, 2]]).edges.tolist()
        [[0, 1], [0, 2], [1, 2]]
        """
        indptr, indices = self._adjacency
        first = np.repeat(np.arange(len(self.points), dtype=np.int32), np.diff(indptr))
        once = first < indices
        return frozen(np.column_stack([first[once], indices[once]]))

    @property
    def _adjacency(self) -> tuple[np.ndarray, np.ndarray]:
        """The sites that an edge joins with each site: offsets and indices."""
        from ._vertices import neighbors_of_vertices

        self._check_simplices()
        return neighbors_of_vertices(self.simplices, len(self.points))

    def to_sparse(self, weights: Literal["one", "length"] = "one") -> scipy.sparse.csr_array:
        """The graph of edges as a symmetric sparse matrix, float64 (n, n), for `scipy.sparse.csgraph`.

        Parameters
        ----------
        weights : "one" or "length"
            What an entry says of its edge: 1, or its length.

        Raises
        ------
        ValueError
            If ``weights`` is another word.

        Examples
        --------
        >>> import dt3d
        >>> dt3d.Delaunay([[0, 0], [3, 0], [0, 4]]).to_sparse("length").toarray().tolist()
        [[0.0, 3.0, 4.0], [3.0, 0.0, 5.0], [4.0, 5.0, 0.0]]
        """
        if weights not in ("one", "length"):
            msg = f"weights must be 'one' or 'length', got {weights!r}"
            raise ValueError(msg)
        from scipy.sparse import csr_array

        indptr, indices = self._adjacency
        if weights == "one":
            values = np.ones(len(indices))
        else:
            first = np.repeat(np.arange(len(self.points)), np.diff(indptr))
            # hypot and not squares, which may overflow or underflow
            sides = self.points[first] - self.points[indices]
            values = np.hypot.reduce(sides, axis=1)
        n = len(self.points)
        return csr_array((values, indices, indptr), shape=(n, n))

    def barycentric(self, xi: npt.ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """The simplex that contains each point, and the weights of its vertices.

        Parameters
        ----------
        xi : array_like, real (..., d)
            The points.

        Returns
        -------
        simplices : int32 (...)
            As `find_simplex` gives them; `dt3d.OUTSIDE` (-1) outside.
        weights : float64 (..., d + 1)
            Their sum is 1, and with them the vertices' sum is the point. Not negative but for rounding, and
            accurate to some units in the last place of 1, for slivers, too. NaN outside.

        Raises
        ------
        ValueError
            If the points are not real and of shape (..., d).

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2]])
        >>> simplices, weights = tri.barycentric([[0.5, 0.5], [3, 3]])
        >>> simplices.tolist(), (weights[0] @ tri.points[tri.simplices[0]]).tolist(), weights[1].tolist()
        ([0, -1], [0.5, 0.5], [nan, nan, nan])
        """
        from .geometry.barycentric import barycentric_weights

        points, shape = check_queries(xi, self.ndim)
        found = self.find_simplex(points)
        weights = barycentric_weights(self.points, self.simplices, found, points)
        return found.reshape(shape), weights.reshape(*shape, self.ndim + 1)

    def find_simplex(self, xi: npt.ArrayLike) -> np.ndarray:
        """The simplex that contains each point: int32 (...)."""
        raise NotImplementedError

    def _check_simplices(self) -> None:
        """Compiled code indexes with them, without a check; somebody may have put others in their place."""
        check_range("simplices", self.simplices, 0, len(self.points))
