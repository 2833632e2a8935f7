"""Triangulations in the plane, written to files; `dt3d.reading.plane` reads them back.

Formats of space get z = 0 for every point.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ._cell_data import cell_data, varies
from ._mesh_data import Content, carry, check_point_data, telling_of
from ._mesh_writing import add_point_data, flattened, save_arrays, save_legacy, write_ply, write_stl
from ._optional import optional
from ._output import save_figure
from ._paths import check_target, written_aside
from ._vtk_xml import XmlMesh, write_xml

if TYPE_CHECKING:
    import pyvista

    from ._triangulation import Triangulation

    InPlane: TypeAlias = Content[Triangulation]


def write_plane_mesh(
    tri: Triangulation,
    path: str | Path,
    *,
    point_data: Mapping[str, np.ndarray] | None = None,
    compress: bool = False,
) -> None:
    """Write a triangulation in the plane.

    =============== ==========================================================================================
    .npz            arrays points (n, 2), triangles, neighbors and thread
    .vtu .vtk .vtp  the triangles, with the cell data of `cell_data` (.vtk needs PyVista)
    .msh .mesh      the triangles for Gmsh and Medit (needs meshio)
    .ply .stl .obj  the triangles as a surface; .stl in single precision (.ply needs meshio)
    =============== ==========================================================================================

    Parameters
    ----------
    tri : threaded2d.Delaunay or Subset
        What is written.
    path : str or Path
        A file that exists is replaced, when the new one is whole.
    point_data, compress
        As `dt3d.files.write_mesh` has them; .vtp holds and packs what .vtu does.

    Raises
    ------
    OSError, ValueError, ImportError
        As `check_plane_path` says, if the file cannot be written, if .stl cannot hold the coordinates, and if
        point data have not an entry per site.
    """
    path = check_plane_path(path)
    content = Content(tri, check_point_data(point_data or {}, len(tri.points)), compress)
    with written_aside(path) as aside:
        WRITERS[path.suffix.lower()](content, aside)


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


def _write_npz(content: InPlane, path: Path) -> None:
    names = ("points", "triangles", "neighbors", "thread")
    save_arrays(path, content, {name: getattr(content.tri, name) for name in names})


def _xml_mesh(content: InPlane) -> XmlMesh:
    tri, cells = content.tri, cell_data(content.tri)
    return XmlMesh(_raised(tri), tri.triangles, cells, content.point_data, telling_of(cells))


def _write_vtu(content: InPlane, path: Path) -> None:
    write_xml(_xml_mesh(content), path, compress=content.compress)


def _write_vtp(content: InPlane, path: Path) -> None:
    mesh, inserted_by = _xml_mesh(content), content.tri.inserted_by
    if varies(inserted_by[inserted_by >= 0]):  # as `to_pyvista` has it
        mesh = replace(mesh, point_data={"inserted_by": inserted_by, **mesh.point_data})
    write_xml(mesh, path, surface=True, compress=content.compress)


def _write_vtk(content: InPlane, path: Path) -> None:
    pv = optional("pyvista")
    tri = content.tri
    grid: pyvista.UnstructuredGrid = pv.UnstructuredGrid({pv.CellType.TRIANGLE: tri.triangles}, _raised(tri))
    carry(grid, cell_data(tri))
    add_point_data(grid, content.point_data)
    save_legacy(grid, path)


def _write_gmsh(content: InPlane, path: Path) -> None:
    meshio = optional("meshio")
    tri = content.tri
    mesh = meshio.Mesh(_raised(tri), {"triangle": tri.triangles}, point_data=flattened(content.point_data))
    meshio.gmsh.write(path, mesh, "4.1")


def _write_medit(content: InPlane, path: Path) -> None:
    meshio = optional("meshio")
    meshio.medit.write(path, meshio.Mesh(_raised(content.tri), {"triangle": content.tri.triangles}))


def _write_obj(content: InPlane, path: Path) -> None:
    tri = content.tri
    text = io.StringIO()
    text.write("# triangulation in the plane by dt3d\n")
    text.writelines(f"v {x!r} {y!r} 0\n" for x, y in tri.points.tolist())
    text.writelines(f"f {a} {b} {c}\n" for a, b, c in (tri.triangles + 1).tolist())
    path.write_text(text.getvalue(), encoding="ascii")


WRITERS: dict[str, Callable[[InPlane, Path], None]] = {
    ".npz": _write_npz,
    ".vtu": _write_vtu,
    ".vtk": _write_vtk,
    ".vtp": _write_vtp,
    ".msh": _write_gmsh,
    ".mesh": _write_medit,
    ".ply": lambda content, path: write_ply(_raised(content.tri), content.tri.triangles, path),
    ".stl": lambda content, path: write_stl(_raised(content.tri), content.tri.triangles, path),
    ".obj": _write_obj,
}
