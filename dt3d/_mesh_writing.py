"""Writing triangulations. Every file is written aside and takes its name when it is whole.

VTK does not write to the disk itself: where that is full its writers end the process (XML), say nothing (PLY)
or print on the terminal. What it writes goes into memory, and Python writes that to the disk.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from ._cell_data import cell_data
from ._mesh import own_points, sizes, surface, to_pyvista
from ._mesh_data import Content, check_point_data, telling_of
from ._optional import optional
from ._paths import check_target, written_aside
from ._vtk_xml import XmlMesh, as_numbers, write_xml

if TYPE_CHECKING:
    import pyvista

    from .delaunay import Delaunay
    from .subset import Subset

    InSpace: TypeAlias = Content[Delaunay | Subset]


def write_mesh(
    tri: Delaunay | Subset,
    path: str | Path,
    *,
    point_data: Mapping[str, np.ndarray] | None = None,
    compress: bool = False,
) -> None:
    """Write a triangulation.

    ============ =============================================================================================
    .vtu .vtk    the tetrahedra, with the cell data of ``to_pyvista`` (.vtk needs PyVista)
    .npz         arrays points, simplices, neighbors, iteration and volume, and the point data
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
    point_data : mapping of str to arrays (n, ...), optional
        Data of the sites, which .vtu, .vtk, .npz and .msh hold; the others have no room for them.
    compress : bool
        Pack .vtu and .npz: they have some two thirds of the size, and take some ten times as long to write.

    Raises
    ------
    OSError, ValueError, ImportError
        As `check_mesh_path` says, if the file cannot be written, if .stl cannot hold the coordinates, and if
        point data have not an entry per site.

    Examples
    --------
    >>> import tempfile, dt3d
    >>> from dt3d.files import read_mesh, write_mesh
    >>> tri = dt3d.Delaunay([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_mesh(tri, f"{folder}/mesh.vtu")
    ...     print(len(read_mesh(f"{folder}/mesh.vtu").simplices))
    1
    """
    path = check_mesh_path(path)
    content = Content(tri, check_point_data(point_data or {}, len(tri.points)), compress)
    with written_aside(path) as aside:
        WRITERS[path.suffix.lower()](content, aside)


def check_mesh_path(path: str | Path) -> Path:
    """The path, if a mesh can be written there; to be asked before a long computation.

    Raises
    ------
    ValueError
        For an extension that `write_mesh` does not know.
    OSError
        If the folder does not exist or may not be written, or the file may not be replaced.

    Examples
    --------
    >>> from dt3d.files import check_mesh_path
    >>> check_mesh_path("mesh.vtu").suffix
    '.vtu'
    """
    return check_target(path, WRITERS, "write a mesh to")


def save_arrays(path: Path, content: Content[Any], arrays: dict[str, np.ndarray]) -> None:
    """Write arrays, and the point data under other names, as .npz."""
    points = {f"point_{name}" if name in arrays else name: v for name, v in content.point_data.items()}
    save: Any = np.savez_compressed if content.compress else np.savez
    with path.open("wb") as file:  # NumPy puts .npz behind a name that ends in .NPZ
        save(file, **arrays, **points)


def _write_npz(content: InSpace, path: Path) -> None:
    arrays = {name: getattr(content.tri, name) for name in ("points", "simplices", "neighbors", "iteration")}
    save_arrays(path, content, {**arrays, "volume": sizes(content.tri)})


def _write_vtu(content: InSpace, path: Path) -> None:
    cells = cell_data(content.tri)
    tri = content.tri
    mesh = XmlMesh(tri.points, tri.simplices, cells, content.point_data, telling_of(cells))
    write_xml(mesh, path, compress=content.compress)


def _write_vtk(content: InSpace, path: Path) -> None:
    grid = to_pyvista(content.tri)  # says what to install where VTK is missing
    add_point_data(grid, content.point_data)
    save_legacy(grid, path)


def add_point_data(grid: pyvista.DataSet, point_data: Mapping[str, np.ndarray]) -> None:
    """Give a dataset point data, in types that VTK has."""
    for name, values in point_data.items():
        numbers = as_numbers(name, values)
        grid.point_data[name] = numbers.reshape(len(numbers), -1) if numbers.ndim > 2 else numbers


def save_legacy(grid: pyvista.UnstructuredGrid, path: Path) -> None:
    """An unstructured grid of PyVista in VTK's legacy format."""
    from vtkmodules.vtkIOLegacy import vtkUnstructuredGridWriter

    writer = vtkUnstructuredGridWriter()
    writer.SetFileTypeToBinary()
    writer.SetInputData(grid)
    writer.WriteToOutputStringOn()
    if not writer.Write():
        msg = f"{type(writer).__name__} could not make the file (error {writer.GetErrorCode()})"
        raise OSError(msg)
    path.write_bytes(writer.GetOutputStdString())  # type: ignore[arg-type]  # bytes, which VTK calls str


def _write_gmsh(content: InSpace, path: Path) -> None:
    meshio = optional("meshio")
    cells = {"tetra": content.tri.simplices}
    mesh = meshio.Mesh(content.tri.points, cells, point_data=flattened(content.point_data))
    meshio.gmsh.write(path, mesh, "4.1")


def flattened(point_data: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Point data as Gmsh has them: float64 (n,) or (n, k)."""
    return {
        name: np.asarray(values, np.float64).reshape(len(values), -1) if values.ndim > 1 else values
        for name, values in point_data.items()
    }


def _write_medit(content: InSpace, path: Path) -> None:
    meshio = optional("meshio")
    reference = {"medit:ref": [np.asarray(content.tri.iteration)]}
    mesh = meshio.Mesh(content.tri.points, {"tetra": content.tri.simplices}, cell_data=reference)
    meshio.medit.write(path, mesh)


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


WRITERS: dict[str, Callable[[InSpace, Path], None]] = {
    ".npz": _write_npz,
    ".vtu": _write_vtu,
    ".vtk": _write_vtk,
    ".msh": _write_gmsh,
    ".mesh": _write_medit,
    ".ply": lambda content, path: write_ply(content.tri.points, surface(content.tri), path),
    ".stl": lambda content, path: write_stl(content.tri.points, surface(content.tri), path),
}
