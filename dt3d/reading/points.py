"""Reading points: the formats, and what all of them have in common."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from .._paths import by_extension, check_file
from .binary import BINARY_READERS
from .columns import as_float64
from .compressed import inner, unpacked
from .guarded import guarded
from .point_data import PointData
from .text import TEXT_READERS

READERS = {**TEXT_READERS, **BINARY_READERS}


@dataclass(frozen=True)
class Cloud:
    """Points from a file, with what the file says of each.

    Attributes
    ----------
    points : float64 (n, 3) or (n, 2)
        As `read_points` gives them.
    point_data : mapping of str to arrays (n,) or (n, ...)
        By the file's names and in its types: row k is of point k. `write_mesh` takes them.
    left_out : mapping of str to str
        What the file has beside, by name, and why it is not among the point data.
    """

    points: np.ndarray
    point_data: Mapping[str, np.ndarray] = field(default_factory=dict)
    left_out: Mapping[str, str] = field(default_factory=dict)


def read_points(path: str | Path, *, dimension: Literal[2, 3] | None = 3) -> np.ndarray:
    """The points of a file.

    ========================== =============================================================================
    .npy                       an array (n, 3), or a structured one with fields x, y and z
    .npz                       the array ``points``, or the only array, or x, y and z, or the one that has a
                               usual name, such as ``pos`` or ``xyz``
    .csv .tsv .txt .dat        three columns, or those that a header calls x, y and z; between commas,
                               semicolons or white space
    .asc .pts                  the first three columns of a scanner's text
    .xyz                       lines ``x y z ...``, or chemistry's XYZ with count, comment and element symbols
    .pdb .cif .mmcif           the atoms of a structure (.cif needs gemmi)
    .dump .lammpstrj           the atoms of a LAMMPS dump
    .obj .off .node            the vertices or nodes, in double precision
    .ply                       the vertices, whatever other elements and lists there are
    .pcd                       the points of PCL, in text, binary or compressed
    .las .laz                  the points of a laser scan, scaled and offset (needs laspy)
    .stl                       the corners of the triangles, each once
    .vtk                       the points of VTK's legacy format, in text or binary
    .vtu .vtp .vti .vts .vtr   the points of VTK's XML formats; of pieces one after the other
    .vtm                       the points of all files that it names, one after the other
    .msh .mesh                 the nodes of Gmsh (2.2 and 4.1) and the vertices of Medit
    .gz after any              the same, packed by gzip
    ========================== =============================================================================

    Binary numbers have the precision of the file; text is read as double, whatever type is declared. Each
    reader checks what the file promises: a damaged one is an error, and not points that nobody wrote.

    The order of the file is kept, and so are duplicates and values that are not finite; the triangulation
    deals with both.

    Parameters
    ----------
    path : str or Path
        The file, whose extension says what it is.
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

    Examples
    --------
    >>> import tempfile, numpy as np
    >>> from dt3d.files import read_points
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     np.savetxt(f"{folder}/a.csv", [[0, 0, 1], [2, 3, 4]], delimiter=",")
    ...     print(read_points(f"{folder}/a.csv").tolist())
    [[0.0, 0.0, 1.0], [2.0, 3.0, 4.0]]
    """
    return _read(path, dimension, None)


def read_cloud(path: str | Path, *, dimension: Literal[2, 3] | None = 3) -> Cloud:
    """The points of a file, and what the file says of each: temperatures, normals, colours, classes.

    ========================== =============================================================================
    .vtu .vtp .vti .vts .vtr   the point data; of pieces, and of the files of a .vtm, those that all have
    .vtk                       scalars, vectors, normals, tensors, colours and fields of the points
    .ply                       the other scalars of vertices
    .npz .npy                  arrays of as many rows as there are points; fields of a structured array
    .csv .tsv .txt .dat        the other columns that a header names: int64 where all cells are whole numbers,
                               float64 where all are numbers or missing (NaN), else text
    .xyz .asc .pts             the same; of extended XYZ what ``Properties`` names
    .dump .lammpstrj           the other columns
    .pcd                       the other fields
    .msh                       data of nodes, which every node must have
    .las .laz                  all dimensions of the points: intensity, classification, GPS time ...
    ========================== =============================================================================

    Each of them with .gz, too. Of the other formats that `read_points` reads, the points only. Arrays keep
    their names and types, and their rows are those of the points: nothing is dropped or put in another order.

    Parameters
    ----------
    path : str or Path
        The file, whose extension says what it is.
    dimension : 2, 3 or None
        As `read_points` has it. With 2, the heights of a file that has three coordinates become the point
        data ``z``, unless all are equal.

    Returns
    -------
    Cloud

    Raises
    ------
    OSError, ValueError, ImportError
        As `read_points` says; also for an array that is damaged, or has not an entry for each point.

    Examples
    --------
    >>> import tempfile, pathlib, dt3d.files
    >>> path = pathlib.Path(tempfile.mkdtemp(), "cloud.csv")
    >>> _ = path.write_text("x,y,z,t\\n0,0,0,20\\n1,0,0,21\\n0,1,0,22\\n")
    >>> cloud = dt3d.files.read_cloud(path)
    >>> cloud.points.shape, cloud.point_data["t"].tolist()
    ((3, 3), [20, 21, 22])
    """
    keep = PointData()
    points = _read(path, dimension, keep)
    return Cloud(points, keep.arrays, keep.left_out)


def _read(path: str | Path, dimension: int | None, keep: PointData | None) -> np.ndarray:
    """The points of a file; what it says of them goes to ``keep``, if there is one."""
    if dimension not in (2, 3, None):
        msg = f"dimension must be 2, 3 or None, got {dimension!r}"
        raise ValueError(msg)
    path = Path(path)
    reader = by_extension(inner(path), READERS, "read points from")
    check_file(path)

    def points_of(path: Path) -> np.ndarray:
        with unpacked(path) as plain:
            found = guarded(lambda plain: reader(plain, keep), plain, path)
        points = _points(path, found, dimension)
        if keep is not None:
            if found.shape[1] > points.shape[1] and (found[:, 2] != found[0, 2]).any():
                keep.add("z", found[:, 2])
            keep.check(str(path), len(points))
        return points

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
