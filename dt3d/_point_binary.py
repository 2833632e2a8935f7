"""The readers of points in formats that are not columns of text."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from ._mesh import import_pyvista
from ._paths import import_meshio


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


BINARY_READERS: dict[str, Callable[[Path], np.ndarray]] = {
    **dict.fromkeys([".npy", ".npz"], _read_npy),
    **dict.fromkeys([".ply"], _read_meshio),
    **dict.fromkeys([".vtk", ".vtu", ".vtp", ".stl"], _read_pyvista),
}
"""A reader for each extension: takes a Path, gives an array of numbers (n, k)."""
