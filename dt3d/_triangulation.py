"""What all triangulations have in common: in the plane and in space, whole ones and parts of them.

Here d is the dimension, 2 or 3, n the number of sites and m that of simplices.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, NoReturn, Self, Unpack, cast

import numpy as np

from . import _topology
from ._results import Names, Result, check_array, check_complex, check_range, frozen

if TYPE_CHECKING:
    import meshio
    import pyvista
    from matplotlib.axes import Axes

    from ._living import Living
    from ._space_plot import SpaceLook

SHARED: Names = ("points", "simplices", "neighbors", "duplicates")
# further arrays of each dimension, with an entry per simplex and per site
PER_SIMPLEX: dict[int, dict[str, type]] = {2: {"thread": np.int16}, 3: {"iteration": np.int32}}
PER_SITE: dict[int, dict[str, type]] = {2: {"inserted_by": np.int16}, 3: {}}
# what only one dimension has, and the reason
ONLY_IN_PLANE = {
    "thread": "it is the thread that made a triangle; in space there is iteration",
    "inserted_by": "it is the thread that inserted a site",
    "triangles": "in space these are tetrahedra: simplices",
}
ONLY_IN_SPACE = {"iteration": "it is the round of an extrapolation; in the plane there is thread"}


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
    iteration: np.ndarray
    """In space only: the iteration, from 1, that found each tetrahedron, int32 (m,)."""
    thread: np.ndarray
    """In the plane only: the thread that made each triangle, int16 (m,)."""
    inserted_by: np.ndarray
    """In the plane only: the thread that inserted each site, -1 for duplicates, int16 (n,)."""

    _arrays: ClassVar[Names] = SHARED

    @classmethod
    def _arrays_of(cls, state: dict[str, object]) -> Names:
        d = _dimension(state)
        return (*SHARED, *PER_SIMPLEX.get(d, ()), *PER_SITE.get(d, ()))

    @property
    def ndim(self) -> int:
        """The dimension: 2 in the plane, 3 in space.

        Examples
        --------
        >>> import dt3d
        >>> dt3d.Delaunay([[0, 0], [2, 0], [0, 2]]).ndim
        2
        """
        return int(self.points.shape[1])

    @property
    def triangles(self) -> np.ndarray:
        """In the plane only, the same as `simplices`: counter-clockwise, int32 (m, 3).

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2]])
        >>> tri.triangles is tri.simplices
        True
        """
        if self.ndim != 2:
            self._only_elsewhere("triangles")
        return self.simplices

    def to_pyvista(
        self, source: pyvista.DataSet | None = None
    ) -> pyvista.UnstructuredGrid | pyvista.PolyData:
        """The simplices as a PyVista mesh: point i is site i, cell j is simplex j.

        ================ =====================================================================================
        cell data        what it is
        ================ =====================================================================================
        "volume"         of each tetrahedron; in the plane "area", of each triangle; float64
        "longest_edge"   its length, float64
        "circumradius"   the radius of the circumscribed sphere, in the plane circle; float64
        "depth"          how many facets lie between the simplex and the hull, 0 for those at it; of a part of
                         a triangulation, its boundary; int32
        "iteration"      in space: the iteration that found it, int32; not where all are 1, as by insertion
        "thread"         in the plane: the thread that made it, int16; not where there was one
        ================ =====================================================================================

        In the plane, point data "inserted_by" are threads, too. Active is what varies and is seen on the
        hull, "longest_edge" in general; or the active point data of the source, if they vary.

        Parameters
        ----------
        source : pyvista.DataSet, optional
            The dataset whose points were triangulated. The mesh gets its point data, in the plane also the
            third coordinates: a terrain.

        Returns
        -------
        pyvista.UnstructuredGrid
            In space: tetrahedra.
        pyvista.PolyData
            In the plane: triangles.

        Raises
        ------
        ImportError
            If PyVista is not installed; the message says how to install it.
        ValueError
            If the source is no dataset of PyVista, or has another number of points.

        Examples
        --------
        >>> import numpy as np, pyvista as pv, dt3d
        >>> cloud = pv.PolyData(np.random.default_rng(0).random((50, 3)))
        >>> cloud["height"] = cloud.points[:, 2]
        >>> grid = dt3d.Delaunay(cloud).to_pyvista(cloud)
        >>> grid.point_data.keys(), grid.cell_data.keys()
        (['height'], ['volume', 'longest_edge', 'circumradius', 'depth'])
        """
        if self.ndim == 2:
            from .threaded2d.picture import to_pyvista as surface

            return surface(self, source=source)
        from ._mesh import to_pyvista

        return to_pyvista(self, source)

    def hull_to_pyvista(self, source: pyvista.DataSet | None = None) -> pyvista.PolyData:
        """The surface of the convex hull, of its own points; of a part of a triangulation, of the part.

        Triangles are counter-clockwise from outside. In the plane it is lines, with the triangles on their
        left. Point data "site" (int32) has the numbers of the points.

        Parameters
        ----------
        source : pyvista.DataSet, optional
            As in `to_pyvista`: the surface gets the point data of its sites.

        Raises
        ------
        ImportError
            If PyVista is not installed; the message says how to install it.
        ValueError
            If the source is no dataset of PyVista, or has another number of points.

        Examples
        --------
        >>> import dt3d
        >>> cube = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        >>> hull = dt3d.Delaunay(cube + [[0.5, 0.5, 0.5]]).hull_to_pyvista()
        >>> hull.n_points, hull.n_cells, float(round(hull.volume, 12))
        (8, 12, 1.0)
        """
        from ._mesh import hull_to_pyvista

        return hull_to_pyvista(self, source)

    def to_meshio(self) -> meshio.Mesh:
        """The simplices as a mesh of meshio, with the cell data of `to_pyvista`; in the plane z is 0.

        `meshio.Mesh.write` writes formats that `dt3d.files.write_mesh` does not have, as XDMF and Abaqus.

        Raises
        ------
        ImportError
            If meshio is not installed; the message says how to install it.

        Examples
        --------
        >>> import dt3d
        >>> mesh = dt3d.Delaunay([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]).to_meshio()
        >>> mesh.cells_dict["tetra"].shape, sorted(mesh.cell_data)
        ((1, 4), ['circumradius', 'depth', 'longest_edge', 'volume'])
        """
        from ._mesh import to_meshio

        return to_meshio(self)

    def plot(
        self,
        ax: Axes | None = None,
        *,
        colormap: str | None = None,
        edges: bool | None = None,
        **options: Unpack[SpaceLook],
    ) -> Axes | pyvista.Plotter:
        """Draw the triangulation: in the plane on axes of matplotlib, in space on a plotter of PyVista.

        In the plane the triangles are coloured by the threads that made them. In space tetrahedra are
        coloured by their depth, shrunk, and those before the middle are left out, so that the inside is seen;
        ``tri.plot().show()`` opens a window, or shows the scene in a notebook.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            In the plane; those of a new figure if left out.
        colormap : str, optional
            A name of matplotlib's; by default "tab10", in space "viridis".
        edges : bool, optional
            Whether to draw edges; by default up to 20,000 simplices.
        scalars : str
            This and what follows in space. The data that colours show, "depth" by default: one of the cell
            data of `to_pyvista`, or of the point data of the source.
        source : pyvista.DataSet, optional
            As in `to_pyvista`.
        longest : float, optional
            Leave out tetrahedra with an edge longer than this: what stays of a molecule is its body.
        shrink : float
            Size of each tetrahedron about its middle, 0.8 by default; with 1 there are no gaps.
        cut : bool
            Whether to leave out what lies before the middle, True by default.
        screenshot : str or Path, optional
            A picture to write: .png, .jpg, .jpeg, .bmp, .tif or .tiff.
        off_screen : bool, optional
            Whether to do without a window; by default where there is a screenshot, else as PyVista is set.
        window_size : (int, int), optional
            Width and height in pixels.

        Returns
        -------
        matplotlib.axes.Axes or pyvista.Plotter
            With the picture on it; further meshes can be added before it is shown.

        Raises
        ------
        ValueError
            For options that are out of range or of the other dimension, and if no tetrahedra are left.
        TypeError
            For an option that there is not.
        OSError
            If the screenshot cannot be written.
        ImportError
            If matplotlib or PyVista is not installed; the message says how to install it.

        Examples
        --------
        >>> import dt3d
        >>> ax = dt3d.Delaunay([[0, 0], [1, 0], [0, 1], [1, 1]]).plot()
        >>> len(ax.collections[0].get_paths())
        2
        """
        self._check_plot(ax, options)
        if self.ndim == 2:
            from .threaded2d.picture import plot

            return plot(self, ax, colormap=colormap or "tab10", edges=edges)
        from ._space_plot import Look
        from ._space_plot import plot as plot_in_space

        return plot_in_space(self, Look(edges=edges, colormap=colormap, **options))

    def _repr_html_(self) -> str:
        """What notebooks show: a table, and a small drawing of up to some thousand triangles."""
        from ._notebook import to_html

        return to_html(self)

    def _check_plot(self, ax: Axes | None, options: SpaceLook) -> None:
        from ._options import check_names
        from ._space_plot import SpaceLook

        check_names(options, SpaceLook.__annotations__, "plot()")
        if self.ndim == 2 and options:
            name = next(iter(options))
            msg = f"{name} goes with triangulations in space, and this one is in the plane; leave it out"
            raise ValueError(msg)
        if self.ndim == 3 and ax is not None:
            msg = (
                "ax goes with triangulations in the plane; in space plot() returns a plotter of PyVista. "
                "dt3d.plot.paint(tri, ax) paints tetrahedra on axes of matplotlib"
            )
            raise ValueError(msg)

    if not TYPE_CHECKING:  # to mypy there would be every attribute

        def __getattr__(self, name: str) -> object:
            """Results that are not made yet; of an attribute of the other dimension why it is not there."""
            if "_living" in self.__dict__ and name in (*self._arrays_of(self.__dict__), "stats"):
                with self._living.lock:  # so that it is still there
                    self._finish()
                    return self.__dict__[name]
            return self._only_elsewhere(name)

    def __getstate__(self) -> dict[str, object]:
        """What a pickle has: the results as they are now; no sites can be added to what it becomes."""
        self._finish()
        state = super().__getstate__()
        state.pop("_living", None)
        return state

    def __copy__(self) -> Self:
        """Share the arrays, which nobody changes; no sites can be added to the copy."""
        self._finish()
        copy = super().__copy__()
        copy.__dict__.pop("_living", None)
        return copy

    def _finish(self) -> None:
        """Make the results that sites added since have left open."""
        living = self.__dict__.get("_living")
        if living is not None:
            with living.lock:
                if "simplices" not in self.__dict__:
                    self._catch_up()

    def _catch_up(self) -> None:
        """Make the results of all sites so far, where sites can be added."""
        raise NotImplementedError

    def _only_elsewhere(self, name: str) -> NoReturn:
        d = _dimension(self.__dict__)
        msg = f"{type(self).__name__!r} object has no attribute {name!r}"
        if d == 3 and name in ONLY_IN_PLANE:
            msg = f"triangulations in space have no {name}: {ONLY_IN_PLANE[name]}"
        elif d == 2 and name in ONLY_IN_SPACE:
            msg = f"triangulations in the plane have no {name}: {ONLY_IN_SPACE[name]}"
        raise AttributeError(msg, name=name, obj=self)

    def __setstate__(self, state: dict[str, object]) -> None:
        """Restore a pickle; in those of version 0.1 the simplices of the plane are called triangles."""
        renamed = {"simplices" if name == "triangles" else name: value for name, value in state.items()}
        super().__setstate__(renamed)

    def _border(self) -> np.ndarray:
        return frozen(_topology.hull_facets(self.simplices, self.neighbors))

    def _check(self, own: dict[str, np.ndarray]) -> None:
        d = _dimension(dict(own))
        n, m = len(own["points"]), len(own["simplices"])
        check_complex(own["points"], own["simplices"], own["neighbors"], dimension=d)
        for names, length in ((PER_SIMPLEX[d], m), (PER_SITE[d], n)):
            for name, dtype in names.items():
                check_array(name, own[name], dtype, (length,))
        check_array("duplicates", own["duplicates"], np.int32, (len(own["duplicates"]), 2))
        check_range("duplicates", own["duplicates"], 0, n)


def _dimension(state: dict[str, object]) -> int:
    """2 or 3, as many as the points have coordinates; without points by what only the plane has."""
    if "_living" in state:
        return int(cast("Living", state["_living"]).dimension)
    points = state.get("points")
    if isinstance(points, np.ndarray) and points.ndim == 2:
        return 2 if points.shape[1] == 2 else 3
    return 2 if "inserted_by" in state else 3
