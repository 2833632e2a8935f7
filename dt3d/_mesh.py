"""A triangulation as meshes of PyVista: the tetrahedra, and the surface of the hull."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from ._optional import optional
from .subset import Subset

if TYPE_CHECKING:
    import pyvista

    from .delaunay import Delaunay


class Tetrahedra(Protocol):
    """What is drawn and shown: a `Delaunay`, a `Subset`, or a `Mesh` from a file."""

    @property
    def points(self) -> np.ndarray:
        """Sites, float (n, 3)."""

    @property
    def simplices(self) -> np.ndarray:
        """Vertices of each tetrahedron, int (m, 4)."""

    @property
    def iteration(self) -> np.ndarray:
        """The iteration that found each tetrahedron, int (m,)."""


def to_pyvista(tri: Tetrahedra) -> pyvista.UnstructuredGrid:
    """The tetrahedra of a triangulation, with cell data "iteration" (int32) and "volume" (float64).

    Points keep their numbers: point i of the grid is ``tri.points[i]``, cell j is ``tri.simplices[j]``.

    Raises
    ------
    ImportError
        If PyVista is not installed.
    """
    pv = optional("pyvista")
    # copies, since VTK writes where an array is read-only, too
    grid: pyvista.UnstructuredGrid = pv.UnstructuredGrid(
        {pv.CellType.TETRA: tri.simplices}, np.array(tri.points, np.float64)
    )
    grid.cell_data["iteration"] = np.array(tri.iteration, np.int32)
    grid.cell_data["volume"] = sizes(tri)
    return grid


def sizes(tri: Tetrahedra) -> np.ndarray:
    """The volume of each tetrahedron, float64 (m,)."""
    from .geometry.measures import measures

    return measures(
        np.ascontiguousarray(tri.points, np.float64), np.ascontiguousarray(tri.simplices, np.int32)
    )


def surface(tri: Delaunay | Subset) -> np.ndarray:
    """The facets of the hull, int (h, 3); of a part of a triangulation, those of its boundary."""
    return tri.boundary if isinstance(tri, Subset) else tri.convex_hull


def hull_to_pyvista(tri: Delaunay | Subset) -> pyvista.PolyData:
    """The convex hull as a closed surface of its own points, oriented as ``tri.convex_hull``.

    Of a subset, its boundary.

    Raises
    ------
    ImportError
        If PyVista is not installed.
    """
    pv = optional("pyvista")
    points, faces = own_points(tri.points, surface(tri))
    polygons: pyvista.PolyData = pv.PolyData.from_regular_faces(points, faces)
    return polygons


def own_points(points: np.ndarray, facets: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The points that facets (h, 3) have, float64 (k, 3), and the facets as int32 rows of these."""
    corners, faces = np.unique(facets, return_inverse=True)
    return np.asarray(points, np.float64)[corners], faces.reshape(-1, 3).astype(np.int32)


def show(tri: Tetrahedra, title: str = "") -> None:
    """Open a window on the tetrahedra, with a plane to drag that cuts them open; returns when it is closed.

    Parameters
    ----------
    tri : Delaunay, Subset or Mesh
        What is shown.
    title : str
        Of the window.

    Raises
    ------
    ImportError
        If PyVista is not installed.
    """
    plotter = optional("pyvista").Plotter(title=title or "dt3d")
    plotter.add_mesh_clip_plane(
        to_pyvista(tri), scalars="iteration", cmap="RdYlBu_r", show_edges=True, crinkle=True
    )
    plotter.add_axes()
    plotter.show()
