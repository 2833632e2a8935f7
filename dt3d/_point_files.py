"""Reading points: one reader for each kind of file."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from ._mesh import import_pyvista
from ._paths import by_extension, check_file, import_meshio
from ._point_text import read_columns, read_obj, read_pdb, read_xyz


def read_points(path: str | Path) -> np.ndarray:
    """The points of a file.

    ===================== ====================================================================================
    .npy                  an array (n, 3)
    .npz                  the array ``points``, or the only array
    .csv .tsv .txt        three columns, or those that a header calls x, y and z; between commas, semicolons
                          or white space
    .xyz                  lines ``x y z ...``, or chemistry's XYZ with count, comment and element symbols
    .pdb                  the atoms of a Protein Data Bank file
    .obj                  the vertices, in double precision
    .ply .off             the vertices, in the file's precision (needs meshio)
    .vtk .vtu .vtp .stl   the points (needs PyVista)
    ===================== ====================================================================================

    The order of the file is kept, and so are duplicates and values that are not finite; the triangulation
    deals with both.

    Returns
    -------
    float64 (n, 3)

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        For an unknown extension, or content that is not points in three dimensions.
    ImportError
        If the package that reads this kind of file is not installed.
    """
    path = Path(path)
    reader = by_extension(path, READERS, "read points from")
    points = np.asarray(reader(check_file(path)))
    if points.ndim != 2 or points.shape[1] != 3:
        msg = f"{path}: expected an array of shape (n, 3), found {points.shape}"
        raise ValueError(msg)
    if points.dtype.kind not in "iuf":
        msg = f"{path}: expected real numbers, found {points.dtype}"
        raise ValueError(msg)
    return np.ascontiguousarray(points, np.float64)


def _read_npy(path: Path) -> np.ndarray:
    try:
        loaded = np.load(path, allow_pickle=False)
    except (ValueError, EOFError) as error:
        msg = f"{path} is not a NumPy array file: {error}"
        raise ValueError(msg) from None
    if isinstance(loaded, np.ndarray):
        return loaded
    with loaded:
        names = loaded.files
        if "points" not in names and len(names) != 1:
            msg = f"{path}: expected an array 'points' or a single array, found {', '.join(names) or 'none'}"
            raise ValueError(msg)
        return loaded["points" if "points" in names else names[0]]


def _read_meshio(path: Path) -> np.ndarray:
    # the readers themselves: meshio.read ends the process when it cannot read a file
    reader = getattr(import_meshio(), path.suffix.lower()[1:]).read
    try:
        return reader(path).points
    except Exception as error:
        msg = f"{path} could not be read by meshio: {type(error).__name__}: {error}"
        raise ValueError(msg) from error


def _read_pyvista(path: Path) -> np.ndarray:
    mesh = import_pyvista().read(path)
    if not getattr(mesh, "n_points", 0):
        msg = f"{path} holds no points that VTK can read"
        raise ValueError(msg)
    return np.asarray(mesh.points)


READERS: dict[str, Callable[[Path], np.ndarray]] = {
    **dict.fromkeys([".npy", ".npz"], _read_npy),
    **dict.fromkeys([".csv", ".tsv", ".txt"], read_columns),
    ".xyz": read_xyz,
    ".pdb": read_pdb,
    ".obj": read_obj,
    **dict.fromkeys([".ply", ".off"], _read_meshio),
    **dict.fromkeys([".vtk", ".vtu", ".vtp", ".stl"], _read_pyvista),
}
