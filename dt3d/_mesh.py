"""A triangulation as meshes of PyVista and meshio: the tetrahedra, and the surface of the hull."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol, cast

import numpy as np

from ._cell_data import cell_data
from ._mesh_data import carry, check_source, heights_of
from ._optional import optional
from .subset import Subset

if TYPE_CHECKING:
    import meshio
    import pyvista

    from ._triangulation import Triangulation
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


def to_pyvista(tri: Tetrahedra, source: pyvista.DataSet | None = None) -> pyvista.UnstructuredGrid:
    """The tetrahedra of a triangulation, with the cell data that `cell_data` has.

    Points keep their numbers: point i of the grid is ``tri.points[i]``, cell j is ``tri.simplices[j]``.

    Parameters
    ----------
    tri : Delaunay, Subset or Mesh
        What is shown.
    source : pyvista.DataSet, optional
        The dataset whose points were triangulated: the grid gets its point data.

    Raises
    ------
    ImportError
        If PyVista is not installed.
    ValueError
        If the source is no dataset, or has another number of points.
    """
    pv = optional("pyvista")
    check_source(source, len(tri.points))
    # copies, since VTK writes where an array is read-only, too
    grid: pyvista.UnstructuredGrid = pv.UnstructuredGrid(
        {pv.CellType.TETRA: tri.simplices}, np.array(tri.points, np.float64)
    )
    carry(grid, cell_data(tri), source)
    return grid


def sizes(tri: Tetrahedra) -> np.ndarray:
    """The volume of each tetrahedron, float64 (m,)."""
    from .geometry.measures import measures

    return measures(
        np.ascontiguousarray(tri.points, np.float64), np.ascontiguousarray(tri.simplices, np.int32)
    )


def surface(tri: Triangulation) -> np.ndarray:
    """The facets of the hull, int (h, d); of a part of a triangulation, those of its boundary."""
    return tri.boundary if isinstance(tri, Subset) else cast("Delaunay", tri).convex_hull


def hull_to_pyvista(tri: Triangulation, source: pyvista.DataSet | None = None) -> pyvista.PolyData:
    """The convex hull as a closed surface of its own points, oriented as ``tri.convex_hull``.

    Of a subset, its boundary. In the plane lines, which have the triangles on their left. Point data "site"
    (int32) has the number of each point.

    Raises
    ------
    ImportError
        If PyVista is not installed.
    ValueError
        As `to_pyvista` says of the source.
    """
    pv = optional("pyvista")
    check_source(source, len(tri.points))
    facets = surface(tri)
    points, faces, sites = own_points(tri.points, facets)
    if tri.points.shape[1] == 3:
        polygons: pyvista.PolyData = pv.PolyData.from_regular_faces(points, faces)
    else:
        lines = np.column_stack([np.full(len(faces), 2), faces])
        polygons = pv.PolyData(
            np.column_stack([points, heights_of(source, len(tri.points))[sites]]), lines=lines
        )
    polygons.point_data["site"] = sites
    carry(polygons, {}, source, sites)
    return polygons


def to_meshio(tri: Triangulation) -> meshio.Mesh:
    """The simplices as a mesh of meshio, with the cell data that `cell_data` has; in the plane z is 0.

    Raises
    ------
    ImportError
        If meshio is not installed.
    """
    library = optional("meshio")
    in_space = tri.points.shape[1] == 3
    points = np.array(tri.points) if in_space else np.column_stack([tri.points, np.zeros(len(tri.points))])
    cells = [("tetra" if in_space else "triangle", np.array(tri.simplices))]
    data = {name: [values] for name, values in cell_data(tri).items()}
    mesh: meshio.Mesh = library.Mesh(points, cells, cell_data=data)
    return mesh


def own_points(points: np.ndarray, facets: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The points that facets (h, d) have, float64 (k, d), the facets as rows of these, and their numbers.

    The rows are int32 (h, d), the numbers int32 (k,).
    """
    corners, faces = np.unique(facets, return_inverse=True)
    faces = faces.reshape(facets.shape).astype(np.int32)
    return np.asarray(points, np.float64)[corners], faces, corners.astype(np.int32)
