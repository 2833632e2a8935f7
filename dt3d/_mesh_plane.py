"""Triangulations in the plane, written to files and read back to be verified.

Formats of space get z = 0 for every point.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from ._mesh_writing import save_legacy, save_xml, write_ply, write_stl
from ._optional import optional
from ._output import save_figure
from ._paths import by_extension, check_file, check_writable, written_aside
from .reading.columns import as_float64
from .reading.compressed import inner, unpacked
from .reading.gmsh import read_gmsh
from .reading.guarded import guarded
from .reading.medit import read_medit
from .reading.meshes import TETRAHEDRON, VOLUMES
from .reading.npy import read_arrays
from .reading.vtk_legacy import read_legacy
from .reading.vtk_xml import read_xml

TRIANGLE = 5
"""VTK's number for this kind of cell; the readers of other formats use VTK's numbers."""

FILLS_SPACE = [TETRAHEDRON, *VOLUMES]


@dataclass(frozen=True)
class PlaneMesh:
    """Triangles in the plane from a file.

    Attributes
    ----------
    points : float64 (n, 2)
    triangles : int (m, 3)
        As the file has them: `dt3d.threaded2d.verify` checks them before it uses them.
    """

    points: np.ndarray
    triangles: np.ndarray


def write_plane_mesh(tri: Any, path: str | Path) -> None:
    """Write a triangulation in the plane.

    =============== ==========================================================================================
    .npz            arrays points (n, 2), triangles, neighbors and thread
    .vtu .vtk .vtp  the triangles, with cell data "thread" (needs PyVista)
    .msh .mesh      the triangles for Gmsh and Medit (needs meshio)
    .ply .stl .obj  the triangles as a surface; .stl in single precision (.ply needs meshio)
    =============== ==========================================================================================

    Parameters
    ----------
    tri : threaded2d.Delaunay
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
    path = Path(path)
    by_extension(path, WRITERS, "write triangles to")
    check_writable(path)
    return path


def draw_plane(tri: Any, path: Path) -> None:
    """A picture of the triangles, coloured by the threads that made them; `plot.FORMATS` has the
    extensions."""
    save_figure(tri.plot().figure, path, dpi=200)


def read_plane_mesh(path: str | Path) -> PlaneMesh | None:
    """The triangles of a file that `write_plane_mesh` or another program wrote; None if it holds no
    triangles in the plane z = 0, or cells that fill space beside them.

    Reads .npz .vtu .vtk .msh .mesh, and each of them packed by gzip.

    Raises
    ------
    OSError, ValueError
        If the file is missing or damaged: one line that names it.
    """
    path = Path(path)
    reader = READERS.get(inner(path).suffix.lower())
    if reader is None:
        return None
    check_file(path)

    def mesh_of(path: Path) -> PlaneMesh | None:
        with unpacked(path) as plain:
            return guarded(reader, plain, path)

    return guarded(mesh_of, path)


def _read_npz(path: Path) -> PlaneMesh | None:
    found = read_arrays(path, ["points", "triangles"])
    if found.keys() != {"points", "triangles"}:
        return None
    return _in_plane(path, found["points"], found["triangles"])


def _read_cells(path: Path) -> PlaneMesh | None:
    found = CELLS[path.suffix.lower()](path)
    if "types" not in found or "offsets" not in found:
        return None
    types, offsets = np.asarray(found["types"]), np.asarray(found["offsets"])
    chosen = types == TRIANGLE
    if np.isin(types, FILLS_SPACE).any() or not chosen.any() or len(offsets) != len(types) + 1:
        return None
    starts, ends = offsets[:-1][chosen], offsets[1:][chosen]
    if (ends - starts != 3).any() or starts.min() < 0 or ends.max() > len(found["connectivity"]):
        msg = f"{path} is damaged: a triangle has other than three points"
        raise ValueError(msg)
    return _in_plane(path, found["points"], found["connectivity"][starts[:, None] + np.arange(3)])


def _in_plane(path: Path, points: np.ndarray, triangles: np.ndarray) -> PlaneMesh | None:
    """A mesh of points (n, 2), or (n, 3) with z = 0; None for others."""
    if points.ndim == 2 and points.shape[1] == 3 and not points[:, 2].any():
        points = points[:, :2]
    if points.ndim != 2 or points.shape[1] != 2:
        return None
    return PlaneMesh(np.ascontiguousarray(as_float64(points, f"{path}: points")), triangles)


def _raised(tri: Any) -> np.ndarray:
    """The points with z = 0, float64 (n, 3)."""
    return np.column_stack([tri.points, np.zeros(len(tri.points))])


def _surface(tri: Any) -> Any:
    """The triangles in the place of a hull, for the writers of surfaces."""
    return SimpleNamespace(points=_raised(tri), convex_hull=tri.triangles)


def _write_npz(tri: Any, path: Path) -> None:
    with path.open("wb") as file:  # NumPy puts .npz behind a name that ends in .NPZ
        np.savez_compressed(
            file, points=tri.points, triangles=tri.triangles, neighbors=tri.neighbors, thread=tri.thread
        )


def _grid(tri: Any) -> Any:
    pv = optional("pyvista")
    grid = pv.UnstructuredGrid({pv.CellType.TRIANGLE: tri.triangles}, _raised(tri))
    grid.cell_data["thread"] = tri.thread
    return grid


def _write_vtu(tri: Any, path: Path) -> None:
    grid = _grid(tri)  # says what to install where VTK is missing
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    save_xml(vtkXMLUnstructuredGridWriter(), grid, path)


def _write_vtp(tri: Any, path: Path) -> None:
    surface = tri.to_pyvista()
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    save_xml(vtkXMLPolyDataWriter(), surface, path)


def _write_vtk(tri: Any, path: Path) -> None:
    save_legacy(_grid(tri), path)


def _write_gmsh(tri: Any, path: Path) -> None:
    meshio = optional("meshio")
    meshio.gmsh.write(path, meshio.Mesh(_raised(tri), {"triangle": tri.triangles}), "4.1")


def _write_medit(tri: Any, path: Path) -> None:
    meshio = optional("meshio")
    meshio.medit.write(path, meshio.Mesh(_raised(tri), {"triangle": tri.triangles}))


def _write_obj(tri: Any, path: Path) -> None:
    text = io.StringIO()
    text.write("# triangulation in the plane by dt3d\n")
    text.writelines(f"v {x!r} {y!r} 0\n" for x, y in tri.points.tolist())
    text.writelines(f"f {a} {b} {c}\n" for a, b, c in (tri.triangles + 1).tolist())
    path.write_text(text.getvalue(), encoding="ascii")


WRITERS: dict[str, Callable[[Any, Path], None]] = {
    ".npz": _write_npz,
    ".vtu": _write_vtu,
    ".vtk": _write_vtk,
    ".vtp": _write_vtp,
    ".msh": _write_gmsh,
    ".mesh": _write_medit,
    ".ply": lambda tri, path: write_ply(_surface(tri), path),
    ".stl": lambda tri, path: write_stl(_surface(tri), path),
    ".obj": _write_obj,
}

CELLS = {".vtu": read_xml, ".vtk": read_legacy, ".msh": read_gmsh, ".mesh": read_medit}

READERS: dict[str, Callable[[Path], PlaneMesh | None]] = {
    ".npz": _read_npz,
    **dict.fromkeys(CELLS, _read_cells),
}
