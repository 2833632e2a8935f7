"""A triangulation as meshes of PyVista: the tetrahedra, and the surface of the hull."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._optional import optional

if TYPE_CHECKING:
    import pyvista


def volumes(points: np.ndarray, simplices: np.ndarray) -> np.ndarray:
    """Volume of every tetrahedron: det[b-a, c-a, d-a] / 6, positive for positive orientation.

    Parameters
    ----------
    points : float (n, 3)
    simplices : int (m, 4)

    Returns
    -------
    float64 (m,)
    """
    a, b, c, d = np.asarray(points, np.float64)[simplices].swapaxes(0, 1)
    return np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) / 6.0


def to_pyvista(tri: Any) -> pyvista.UnstructuredGrid:
    """The tetrahedra of a triangulation, with cell data "iteration" (int32) and "volume" (float64).

    Points keep their numbers: point i of the grid is ``tri.points[i]``, cell j is ``tri.simplices[j]``.

    Raises
    ------
    ImportError
        If PyVista is not installed.
    """
    pv = optional("pyvista")
    # copies, since VTK writes where an array is read-only, too
    grid = pv.UnstructuredGrid({pv.CellType.TETRA: tri.simplices}, np.array(tri.points, np.float64))
    grid.cell_data["iteration"] = np.array(tri.iteration, np.int32)
    grid.cell_data["volume"] = volumes(tri.points, tri.simplices)
    return grid


def surface(tri: Any) -> np.ndarray:
    """The facets of the hull, int (h, 3); of a part of a triangulation, those of its boundary."""
    return tri.boundary if hasattr(tri, "boundary") else tri.convex_hull


def hull_to_pyvista(tri: Any) -> pyvista.PolyData:
    """The convex hull as a closed surface of its own points, oriented as ``tri.convex_hull``.

    Of a subset, its boundary.

    Raises
    ------
    ImportError
        If PyVista is not installed.
    """
    pv = optional("pyvista")
    corners, faces = np.unique(surface(tri), return_inverse=True)
    points = np.asarray(tri.points, np.float64)[corners]
    return pv.PolyData.from_regular_faces(points, faces.reshape(-1, 3))


def show(tri: Any, title: str = "") -> None:
    """Open a window on the tetrahedra, with a plane to drag that cuts them open; returns when it is closed.

    Parameters
    ----------
    tri : Delaunay or Mesh
    title : str

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
