"""Reading points: the formats, and what all of them have in common."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np

from ._columns import as_float64
from ._compressed import inner, unpacked
from ._paths import by_extension, check_file
from ._point_binary import BINARY_READERS
from ._point_text import TEXT_READERS
from ._reading import guarded

READERS = {**TEXT_READERS, **BINARY_READERS}


def read_points(path: str | Path, *, dimension: Literal[2, 3] | None = 3) -> np.ndarray:
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
    .gz after any         the same, packed by gzip
    ===================== ====================================================================================

    The order of the file is kept, and so are duplicates and values that are not finite; the triangulation
    deals with both.

    Parameters
    ----------
    path : str or Path
    dimension : 2, 3 or None
        3 asks for three coordinates. 2 asks for two, and takes x and y of a file that has three. None takes
        two or three, as the file has them.

    Returns
    -------
    float64 (n, 3) or (n, 2)

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        For an unknown extension, or content that is not points of this dimension, or is damaged. One line
        that names the file, whatever library found it.
    ImportError
        If the package that reads this kind of file is not installed.
    """
    if dimension not in (2, 3, None):
        msg = f"dimension must be 2, 3 or None, got {dimension!r}"
        raise ValueError(msg)
    path = Path(path)
    reader = by_extension(inner(path), READERS, "read points from")
    check_file(path)

    def points_of(path: Path) -> np.ndarray:
        with unpacked(path) as plain:
            found = guarded(reader, plain, path)
        return _points(path, found, dimension)

    return guarded(points_of, path)


def _points(path: Path, found: np.ndarray, dimension: int | None) -> np.ndarray:
    """The array that a reader found as float64 (n, dimension), or an error that names the file."""
    found = np.asarray(found)
    wanted = "(n, 2) or (n, 3)" if dimension is None else f"(n, {dimension})"
    columns = {2: (2, 3), 3: (3,), None: (2, 3)}[dimension]
    if found.ndim != 2 or found.shape[1] not in columns:
        msg = f"{path}: expected an array of shape {wanted}, found {found.shape}"
        if found.ndim == 2 and found.shape[0] in columns:
            msg += "; transpose it (array.T) if its columns are the points"
        elif found.ndim == 2 and found.shape[1] == 2:
            msg += "; points in the plane are read with dimension=2, for dt3d.threaded2d"
        raise ValueError(msg)
    found = found[:, : found.shape[1] if dimension is None else dimension]
    return np.ascontiguousarray(as_float64(found, str(path)))
