"""`dt3d.Voronoi`: what the exact Delaunay triangulation says of the regions nearest to each site."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, NoReturn

import numpy as np
import numpy.typing as npt

from .._given import PointsLike
from .._options import is_count
from .._results import Names, Result, damaged, frozen
from .._scipy_members import SciPyMembers
from .._scipy_options import check_scipy_options
from .._triangulation import Triangulation

if TYPE_CHECKING:
    from .clipped import Clipped
    from .ridges import Ridges


class Voronoi(Result):
    """The Voronoi diagram of points in the plane or in space, in place of `scipy.spatial.Voronoi`.

    The region of a site is what is nearer to it than to any other; a ridge is the facet that two regions
    share. (A. Okabe, B. Boots, K. Sugihara, S. N. Chiu: Spatial Tessellations: Concepts and Applications of
    Voronoi Diagrams, 2nd edition, 2000.) All is derived from the exact Delaunay triangulation when it is
    first asked for, by threads. Arrays are read-only; lists, which are slow to make, have the same for
    SciPy's users. Below, d is the dimension, 2 or 3.

    The topology is exact: simplices whose circumspheres are exactly the same have one Voronoi vertex, and a
    ridge without an area, such as between opposite corners of a square, is left out. SciPy decides both in
    floating point. It also leaves out ridges in space that are unbounded and have one vertex only; here they
    are kept, as ``[-1, v]``, since their regions do share a wedge.

    Parameters
    ----------
    points : array_like (n, d), or dt3d.Delaunay
        Sites: real, finite, at least d + 1 that do not lie on a line or plane. Or their triangulation, which
        is then not computed again.
    furthest_site, incremental : bool
        Only False; these are options of SciPy.
    qhull_options : str, optional
        Those that have no effect on exact results. If there are any and "Qz" is not among them, `regions` has
        no empty region.
    threads : int, optional
        The most threads that work at the same time; by default as many as cores. The result does not depend
        on it.

    Attributes
    ----------
    triangulation : dt3d.Delaunay
        What the diagram is the dual of.
    points : float64 (n, d)
        The sites as given.
    threads : int or None
        As given.

    Raises
    ------
    ValueError
        If the points are not what they should be, for options that cannot be served, and for a triangulation
        that was made with ``robustness="perturb"``, or a part of one.
    DegenerateInputError
        If all sites lie on a plane, a line or a point; in the plane on a line or a point.
    MemoryError
        If the system does not have the memory; says what is needed.

    Examples
    --------
    >>> import dt3d
    >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
    >>> vor.vertices[vor.regions[vor.point_region[4]]].tolist()
    [[0.0, 1.0], [1.0, 0.0], [2.0, 1.0], [1.0, 2.0]]
    >>> vor.volumes.round(12).tolist()
    [inf, inf, inf, inf, 2.0]
    >>> vor.clipped().volumes.tolist()
    [0.5, 0.5, 0.5, 0.5, 2.0]
    """

    triangulation: SciPyMembers
    """What the diagram is the dual of."""
    points: np.ndarray
    """The sites as given, float64 (n, d)."""
    threads: int | None
    """The most threads, as given."""
    _options: str | None
    """The options of Qhull, as given."""

    _others: ClassVar[Names] = ("triangulation", "points", "threads", "_options")

    def __init__(
        self,
        points: PointsLike | Triangulation,
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: str | None = None,
        *,
        threads: int | None = None,
    ) -> None:
        check_scipy_options(furthest_site, incremental, qhull_options, "Voronoi")
        if threads is not None and not is_count(threads, 1):
            msg = f"threads must be an integer of at least 1, or None, got {threads!r}"
            raise ValueError(msg)
        if isinstance(points, Triangulation):
            tri = _check_triangulation(points)
        else:
            from ..delaunay import Delaunay

            tri = Delaunay(points, threads=threads)
        self._keep(triangulation=tri, points=tri.points, _options=qhull_options, threads=threads)

    @property
    def ndim(self) -> int:
        """The dimension: 2 in the plane, 3 in space.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.ndim
        2
        """
        return self.triangulation.ndim

    @property
    def npoints(self) -> int:
        """The number of sites, n.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.npoints
        5
        """
        return len(self.points)

    @property
    def min_bound(self) -> np.ndarray:
        """The least coordinates of the sites, float64 (d,).

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.min_bound.tolist(), vor.max_bound.tolist()
        ([0.0, 0.0], [2.0, 2.0])
        """
        return self.triangulation.min_bound

    @property
    def max_bound(self) -> np.ndarray:
        """The greatest coordinates of the sites, float64 (d,).

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.max_bound.tolist()
        [2.0, 2.0]
        """
        return self.triangulation.max_bound

    @property
    def furthest_site(self) -> bool:
        """Whether this is a diagram of furthest sites: False.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.furthest_site
        False
        """
        return False

    @cached_property
    def _merged(self) -> tuple[np.ndarray, np.ndarray]:
        """The vertex of each simplex, and the first simplex of each vertex."""
        from .merging import vertices_of_simplices

        tri = self.triangulation
        vertex, first = vertices_of_simplices(tri.points, tri.simplices, tri.neighbors, self.threads)
        return frozen(vertex), frozen(first)

    @property
    def vertex_of_simplex(self) -> np.ndarray:
        """The row in `vertices` of the circumcenter of each simplex of the triangulation, int32 (m,).

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2]])
        >>> vor.vertex_of_simplex.tolist(), vor.vertices.tolist()
        ([0, 0], [[1.0, 1.0]])
        """
        return self._merged[0]

    @cached_property
    def vertices(self) -> np.ndarray:
        """Voronoi vertices, float64 (k, d): circumcenters of simplices, one for all with the same sphere.

        Infinite where they are beyond what float64 holds.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> sorted(vor.vertices.tolist())
        [[0.0, 1.0], [1.0, 0.0], [1.0, 2.0], [2.0, 1.0]]
        """
        first, centers = self._merged[1], self.triangulation.circumcenters
        if np.isnan(centers).any():
            damaged("a simplex is flat")
        return centers if len(first) == len(centers) else frozen(centers[first])

    @cached_property
    def _ridges(self) -> Ridges:
        from .ridges import Ridges, ridges_in_plane

        tri = self.triangulation
        if self.ndim == 2:
            ridges = ridges_in_plane(tri.simplices, tri.neighbors, self.vertex_of_simplex)
        else:
            from .rings import ridges_in_space

            ridges = ridges_in_space(
                tri.points, tri.simplices, tri.neighbors, self.vertex_of_simplex, self.threads
            )
        return Ridges(frozen(ridges.sites), frozen(ridges.indptr), frozen(ridges.indices))

    @property
    def ridge_points(self) -> np.ndarray:
        """The two sites between which each ridge lies, int32 (r, 2).

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.ridge_points.tolist()
        [[2, 0], [2, 4], [3, 2], [4, 0], [0, 1], [3, 4], [4, 1], [1, 3]]
        """
        return self._ridges.sites

    @property
    def ridge_indptr(self) -> np.ndarray:
        """Where the vertices of each ridge begin in `ridge_indices`, and their number, int64 (r + 1,).

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.ridge_indptr.tolist()
        [0, 2, 4, 6, 8, 10, 12, 14, 16]
        """
        return self._ridges.indptr

    @property
    def ridge_indices(self) -> np.ndarray:
        """Rows of `vertices`, ridge after ridge, int32: the arrays of what `ridge_vertices` has as lists.

        In space those of a ridge go around it, by the right hand about the way from its first site to its
        second one; in the plane the second vertex is to the left of that way. -1 stands for infinity, and is
        the first.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.ridge_indices[vor.ridge_indptr[3]:vor.ridge_indptr[4]].tolist() == vor.ridge_vertices[3]
        True
        """
        return self._ridges.indices

    @cached_property
    def ridge_vertices(self) -> list[list[int]]:
        """Rows of `vertices` for each ridge, r lists, in the order of `ridge_indices`.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> len(vor.ridge_vertices), vor.ridge_vertices[0]
        (8, [-1, 0])
        """
        from .regions import as_lists

        return as_lists(self.ridge_indptr, self.ridge_indices)

    @cached_property
    def ridge_dict(self) -> dict[tuple[int, int], list[int]]:
        """For the two sites of a ridge, as in `ridge_points`, its list of `ridge_vertices`.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> a, b = vor.ridge_points[0].tolist()
        >>> vor.ridge_dict[a, b] == vor.ridge_vertices[0]
        True
        """
        return dict(zip(map(tuple, self.ridge_points.tolist()), self.ridge_vertices, strict=True))

    @cached_property
    def _regions(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The region of each site, and indptr and indices of all."""
        from .regions import regions_of_sites

        tri = self.triangulation
        indptr, indices = regions_of_sites(
            tri.simplices, tri.neighbors, self.vertex_of_simplex, len(tri.points)
        )
        unused, used = tri.duplicates.T
        own = np.ones(len(tri.points), bool)
        own[unused] = False
        with_empty = self._options is None or "Qz" in self._options.split()
        region = np.cumsum(own) - (0 if with_empty else 1)
        region[unused] = region[used]
        indptr = np.concatenate([np.zeros(2 if with_empty else 1, np.int64), indptr[1:][own]])
        return frozen(region), frozen(indptr), frozen(indices)

    @property
    def point_region(self) -> np.ndarray:
        """The row in `regions` of each site, int64 (n,); for a duplicate that of the site that was used.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.point_region.tolist()
        [1, 2, 3, 4, 5]
        """
        return self._regions[0]

    @property
    def region_indptr(self) -> np.ndarray:
        """Where the vertices of each region begin in `region_indices`, and their number, int64.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.region_indptr.tolist()
        [0, 0, 3, 6, 9, 12, 16]
        """
        return self._regions[1]

    @property
    def region_indices(self) -> np.ndarray:
        """Rows of `vertices`, region after region, int32: the arrays of what `regions` has as lists.

        In the plane those of a region are counter-clockwise around it, in space ascending. -1 stands for
        infinity, and is the first.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> k = vor.point_region[4]
        >>> vor.region_indices[vor.region_indptr[k]:vor.region_indptr[k + 1]].tolist() == vor.regions[k]
        True
        """
        return self._regions[2]

    @cached_property
    def regions(self) -> list[list[int]]:
        """Rows of `vertices` for each region, lists in the order of `region_indices`.

        The first is empty and of no site, as in SciPy, where Qhull adds a point at infinity.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.regions
        [[], [-1, 2, 0], [-1, 3, 2], [-1, 0, 1], [-1, 1, 3], [0, 2, 3, 1]]
        """
        from .regions import as_lists

        return as_lists(self.region_indptr, self.region_indices)

    @cached_property
    def areas(self) -> np.ndarray:
        """The area of each ridge, float64 (r,), in the plane its length; infinite if it is unbounded.

        Examples
        --------
        >>> import dt3d
        >>> sorted(dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]]).areas.round(3).tolist())
        [1.414, 1.414, 1.414, 1.414, inf, inf, inf, inf]
        """
        from .measures import areas_of_ridges

        return frozen(areas_of_ridges(self.vertices, self._ridges, self.threads))

    @cached_property
    def volumes(self) -> np.ndarray:
        """The volume of each site's region, float64 (n,), in the plane its area.

        Infinite if the region is unbounded; 0 for duplicates, whose region is counted with the site that was
        used. Computed from `vertices`: what is small beside the coordinates has their rounding. `clipped`
        computes beside each site.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.volumes.round(12).tolist()
        [inf, inf, inf, inf, 2.0]
        """
        from .measures import volumes_of_cells

        return frozen(volumes_of_cells(self.points, self._ridges, self.areas))

    def clipped(self, box: npt.ArrayLike | None = None) -> Clipped:
        """What of each region lies in a box: volumes, areas of ridges, and polytopes.

        Some 25 microseconds per site in space; of a site with thousands of ridges the square of their number
        counts.

        Parameters
        ----------
        box : array_like (2, d), optional
            Its low and its high corner; by default those of the sites, `min_bound` and `max_bound`.

        Raises
        ------
        ValueError
            If the box is not finite, real and of shape (2, d), or has no volume.

        Examples
        --------
        >>> import numpy as np, dt3d
        >>> vor = dt3d.Voronoi(np.random.default_rng(0).random((1000, 3)))
        >>> inside = vor.clipped([[0, 0, 0], [1, 1, 1]])
        >>> bool(abs(inside.volumes.sum() - 1) < 1e-12)
        True
        """
        from .clipped import Clipped

        return Clipped(self, box)

    def add_points(self, points: npt.ArrayLike, restart: bool = False) -> NoReturn:
        """As SciPy's class without ``incremental=True``: sites cannot be added.

        Raises
        ------
        RuntimeError
            Always.

        Examples
        --------
        >>> import dt3d
        >>> import numpy as np
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> dt3d.Voronoi(np.concatenate([vor.points, [[0.5, 1]]]))
        <dt3d.Voronoi: 6 sites in the plane>
        """
        msg = (
            "sites cannot be added to a finished diagram; make a new one of all sites, as of "
            "np.concatenate([vor.points, points])"
        )
        raise RuntimeError(msg)

    def close(self) -> None:
        """As SciPy's class, where it ends an incremental diagram; nothing is open here.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.close()
        >>> vor.npoints
        5
        """

    def __reduce__(self) -> tuple[Callable[..., Voronoi], tuple[object, ...], dict[str, object]]:
        """Restored from the triangulation, which is checked, and so derived again."""
        own = {name: value for name, value in self.__dict__.items() if name not in self._made()}
        return _restored, (type(self), self.triangulation, self._options, self.threads), own

    def __setstate__(self, state: dict[str, object]) -> None:
        """Restore the attributes of the user's own."""
        self.__dict__.update({name: value for name, value in state.items() if name not in self._made()})

    def _made(self) -> set[str]:
        return {*self._derived, *self._others}

    def _refuse(self, name: str, what: str) -> None:
        if name in self._made():
            msg = (
                f"{name} cannot be {what}: results stay as they were computed; take a copy to change it, or "
                "make a diagram of other sites"
            )
            raise AttributeError(msg)

    def __repr__(self) -> str:
        """How many sites in which dimension."""
        return f"<dt3d.Voronoi: {len(self.points)} sites in {'the plane' if self.ndim == 2 else 'space'}>"


def _check_triangulation(given: Triangulation) -> SciPyMembers:
    if not isinstance(given, SciPyMembers):
        msg = f"a Voronoi diagram is of a whole triangulation, got a part: {given!r}; pass part.whole"
        raise ValueError(msg)
    if not given._exact:
        msg = (
            'a Voronoi diagram needs an exact triangulation, this one was made with robustness="perturb"; '
            "pass its points"
        )
        raise ValueError(msg)
    return given


def _restored(cls: type[Voronoi], tri: SciPyMembers, options: str | None, threads: int | None) -> Voronoi:
    return cls(tri, qhull_options=options, threads=threads)
