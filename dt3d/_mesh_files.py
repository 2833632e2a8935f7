"""Triangulations read from files, to look at them and to verify them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ._input import check_points
from ._mesh import import_pyvista
from ._mesh_input import check_simplices
from ._paths import check_file


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
