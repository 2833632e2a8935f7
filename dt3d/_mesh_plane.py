"""Triangulations in the plane, written to files; `dt3d.reading.plane` reads them back.

Formats of space get z = 0 for every point.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ._cell_data import cell_data, varies
from ._mesh_data import carry
from ._mesh_writing import save_legacy, save_xml, write_ply, write_stl
from ._optional import optional
from ._output import save_figure
from ._paths import check_target, written_aside

if TYPE_CHECKING:
    import pyvista

    from ._triangulation import Triangulation


def write_plane_mesh(tri: Triangulation, path: str | Path) -> None:
    """Write a triangulation in the plane.

    =============== ==========================================================================================
    .npz            arrays points (n, 2), triangles, neighbors and thread
    .vtu .vtk .vtp  the triangles, with the cell data of `cell_data` (needs PyVista)
    .msh .mesh      the triangles for Gmsh and Medit (needs meshio)
    .ply .stl .obj  the triangles as a surface; .stl in single precision (.ply needs meshio)
    =============== ==========================================================================================

    Parameters
    ----------
    tri : threaded2d.Delaunay or Subset
        What is written.
    path : str or Path
        A file that exists is replaced, when the new one is whole.

    Raises
    ------
    OSError, ValueError, ImportError
        As `check_plane_path` says, if the file cannot be written, and if .stl cannot hold the coordinates.
    """
    path = check_plane_path(path)
    with written_aside(path) as aside:
        WRITERS[path.suffix.lower()](tri, aside)


def check_plane_path(path: str | Path) -> Path:
    """The path, if triangles can be written there; a ValueError or OSError if not."""
    return check_target(path, WRITERS, "write triangles to")


def draw_plane(tri: Triangulation, path: Path) -> None:
    """Draw the triangles, coloured by the threads that made them, by depth where one thread made all.

    `plot.FORMATS` has the extensions.
    """
    if not varies(tri.thread):
        from ._space_picture import draw_picture

        draw_picture(tri, path)
        return
    from .threaded2d.picture import plot

    figure = plot(tri).get_figure(root=True)
    assert figure is not None
    save_figure(figure, path, dpi=200)


def _raised(tri: Triangulation) -> np.ndarray:
    """The points with z = 0, float64 (n, 3)."""
    return np.column_stack([tri.points, np.zeros(len(tri.points))])


def _write_npz(tri: Triangulation, path: Path) -> None:
    with path.open("wb") as file:  # NumPy puts .npz behind a name that ends in .NPZ
        np.savez_compressed(
            file, points=tri.points, triangles=tri.triangles, neighbors=tri.neighbors, thread=tri.thread
        )


def _grid(tri: Triangulation) -> pyvista.UnstructuredGrid:
    pv = optional("pyvista")
    grid: pyvista.UnstructuredGrid = pv.UnstructuredGrid({pv.CellType.TRIANGLE: tri.triangles}, _raised(tri))
    carry(grid, cell_data(tri))
    return grid


def _write_vtu(tri: Triangulation, path: Path) -> None:
    grid = _grid(tri)  # says what to install where VTK is missing
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    save_xml(vtkXMLUnstructuredGridWriter(), grid, path)


def _write_vtp(tri: Triangulation, path: Path) -> None:
    surface = tri.to_pyvista()
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    save_xml(vtkXMLPolyDataWriter(), surface, path)


def _write_vtk(tri: Triangulation, path: Path) -> None:
    save_legacy(_grid(tri), path)


def _write_gmsh(tri: Triangulation, path: Path) -> None:
    meshio = optional("meshio")
    meshio.gmsh.write(path, meshio.Mesh(_raised(tri), {"triangle": tri.triangles}), "4.1")


def _write_medit(tri: Triangulation, path: Path) -> None:
    meshio = optional("meshio")
    meshio.medit.write(path, meshio.Mesh(_raised(tri), {"triangle": tri.triangles}))


def _write_obj(tri: Triangulation, path: Path) -> None:
    text = io.StringIO()
    text.write("# triangulation in the plane by dt3d\n")
    text.writelines(f"v {x!r} {y!r} 0\n" for x, y in tri.points.tolist())
    text.writelines(f"f {a} {b} {c}\n" for a, b, c in (tri.triangles + 1).tolist())
    path.write_text(text.getvalue(), encoding="ascii")


WRITERS: dict[str, Callable[[Triangulation, Path], None]] = {
    ".npz": _write_npz,
    ".vtu": _write_vtu,
    ".vtk": _write_vtk,
    ".vtp": _write_vtp,
    ".msh": _write_gmsh,
    ".mesh": _write_medit,
    ".ply": lambda tri, path: write_ply(_raised(tri), tri.triangles, path),
    ".stl": lambda tri, path: write_stl(_raised(tri), tri.triangles, path),
    ".obj": _write_obj,
}
