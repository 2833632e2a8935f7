"""Triangles coloured by the threads that made them: for PyVista and for matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from .._cell_data import cell_data, varies
from .._mesh_data import carry, check_source, heights_of
from .._optional import optional
from .._output import new_figure

if TYPE_CHECKING:
    import pyvista
    from matplotlib.axes import Axes

    from .._triangulation import Triangulation


def to_pyvista(
    tri: Triangulation, heights: npt.ArrayLike | None = None, source: pyvista.DataSet | None = None
) -> pyvista.PolyData:
    """The triangles as a surface, with the cell data that `cell_data` has.

    Where several threads inserted, point data "inserted_by" says which one inserted each site.

    Parameters
    ----------
    tri : threaded2d.Delaunay or Subset
        What is shown.
    heights : float (n,), optional
        The third coordinate of each point. If left out it is the source's, and 0 without one.
    source : pyvista.DataSet, optional
        The dataset whose points were triangulated: the surface gets its point data.

    Raises
    ------
    ImportError
        If PyVista is not installed.
    ValueError
        If the source is no dataset, or has another number of points.
    """
    pv = optional("pyvista")
    check_source(source, len(tri.points))
    z = heights_of(source, len(tri.points)) if heights is None else np.asarray(heights, np.float64)
    mesh: pyvista.PolyData = pv.PolyData.from_regular_faces(np.column_stack([tri.points, z]), tri.triangles)
    used = tri.inserted_by >= 0
    if varies(tri.inserted_by[used]):
        # a copy, since VTK writes where an array is read-only, too
        mesh.point_data["inserted_by"] = tri.inserted_by.copy()
    carry(mesh, cell_data(tri), source)
    return mesh


def plot(
    tri: Triangulation, ax: Axes | None = None, *, colormap: str = "tab10", edges: bool | None = None
) -> Axes:
    """Draw the triangles, coloured by the threads that made them, as `Delaunay.plot` does."""
    if ax is None:
        ax = new_figure(6, 6).add_subplot()
    colormaps = optional("matplotlib").colormaps
    collections = optional("matplotlib.collections")
    drawn = len(tri.triangles) <= 20_000 if edges is None else edges
    colours = colormaps[colormap](tri.thread % 10)
    line = {"edgecolors": "white", "linewidths": 0.2} if drawn else {"edgecolors": colours, "linewidths": 0.1}
    ax.add_collection(collections.PolyCollection(tri.points[tri.triangles], facecolors=colours, **line))
    ax.autoscale_view()
    ax.set_aspect("equal")
    return ax
