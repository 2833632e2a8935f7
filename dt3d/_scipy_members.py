"""The members of `scipy.spatial.Delaunay`, with its names, shapes, dtypes and meaning.

What a triangulation does not store is computed when it is first asked for, and is read-only. d is the
dimension, n the number of sites, m that of simplices.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from . import _lifting
from ._geometry import Geometry
from ._input import check_points, check_queries
from ._results import frozen
from ._topology import OUTSIDE

if TYPE_CHECKING:
    import scipy.spatial

    from ._given import PointsLike
    from .location import Locator


class SciPyMembers(Geometry):
    """A triangulation of the convex hull, with what SciPy's class has."""

    _exact: bool = True
    """Whether all decisions are exact, so that the simplices fill the hull."""

    @property
    def npoints(self) -> int:
        """The number of sites, n.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3], [0, 0]])
        >>> tri.npoints, tri.nsimplex
        (5, 2)
        """
        return len(self.points)

    @property
    def nsimplex(self) -> int:
        """The number of simplices, m.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> tri.nsimplex == len(tri.simplices)
        True
        """
        return len(self.simplices)

    @cached_property
    def min_bound(self) -> np.ndarray:
        """The least coordinates of the sites, float64 (d,).

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> tri.min_bound.tolist(), tri.max_bound.tolist()
        ([0.0, 0.0], [3.0, 3.0])
        """
        return frozen(self.points.min(axis=0))

    @cached_property
    def max_bound(self) -> np.ndarray:
        """The greatest coordinates of the sites, float64 (d,).

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> tri.max_bound.tolist()
        [3.0, 3.0]
        """
        return frozen(self.points.max(axis=0))

    @property
    def furthest_site(self) -> bool:
        """Whether this is a triangulation of furthest sites: False.

        Examples
        --------
        >>> import dt3d
        >>> dt3d.Delaunay([[0, 0], [2, 0], [0, 2]]).furthest_site
        False
        """
        return False

    @cached_property
    def good(self) -> np.ndarray:
        """Qhull's marks of good facets, int32 (m,): 1 for all, as in SciPy by default.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> tri.good.tolist()
        [1, 1]
        """
        return frozen(np.ones(len(self.simplices), np.int32))

    @cached_property
    def convex_hull(self) -> np.ndarray:
        """Facets of the convex hull, int32 (h, d), oriented outwards.

        In space triangles, counter-clockwise from outside; in the plane edges, counter-clockwise about the
        triangles. SciPy's are not oriented.

        Examples
        --------
        >>> import dt3d
        >>> dt3d.Delaunay([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]).convex_hull.shape
        (4, 3)
        >>> dt3d.Delaunay([[0, 0], [1, 0], [0, 1], [1, 1]]).convex_hull.shape
        (4, 2)
        """
        return self._border()

    @cached_property
    def vertex_neighbor_vertices(self) -> tuple[np.ndarray, np.ndarray]:
        """The vertices that an edge joins with each site: ``(indptr, indices)``, int32 (n + 1,) and (2 e,).

        Those of site k are ``indices[indptr[k]:indptr[k + 1]]``, in ascending order; none for duplicates.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> indptr, indices = tri.vertex_neighbor_vertices
        >>> indices[indptr[0]:indptr[1]].tolist(), indices[indptr[1]:indptr[2]].tolist()
        ([1, 2], [0, 2, 3])
        """
        indptr, indices = super()._adjacency
        return frozen(indptr), frozen(indices)

    @property
    def _adjacency(self) -> tuple[np.ndarray, np.ndarray]:
        return self.vertex_neighbor_vertices

    @cached_property
    def vertex_to_simplex(self) -> np.ndarray:
        """A simplex that has each site as a vertex, int32 (n,).

        For a duplicate, a simplex of the site that was used in its place. (SciPy has there the simplex that
        Qhull found near it.)

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3], [0, 0]])
        >>> [k in tri.simplices[t] for k, t in enumerate(tri.vertex_to_simplex[:4])]
        [True, True, True, True]
        >>> bool(tri.vertex_to_simplex[4] == tri.vertex_to_simplex[0])
        True
        """
        simplex = np.full(len(self.points), OUTSIDE, np.int32)
        rows = np.arange(len(self.simplices), dtype=np.int32)
        for corners in self.simplices.T:
            simplex[corners] = rows
        unused, used = self.duplicates.T
        simplex[unused] = simplex[used]
        return frozen(simplex)

    @cached_property
    def coplanar(self) -> np.ndarray:
        """Sites that were not used, int32 (k, 3): the site, a simplex of the site at its place, that site.

        Qhull leaves sites out where rounding hides them. Here only duplicates are left out: the first and
        the last column are `duplicates`.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3], [0, 0]])
        >>> tri.coplanar[:, [0, 2]].tolist(), tri.duplicates.tolist()
        ([[4, 0]], [[4, 0]])
        """
        unused, used = self.duplicates.T
        return frozen(np.column_stack([unused, self.vertex_to_simplex[used], used]).astype(np.int32))

    @cached_property
    def transform(self) -> np.ndarray:
        """Affine maps to barycentric coordinates, float64 (m, d + 1, d).

        ``c = transform[i, :d] @ (x - transform[i, d])`` are the first d coordinates of x in simplex i, and
        ``1 - c.sum()`` is the last.

        NaN for slivers, as in SciPy: where the condition number of the matrix exceeds 1 / (1000 eps), and
        nothing would be left of c. SciPy has flat simplices besides, on grids for example, with NaN for their
        maps; here no simplex is flat. `barycentric` gives coordinates of points in slivers, too.

        Examples
        --------
        >>> import numpy as np, dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> x = np.array([0.5, 0.5])
        >>> t = tri.find_simplex(x)
        >>> c = tri.transform[t, :2] @ (x - tri.transform[t, 2])
        >>> weights = np.append(c, 1 - c.sum())
        >>> (weights @ tri.points[tri.simplices[t]]).round(12).tolist()
        [0.5, 0.5]
        """
        return frozen(_lifting.barycentric_transforms(self.points, self.simplices))

    @property
    def paraboloid_scale(self) -> float:
        """The scale s of the paraboloid ``s |x|^2 + t`` onto which sites are lifted, as Qhull chooses it.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> x, s, t = tri.points[3], tri.paraboloid_scale, tri.paraboloid_shift
        >>> bool(abs(tri.lift_points(x)[-1] - (s * x @ x + t)) < 1e-12)
        True
        """
        return self._paraboloid[0]

    @property
    def paraboloid_shift(self) -> float:
        """The shift t of the paraboloid ``s |x|^2 + t`` onto which sites are lifted, as Qhull chooses it.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> bool(tri.paraboloid_shift == tri.lift_points([0, 0])[-1])
        True
        """
        return self._paraboloid[1]

    @cached_property
    def _paraboloid(self) -> tuple[float, float]:
        return _lifting.paraboloid(self.points)

    @cached_property
    def equations(self) -> np.ndarray:
        """Hyperplanes of the lifted simplices, float64 (m, d + 2): unit normals and offsets.

        A point (x, z) lies on that of simplex i if ``equations[i, :-1] @ (*x, z) + equations[i, -1] == 0``.
        Normals point away from the hull of the lifted sites: their last coordinate is negative.

        Examples
        --------
        >>> import numpy as np, dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> normal, offset = tri.equations[0, :-1], tri.equations[0, -1]
        >>> lifted = tri.lift_points(tri.points[tri.simplices[0]])
        >>> bool(np.abs(lifted @ normal + offset).max() < 1e-12), bool(normal[-1] < 0)
        (True, True)
        """
        s, t = self._paraboloid
        return frozen(_lifting.hyperplanes(self.points, self.simplices, s, t))

    def lift_points(self, x: npt.ArrayLike) -> np.ndarray:
        """Lift points to the paraboloid: float64 (..., d + 1).

        Parameters
        ----------
        x : array_like, real (..., d)
            The points.

        Raises
        ------
        ValueError
            If they are not real and of shape (..., d).

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> tri.lift_points([[0, 0], [1, 1]]).shape
        (2, 3)
        """
        points, shape = check_queries(x, self.ndim)
        s, t = self._paraboloid
        return _lifting.lifted(points, s, t).reshape(*shape, self.ndim + 1)

    def plane_distance(self, xi: npt.ArrayLike) -> np.ndarray:
        """Distances of lifted points from the hyperplanes of all simplices: float64 (..., m).

        Positive where a point lies in the circumsphere of a simplex, up to rounding.

        Parameters
        ----------
        xi : array_like, real (..., d)
            The points.

        Raises
        ------
        ValueError
            If they are not real and of shape (..., d).

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> distances = tri.plane_distance([[0.5, 0.5], [9, 9]])
        >>> distances.shape, (distances > 0).any(axis=1).tolist()
        ((2, 2), [True, False])
        """
        lifted = self.lift_points(xi)
        distances: np.ndarray = lifted @ self.equations[:, :-1].T + self.equations[:, -1]
        return distances

    def find_simplex(
        self, xi: npt.ArrayLike, bruteforce: bool = False, tol: float | None = None
    ) -> np.ndarray:
        """The simplex that contains each point, exactly; as `scipy.spatial.Delaunay.find_simplex`.

        Parameters
        ----------
        xi : array_like, real (..., d)
            The points.
        bruteforce : bool
            For SciPy's sake; the answer is exact either way.
        tol : float, optional
            Points outside the hull whose barycentric coordinates in the simplex, where the walk to them left
            the hull, are not less than ``-tol`` count as in it. By default none do.

        Returns
        -------
        int32 (...)
            Rows of `simplices`; `dt3d.OUTSIDE` (-1) for points outside the convex hull, and for those that
            are not finite. Of several simplices that have a point on their common border, any one.

        Raises
        ------
        ValueError
            If the points are not real and of shape (..., d), or ``tol`` is negative or no number.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
        >>> tri.find_simplex([[0.2, 0.2, 0.2], [1, 1, 1]]).tolist()
        [0, -1]
        """
        if tol is None:
            return self._locator.find(xi)
        if not (isinstance(tol, int | float | np.number) and tol >= 0):
            msg = f"tol must be a number that is not negative, or None, got {tol!r}"
            raise ValueError(msg)
        return self._locator.find(xi, float(tol))

    @cached_property
    def _locator(self) -> Locator:
        from .location import Locator

        return Locator(self.points, self.simplices, self.neighbors, self._exact)

    def add_points(self, points: PointsLike, restart: bool = False) -> None:
        """Add sites to a triangulation that was made with ``incremental=True``.

        They get the numbers after those that are there. The result is the same as of all sites at once, but
        for the order of the simplices. Arrays of the user's are as they were; `simplices` and all others are
        new, and are made when they are asked for. In space the triangulation goes on; in the plane, and where
        there are many new sites or larger coordinates than so far, all sites are triangulated again then.

        Parameters
        ----------
        points : array_like (k, d)
            As many as one likes, or none.
        restart : bool
            Whether all sites are to be triangulated again in any case, as in SciPy's class.

        Raises
        ------
        RuntimeError
            Without ``incremental=True``, after `close`, and for copies and pickles, which are finished.
        ValueError
            If the points are not what they should be; then nothing has changed.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]], incremental=True)
        >>> tri.add_points([[2, 2, 2], [0, 0, 0]])
        >>> tri, tri.duplicates.tolist()
        (<dt3d.Delaunay: 6 sites, 2 tetrahedra>, [[5, 0]])
        """
        living = self.__dict__.get("_living")
        if living is None:
            msg = (
                "sites cannot be added to a finished triangulation; make it with incremental=True, or "
                "triangulate all of them again, as of np.concatenate([tri.points, points])"
            )
            raise RuntimeError(msg)
        if not isinstance(restart, bool | np.bool_):
            msg = f"restart must be True or False, got {restart!r}"
            raise ValueError(msg)
        more = check_points(points, living.dimension, may_be_empty=True)
        with living.lock:
            living.add(more, bool(restart))
            if "points" in self.__dict__:
                for name in (*self._arrays_of(self.__dict__), "stats"):
                    self.__dict__.pop(name, None)
                self._keep()

    def close(self) -> None:
        """End an incremental triangulation: no sites can be added, and its store is given up.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]], incremental=True)
        >>> tri.close()
        >>> len(tri.simplices)
        2
        """
        self._finish()
        self.__dict__.pop("_living", None)

    def to_scipy(self) -> scipy.spatial.Delaunay:
        """The same triangulation as an object of SciPy's class, for functions that ask for one.

        Such as `scipy.interpolate.LinearNDInterpolator`, `scipy.interpolate.CloughTocher2DInterpolator`,
        `scipy.spatial.delaunay_plot_2d` and `scipy.spatial.tsearch`. Arrays are copies, since SciPy's class
        lets its users change them.

        Raises
        ------
        ImportError
            If the class of the SciPy that is installed has other fields.

        Examples
        --------
        >>> import numpy as np, dt3d
        >>> from scipy.interpolate import LinearNDInterpolator
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [2, 2]])
        >>> LinearNDInterpolator(tri.to_scipy(), [0, 2, 2, 4])([[0.5, 1]]).tolist()
        [1.5]
        """
        from ._to_scipy import to_scipy

        return to_scipy(self)
