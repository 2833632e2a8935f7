"""What triangulations have in common: in the plane and in space, whole ones and parts of them.

Here d is the dimension, 2 or 3. A public class is one of `Whole` and `Part`, together with one of `InSpace`
and `InPlane`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Self, TypeVar, cast

import numpy as np
import numpy.typing as npt

from . import _topology
from ._input import check_queries
from ._results import Names, Result, check_array, check_complex, check_range, frozen
from ._topology import OUTSIDE

if TYPE_CHECKING:
    import pyvista
    from matplotlib.axes import Axes

    from ._proof import Verification
    from .location import Locator

SHARED: Names = ("points", "simplices", "neighbors", "duplicates")


class Triangulation(Result):
    """The base of all: sites, simplices, and which simplices are neighbours."""

    points: np.ndarray
    """The sites as given, float64 (n, d)."""
    simplices: np.ndarray
    """Vertices of each simplex, positively oriented, int32 (m, d + 1)."""
    neighbors: np.ndarray
    """The simplex opposite each vertex, `dt3d.OUTSIDE` (-1) where there is none, int32 (m, d + 1)."""
    duplicates: np.ndarray
    """A site that was not used, and the equal site that was, int32 (k, 2)."""

    _per_simplex: ClassVar[dict[str, type]] = {}
    """Names and dtypes of further arrays with an entry for each simplex."""
    _per_site: ClassVar[dict[str, type]] = {}
    """Names and dtypes of further arrays with an entry for each site."""

    def _border(self) -> np.ndarray:
        return frozen(_topology.hull_facets(self.simplices, self.neighbors))


class InSpace(Triangulation):
    """Tetrahedra."""

    iteration: np.ndarray
    """The iteration, from 1, that found each tetrahedron, int32 (m,)."""

    _per_simplex: ClassVar[dict[str, type]] = {"iteration": np.int32}
    _arrays: ClassVar[Names] = (*SHARED, "iteration")

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """The tetrahedra as a PyVista grid with cell data "iteration" and "volume".

        Raises
        ------
        ImportError
            If PyVista is not installed; the message says how to install it.
        """
        from ._mesh import to_pyvista

        return to_pyvista(self)


class InPlane(Triangulation):
    """Triangles."""

    thread: np.ndarray
    """The thread that made each triangle, int16 (m,)."""
    inserted_by: np.ndarray
    """The thread that inserted each site, -1 for duplicates, int16 (n,)."""

    _per_simplex: ClassVar[dict[str, type]] = {"thread": np.int16}
    _per_site: ClassVar[dict[str, type]] = {"inserted_by": np.int16}
    _arrays: ClassVar[Names] = (*SHARED, "thread", "inserted_by")

    @property
    def triangles(self) -> np.ndarray:
        """The same as `simplices`: counter-clockwise, int32 (m, 3)."""
        return self.simplices

    def to_pyvista(self) -> pyvista.PolyData:
        """The triangles as a PyVista surface with cell data "thread" and point data "inserted_by".

        Raises
        ------
        ImportError
            If PyVista is not installed; the message says how to install it.
        """
        from .threaded2d.picture import to_pyvista

        return to_pyvista(self)

    def plot(self, ax: Axes | None = None, *, colormap: str = "tab10", edges: bool | None = None) -> Axes:
        """Draw the triangles, coloured by the threads that made them.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Those of a new figure if left out.
        colormap : str
            A name of matplotlib's.
        edges : bool, optional
            Whether to draw edges; by default up to 20,000 triangles.

        Raises
        ------
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> from dt3d import threaded2d
        >>> ax = threaded2d.Delaunay([[0, 0], [1, 0], [0, 1], [1, 1]]).plot()
        >>> len(ax.collections[0].get_paths())
        2
        """
        from .threaded2d.picture import plot

        return plot(self, ax, colormap=colormap, edges=edges)

    def __setstate__(self, state: dict[str, object]) -> None:
        """Restore a pickle; in those of version 0.1 the simplices are called triangles."""
        renamed = {"simplices" if name == "triangles" else name: value for name, value in state.items()}
        super().__setstate__(renamed)


PartT = TypeVar("PartT", bound="Part")


class Whole(Triangulation, Generic[PartT]):
    """A triangulation of the convex hull."""

    _exact: bool = True
    """Whether all decisions are exact, so that the simplices fill the hull."""
    _dimension: ClassVar[int]
    _part: ClassVar[type[Part]]
    _derived: ClassVar[Names] = ("convex_hull", "vertex_neighbor_vertices", "_locator")

    @cached_property
    def convex_hull(self) -> np.ndarray:
        """Facets of the convex hull, int32 (h, d), oriented outwards.

        In space triangles, counter-clockwise from outside; in the plane edges, counter-clockwise about the
        triangles.

        Examples
        --------
        >>> import dt3d
        >>> dt3d.Delaunay([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]).convex_hull.shape
        (4, 3)
        >>> dt3d.threaded2d.Delaunay([[0, 0], [1, 0], [0, 1], [1, 1]]).convex_hull.shape
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
        >>> tri = dt3d.threaded2d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> indptr, indices = tri.vertex_neighbor_vertices
        >>> indices[indptr[0]:indptr[1]].tolist(), indices[indptr[1]:indptr[2]].tolist()
        ([1, 2], [0, 2, 3])
        """
        from ._vertices import neighbors_of_vertices

        # it indexes without a check
        check_range("simplices", self.simplices, 0, len(self.points))
        indptr, indices = neighbors_of_vertices(self.simplices, len(self.points))
        return frozen(indptr), frozen(indices)

    def find_simplex(self, xi: npt.ArrayLike) -> np.ndarray:
        """The simplex that contains each point, exactly; as `scipy.spatial.Delaunay.find_simplex`.

        Parameters
        ----------
        xi : array_like, real (..., d)
            The points.

        Returns
        -------
        int32 (...)
            Rows of `simplices`; `dt3d.OUTSIDE` (-1) for points outside the convex hull. Of several simplices
            that have a point on their common border, any one.

        Raises
        ------
        ValueError
            If the points are not finite, real and of shape (..., d).

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
        >>> tri.find_simplex([[0.2, 0.2, 0.2], [1, 1, 1]]).tolist()
        [0, -1]
        """
        return self._locator.find(xi)

    def subset(self, keep: npt.ArrayLike) -> PartT:
        """Some of the simplices, as an object of its own with `find_simplex`: holes, alpha shapes.

        Parameters
        ----------
        keep : bool (m,), or int (k,)
            A mask of the simplices, or rows of `simplices` without repetition.

        Raises
        ------
        ValueError
            If it is neither.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.threaded2d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> tri.subset([0])
        <1 of 2 simplices of <dt3d.threaded2d.Delaunay: 4 sites, 2 triangles>>
        """
        return cast(PartT, self._part(self, keep))

    @cached_property
    def _locator(self) -> Locator:
        from .location import Locator

        return Locator(self.points, self.simplices, self.neighbors, self._exact)

    def verify(self) -> Verification:
        """Check every invariant in exact arithmetic; print the outcome for the list.

        The outcome is false if one is broken. Unless ``robustness="perturb"`` was asked for, the result must
        also be the one triangulation that the symbolic perturbation defines.

        Examples
        --------
        >>> import dt3d
        >>> bool(dt3d.Delaunay([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]).verify())
        True
        """
        return self._proof()(
            self.points,
            self.simplices,
            neighbors=self.neighbors,
            duplicates=self.duplicates,
            perturbed=self._exact,
            oriented=True,
        )

    @staticmethod
    def _proof() -> Callable[..., Verification]:
        """The function `verify` of this dimension; it loads numba."""
        raise NotImplementedError

    def _check(self, own: dict[str, np.ndarray]) -> None:
        n, m = len(own["points"]), len(own["simplices"])
        check_complex(own["points"], own["simplices"], own["neighbors"], dimension=self._dimension)
        for names, length in ((self._per_simplex, m), (self._per_site, n)):
            for name, dtype in names.items():
                check_array(name, own[name], dtype, (length,))
        check_array("duplicates", own["duplicates"], np.int32, (len(own["duplicates"]), 2))
        check_range("duplicates", own["duplicates"], 0, n)


class Part(Triangulation):
    """Some of the simplices of a triangulation, neither convex nor connected in general."""

    whole: Whole[Any]  # of either dimension
    """The triangulation whose part this is."""
    kept: np.ndarray
    """The row in the whole's simplices of each of these, int32 (k,)."""

    _others: ClassVar[Names] = ("whole", "kept")
    _derived: ClassVar[Names] = ("boundary", "_number")

    def __init__(self, whole: Whole[Any], keep: npt.ArrayLike) -> None:  # of either dimension
        kept = check_keep(keep, len(whole.simplices))
        self._keep(whole=whole, kept=kept)
        self._keep(
            points=whole.points,
            simplices=whole.simplices[kept],
            # OUTSIDE leads to the last entry
            neighbors=self._number[whole.neighbors[kept]],
            duplicates=whole.duplicates,
            **{name: getattr(whole, name)[kept] for name in self._per_simplex},
            **{name: getattr(whole, name) for name in self._per_site},
        )

    @cached_property
    def _number(self) -> np.ndarray:
        """The row here of each simplex of the whole, and of OUTSIDE at the end: int32 (m + 1,)."""
        number = np.full(len(self.whole.simplices) + 1, OUTSIDE, np.int32)
        number[self.kept] = np.arange(len(self.kept), dtype=np.int32)
        return frozen(number)

    @cached_property
    def boundary(self) -> np.ndarray:
        """Facets with no neighbour, int32 (b, d), oriented outwards as `dt3d.Delaunay.convex_hull`.

        Those of the hull, and those towards what was not kept.

        Examples
        --------
        >>> import dt3d
        >>> dt3d.threaded2d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]]).subset([0]).boundary.shape
        (3, 2)
        """
        return self._border()

    def find_simplex(self, xi: npt.ArrayLike) -> np.ndarray:
        """The simplex of this part that contains each point, exactly, as `dt3d.Delaunay.find_simplex`.

        `dt3d.OUTSIDE` (-1) where there is none: outside the hull, and in holes. Borders belong to the part.

        Parameters
        ----------
        xi : array_like, real (..., d)
            The points.

        Raises
        ------
        ValueError
            If the points are not finite, real and of shape (..., d).

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.threaded2d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> part = tri.subset(tri.find_simplex([[0.5, 0.5]]))
        >>> part.find_simplex([[0.5, 0.5], [1, 1], [2, 2]]).tolist()
        [0, 0, -1]
        """
        points, shape = check_queries(xi, self.points.shape[1])
        locator = self.whole._locator
        found = locator.find_checked(points)
        found[found < 0] = OUTSIDE
        out: np.ndarray = self._number[found]
        # what contains these is not kept; if they lie on its border, something beside it may be
        rest = np.flatnonzero((out == OUTSIDE) & (found != OUTSIDE))
        if len(rest):
            beside = locator.find_kept(points[rest], found[rest], self._number[:-1] != OUTSIDE)
            out[rest] = self._number[beside]
        return out.reshape(shape)

    def subset(self, keep: npt.ArrayLike) -> Self:
        """A part of this part.

        Parameters
        ----------
        keep : bool (k,), or int (l,)
            A mask of the simplices of this part, or their rows. `kept` of the result has rows of the whole.
        """
        return type(self)(self.whole, self.kept[check_keep(keep, len(self.kept))])

    def __reduce__(self) -> tuple[Callable[..., Part], tuple[object, ...]]:
        """Restored from the whole, and so checked again."""
        return type(self), (self.whole, self.kept)

    def __repr__(self) -> str:
        """How many simplices of which triangulation."""
        return f"<{len(self.simplices)} of {len(self.whole.simplices)} simplices of {self.whole!r}>"


def check_keep(keep: npt.ArrayLike, m: int) -> np.ndarray:
    """The rows that a mask, bool (m,), or rows, integers (k,) without repetition, choose of m: int32 (k,).

    Raises
    ------
    ValueError
        If it is neither.
    """
    given = np.asarray(keep)
    if given.dtype == bool:
        if given.shape != (m,):
            msg = f"keep must be a mask of shape ({m},), one value for each simplex, got shape {given.shape}"
            raise ValueError(msg)
        return np.flatnonzero(given).astype(np.int32)
    if given.ndim != 1 or (given.size and given.dtype.kind not in "iu"):
        msg = (
            f"keep must be a mask, bool of shape ({m},), or rows of simplices, integers of shape (k,); got "
            f"dtype {given.dtype}, shape {given.shape}"
        )
        raise ValueError(msg)
    if given.size and (given.min() < 0 or given.max() >= m):
        bad = int(given[(given < 0) | (given >= m)][0])
        msg = f"keep names simplex {bad}, but there are simplices 0 to {m - 1}"
        raise ValueError(msg)
    rows = given.astype(np.int32)
    if len(np.unique(rows)) < len(rows):
        twice = int(np.argmax(np.bincount(rows)))
        msg = f"keep names simplex {twice} more than once; pass np.unique(keep)"
        raise ValueError(msg)
    return rows
