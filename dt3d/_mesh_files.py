"""Writing triangulations, and reading them back to look at them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ._input import check_points
from ._mesh import hull_to_pyvista, import_pyvista, to_pyvista, volumes
from ._mesh_input import check_simplices
from ._paths import by_extension, check_file, check_folder, import_meshio


@dataclass(frozen=True)
class Mesh:
    """Tetrahedra from a file, as `draw` and `to_pyvista` take them.

    Attributes
    ----------
    points : float64 (n, 3)
    simplices : int32 (m, 4)
    iteration : int32 (m,)
        The iteration that found each tetrahedron; 1 where the file does not say.
    """

    points: np.ndarray
    simplices: np.ndarray
    iteration: np.ndarray


def write_mesh(tri: Any, path: str | Path) -> None:
    """Write a triangulation.

    ============ =============================================================================================
    .vtu .vtk    the tetrahedra, with cell data "iteration" and "volume" (needs PyVista)
    .npz         arrays points, simplices, neighbors, iteration and volume
    .msh .mesh   the tetrahedra for Gmsh and Medit; Medit's reference is the iteration (needs meshio)
    .ply .stl    the surface of the convex hull, in single precision (needs PyVista)
    ============ =============================================================================================

    Parameters
    ----------
    tri : Delaunay
    path : str or Path
        A file that exists is replaced.

    Raises
    ------
    OSError, ValueError, ImportError
        As `check_mesh_path` says, and if the file cannot be written.
    """
    path = check_mesh_path(path)
    WRITERS[path.suffix.lower()](tri, path)
    if not path.exists():  # VTK reports a failure on the terminal only
        msg = f"{path} could not be written"
        raise OSError(msg)


def check_mesh_path(path: str | Path) -> Path:
    """The path, if a mesh can be written there; to be asked before a long computation.

    Raises
    ------
    ValueError
        For an extension that `write_mesh` does not know.
    FileNotFoundError
        If the folder does not exist.
    """
    path = Path(path)
    by_extension(path, WRITERS, "write a mesh to")
    return check_folder(path)


def read_mesh(path: str | Path) -> Mesh:
    """The tetrahedra of a file that `write_mesh` wrote, or of another that PyVista reads.

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        If it holds no tetrahedra, or points or indices that cannot be used.
    ImportError
        If PyVista is not installed and the file is not an .npz.
    """
    path = check_file(Path(path))
    if path.suffix.lower() == ".npz":
        with np.load(path) as arrays:
            if missing := {"points", "simplices"} - set(arrays.files):
                msg = f"{path} holds no mesh: there is no array {' and none '.join(sorted(missing))}"
                raise ValueError(msg)
            points, simplices, iteration = (arrays.get(n) for n in ("points", "simplices", "iteration"))
    else:
        points, simplices, iteration = _read_grid(path)
    if iteration is None:
        iteration = np.ones(len(simplices))
    try:
        points = check_points(points)
        simplices = check_simplices(simplices, len(points), 4).astype(np.int32)
    except ValueError as error:
        msg = f"{path}: {error}"
        raise ValueError(msg) from None
    return Mesh(points, simplices, np.asarray(iteration, np.int32))


def _read_grid(path: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    pv = import_pyvista()
    try:
        grid = pv.read(path)
    except (ValueError, OSError) as error:
        msg = f"{path} could not be read by PyVista: {error}"
        raise ValueError(msg) from error
    tetrahedra = getattr(grid, "cells_dict", {}).get(pv.CellType.TETRA)
    if tetrahedra is None:
        msg = f"{path} holds no tetrahedra"
        raise ValueError(msg)
    data = grid.cell_data
    name = next((name for name in ("iteration", "medit:ref") if name in data), None)
    is_tetrahedron = grid.celltypes == pv.CellType.TETRA
    return grid.points, tetrahedra, None if name is None else np.asarray(data[name])[is_tetrahedron]


def _write_npz(tri: Any, path: Path) -> None:
    arrays = {name: getattr(tri, name) for name in ("points", "simplices", "neighbors", "iteration")}
    np.savez_compressed(path, volume=volumes(tri.points, tri.simplices), **arrays)


def _write_grid(tri: Any, path: Path) -> None:
    to_pyvista(tri).save(path)


def _write_hull(tri: Any, path: Path) -> None:
    hull_to_pyvista(tri).save(path)


def _write_gmsh(tri: Any, path: Path) -> None:
    meshio = import_meshio()
    meshio.gmsh.write(path, meshio.Mesh(tri.points, {"tetra": tri.simplices}), "4.1")


def _write_medit(tri: Any, path: Path) -> None:
    meshio = import_meshio()
    reference = {"medit:ref": [np.asarray(tri.iteration)]}
    meshio.medit.write(path, meshio.Mesh(tri.points, {"tetra": tri.simplices}, cell_data=reference))


WRITERS: dict[str, Callable[[Any, Path], None]] = {
    ".npz": _write_npz,
    **dict.fromkeys([".vtu", ".vtk"], _write_grid),
    ".msh": _write_gmsh,
    ".mesh": _write_medit,
    **dict.fromkeys([".ply", ".stl"], _write_hull),
}
