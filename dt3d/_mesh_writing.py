"""Writing triangulations. Every file is written aside and takes its name when it is whole.

VTK does not write to the disk itself: where that is full its writers end the process (XML), say nothing (PLY)
or print on the terminal. They write into memory, and Python writes that to the disk.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ._mesh import own_points, sizes, surface, to_pyvista
from ._optional import optional
from ._paths import check_target, written_aside

if TYPE_CHECKING:
    import pyvista
    from vtkmodules.vtkIOLegacy import vtkUnstructuredGridWriter
    from vtkmodules.vtkIOXML import vtkXMLWriter

    from .delaunay import Delaunay
    from .subset import Subset


def write_mesh(tri: Delaunay | Subset, path: str | Path) -> None:
    """Write a triangulation.

    ============ =============================================================================================
    .vtu .vtk    the tetrahedra, with the cell data of ``to_pyvista`` (needs PyVista)
    .npz         arrays points, simplices, neighbors, iteration and volume
    .msh .mesh   the tetrahedra for Gmsh and Medit; Medit's reference is the iteration (needs meshio)
    .ply .stl    the surface of the convex hull; .stl in single precision (.ply needs meshio)
    ============ =============================================================================================

    Parameters
    ----------
    tri : Delaunay or Subset
        What is written.
    path : str or Path
        A file that exists is replaced, when the new one is whole; until then, and if it cannot be
        written, it is as it was.

    Raises
    ------
    OSError, ValueError, ImportError
        As `check_mesh_path` says, if the file cannot be written, and if .stl cannot hold the coordinates.
    """
    path = check_mesh_path(path)
    with written_aside(path) as aside:
        WRITERS[path.suffix.lower()](tri, aside)


def check_mesh_path(path: str | Path) -> Path:
    """The path, if a mesh can be written there; to be asked before a long computation.

    Raises
    ------
    ValueError
        For an extension that `write_mesh` does not know.
    OSError
        If the folder does not exist or may not be written, or the file may not be replaced.
    """
    return check_target(path, WRITERS, "write a mesh to")


def _write_npz(tri: Delaunay | Subset, path: Path) -> None:
    arrays = {name: getattr(tri, name) for name in ("points", "simplices", "neighbors", "iteration")}
    with path.open("wb") as file:  # NumPy puts .npz behind a name that ends in .NPZ
        np.savez_compressed(file, volume=sizes(tri), **arrays)


def _write_vtu(tri: Delaunay | Subset, path: Path) -> None:
    grid = to_pyvista(tri)  # says what to install where VTK is missing
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    save_xml(vtkXMLUnstructuredGridWriter(), grid, path)


def _write_vtk(tri: Delaunay | Subset, path: Path) -> None:
    save_legacy(to_pyvista(tri), path)


def save_xml(writer: vtkXMLWriter, mesh: pyvista.DataSet, path: Path) -> None:
    """A mesh of PyVista by one of VTK's writers of XML."""
    writer.SetDataModeToBinary()
    writer.SetCompressorTypeToZLib()
    _to_memory(writer, mesh)
    path.write_bytes(writer.GetOutputString().encode())


def save_legacy(grid: pyvista.UnstructuredGrid, path: Path) -> None:
    """An unstructured grid of PyVista in VTK's legacy format."""
    from vtkmodules.vtkIOLegacy import vtkUnstructuredGridWriter

    writer = vtkUnstructuredGridWriter()
    writer.SetFileTypeToBinary()
    _to_memory(writer, grid)
    path.write_bytes(writer.GetOutputStdString())  # type: ignore[arg-type]  # bytes, which VTK calls str


def _to_memory(writer: vtkXMLWriter | vtkUnstructuredGridWriter, grid: pyvista.DataSet) -> None:
    writer.SetInputData(grid)
    writer.WriteToOutputStringOn()
    if not writer.Write():
        msg = f"{type(writer).__name__} could not make the file (error {writer.GetErrorCode()})"
        raise OSError(msg)


def _write_gmsh(tri: Delaunay | Subset, path: Path) -> None:
    meshio = optional("meshio")
    meshio.gmsh.write(path, meshio.Mesh(tri.points, {"tetra": tri.simplices}), "4.1")


def _write_medit(tri: Delaunay | Subset, path: Path) -> None:
    meshio = optional("meshio")
    reference = {"medit:ref": [np.asarray(tri.iteration)]}
    meshio.medit.write(path, meshio.Mesh(tri.points, {"tetra": tri.simplices}, cell_data=reference))


def write_ply(points: np.ndarray, facets: np.ndarray, path: Path) -> None:
    """Write facets (h, 3) of points (n, 3) as binary PLY, which has no other points."""
    meshio = optional("meshio")
    points, facets, _ = own_points(points, facets)
    meshio.ply.write(path, meshio.Mesh(points, {"triangle": facets}), binary=True)


def write_stl(points: np.ndarray, facets: np.ndarray, path: Path) -> None:
    """Write facets (h, 3) of points (n, 3) as binary STL.

    That is 80 bytes that say nothing, the number of facets, and 50 bytes for each facet.

    meshio has NumPy write the facets (``tofile``), which overlooks a disk that is full at their end.
    """
    points, facets, _ = own_points(points, facets)
    greatest = np.abs(points).max(initial=0.0)
    if greatest > np.finfo(np.float32).max:
        msg = f"a coordinate of {greatest:g} is beyond the single precision of .stl; write .ply"
        raise ValueError(msg)
    corners = points[facets]
    # normals of the set scaled to 1: squares of great and of small coordinates are beyond what float64 has
    a, b, c = (corners / (greatest or 1.0)).swapaxes(0, 1)
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    rows = np.zeros(len(corners), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    rows["normal"] = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    rows["corners"] = corners
    with path.open("wb") as file:
        file.write(b"convex hull by dt3d".ljust(80) + np.uint32(len(rows)).astype("<u4").tobytes())
        file.write(rows.tobytes())


WRITERS: dict[str, Callable[[Delaunay | Subset, Path], None]] = {
    ".npz": _write_npz,
    ".vtu": _write_vtu,
    ".vtk": _write_vtk,
    ".msh": _write_gmsh,
    ".mesh": _write_medit,
    ".ply": lambda tri, path: write_ply(tri.points, surface(tri), path),
    ".stl": lambda tri, path: write_stl(tri.points, surface(tri), path),
}
