"""Points and meshes in NumPy's files: .npy, and .npz, which is a zip archive of them.

NumPy's own `numpy.load` takes the memory that a header promises before it looks whether the file has as many
bytes, and reads a prefix where the header promises less; here the header is checked first.
"""

from __future__ import annotations

import math
import zipfile
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import IO

import numpy as np

from .._memory import available_memory, gigabytes
from .columns import stack_columns
from .point_data import PointData

MAGIC = b"\x93NUMPY"

NAMES = (
    "pos", "position", "positions", "xyz", "coord", "coords", "coordinates", "vertices", "verts", "nodes",
)  # fmt: skip
"""What others call the array, where it is one of several and there is none called ``points``."""

OF_MESHES = ("points", "simplices", "triangles", "neighbors", "iteration", "thread", "volume")
"""What `write_mesh` calls the arrays of a mesh, which are no data of its points."""

MOST_DEFLATED = 1032
"""A byte of deflate stands for at most so many (zlib's documentation, "Maximum expansion factor")."""


def read_npy(path: Path, keep: PointData | None = None) -> np.ndarray:
    """The array of an .npy, or of an .npz under this name; structured ones by their fields x, y and z.

    ``keep`` gets the other fields.
    """
    with path.open("rb") as file:
        start = file.read(len(MAGIC))
        if start[:2] == b"PK":
            return read_npz(path, keep)
        if start != MAGIC:
            found = f"it starts with {start!r}" if start else "it is empty"
            msg = f"{path} is not a NumPy array file: {found}"
            raise ValueError(msg)
        file.seek(0)
        return _coordinates(path, _array(path, file, path.stat().st_size), keep)


def read_npz(path: Path, keep: PointData | None = None) -> np.ndarray:
    """The array ``points`` of an .npz, else its only one, x, y and z, or the one that has a usual name.

    ``keep`` gets the other arrays that have as many rows.
    """
    with _archive(path) as archive:
        names, points = _points_of(path, archive, keep)
        if keep is not None:
            _keep_others(path, archive, names, len(points), keep)
        return points


def _keep_others(path: Path, archive: zipfile.ZipFile, used: list[str], n: int, keep: PointData) -> None:
    """Enter the arrays of an archive that have n rows and are no coordinates; say which have not."""
    names = _names(archive)
    mesh = {"simplices", "triangles"} & set(names)
    for name in names:
        if name in used or (mesh and name in OF_MESHES):
            continue
        try:
            array = _member(path, archive, name)
        except ValueError as error:
            if "Python objects" not in str(error):
                raise
            keep.leave_out(name, "it holds Python objects")
            continue
        if array.shape[:1] == (n,):
            keep.add(name, array)
        else:
            keep.leave_out(name, f"its shape is {array.shape}, and there are {n} points")


def _points_of(path: Path, archive: zipfile.ZipFile, keep: PointData | None) -> tuple[list[str], np.ndarray]:
    """The points of an archive, and the names of the arrays that they are in."""
    names = _names(archive)
    lowered = {name.lower(): name for name in names}
    usual = [name for name in names if name.lower() in NAMES]
    if "points" in names or len(names) == 1:
        name = "points" if "points" in names else names[0]
    elif {"x", "y"} <= lowered.keys():
        axes = [lowered[axis] for axis in "xyz" if axis in lowered]
        return axes, stack_columns(path, [(name, _member(path, archive, name)) for name in axes])
    elif len(usual) == 1:
        name = usual[0]
    else:
        found = ", ".join(names) or "none"
        msg = f"{path}: expected an array 'points', arrays x, y and z, or a single array; found {found}"
        raise ValueError(msg)
    return [name], _coordinates(path, _member(path, archive, name), keep)


def read_arrays(path: Path, wanted: Sequence[str], keep: PointData | None = None) -> dict[str, np.ndarray]:
    """Those of the wanted arrays that an .npz has; ``keep`` gets those that have as many rows as points."""
    with _archive(path) as archive:
        names = _names(archive)
        found = {name: _member(path, archive, name) for name in wanted if name in names}
        if keep is not None and "points" in found and found["points"].ndim:
            _keep_others(path, archive, [*wanted], len(found["points"]), keep)
        return found


def _archive(path: Path) -> zipfile.ZipFile:
    try:
        return zipfile.ZipFile(path)
    except zipfile.BadZipFile as error:
        size = path.stat().st_size
        msg = f"{path} is no whole .npz archive: {str(error).lower() if size else 'it is empty'}"
        raise ValueError(msg) from error


def _names(archive: zipfile.ZipFile) -> list[str]:
    return [name.removesuffix(".npy") for name in archive.namelist()]


def _member(path: Path, archive: zipfile.ZipFile, name: str) -> np.ndarray:
    """One array of an archive, with its checksum verified."""
    entry = next(entry for entry in archive.infolist() if entry.filename.removesuffix(".npy") == name)
    what = f"{path}: array {name!r}"
    if entry.file_size > MOST_DEFLATED * entry.compress_size + 64 and entry.compress_type in (0, 8):
        msg = f"{what} is said to unpack to {gigabytes(entry.file_size)}, which its data cannot"
        raise ValueError(msg)
    if entry.file_size > (room := available_memory()):
        msg = f"{what} needs {gigabytes(entry.file_size)} of memory; {gigabytes(room)} are available"
        raise ValueError(msg)
    try:
        with archive.open(entry) as file:
            array = _array(what, file, entry.file_size)
            file.read(1)  # only the end of the data shows whether the checksum is right
    except (zipfile.BadZipFile, zlib.error, EOFError) as error:
        msg = f"{what} is damaged: {error}"
        raise ValueError(msg) from error
    return array


def _array(what: Path | str, file: IO[bytes], size: int) -> np.ndarray:
    """The array that starts here and takes ``size`` bytes with its header; neither fewer nor more."""
    form = np.lib.format
    try:
        version = form.read_magic(file)
        # version 3 differs from 2 in the encoding of names only
        read_header = form.read_array_header_1_0 if version == (1, 0) else form.read_array_header_2_0
        shape, fortran, dtype = read_header(file)
    except (zipfile.BadZipFile, zlib.error):
        raise
    except Exception as error:  # ValueError, but also SyntaxError and tokenize.TokenError
        msg = f"{what} is not a NumPy array file: its header cannot be read ({error})"
        raise ValueError(msg) from error
    if dtype.hasobject:
        msg = (
            f"{what} holds Python objects, which are not read because they could run code; "
            "save numbers: np.save(file, array.astype(float))"
        )
        raise ValueError(msg)
    count = math.prod(shape)
    promised, there = count * dtype.itemsize, size - file.tell()
    if promised != there or min(shape, default=0) < 0:
        msg = f"{what}: the header promises shape {shape} of {dtype}, {promised} bytes; there are {there}"
        raise ValueError(msg)
    data = file.read(promised)
    if len(data) != promised:
        msg = f"{what} is cut off: {len(data)} bytes of {promised}"
        raise ValueError(msg)
    return np.frombuffer(data, dtype, count).reshape(shape, order="F" if fortran else "C")


def _coordinates(path: Path, array: np.ndarray, keep: PointData | None = None) -> np.ndarray:
    """The array itself, or the fields x, y and z of a structured one; ``keep`` gets its other fields."""
    fields = array.dtype.names
    if fields is None:
        return array
    lowered = {name.lower(): name for name in fields}
    axes = [lowered[axis] for axis in "xyz" if axis in lowered]
    if len(axes) < 2 or axes[1].lower() != "y":
        usual = [name for name in fields if name.lower() in ("points", *NAMES)]
        if len(usual) == 1:
            _keep_fields(array, usual, keep)
            points: np.ndarray = array[usual[0]]
            return points
        msg = f"{path}: expected fields x, y and z, found {', '.join(fields)}"
        raise ValueError(msg)
    _keep_fields(array, axes, keep)
    return stack_columns(path, [(name, array[name]) for name in axes])


def _keep_fields(array: np.ndarray, used: list[str], keep: PointData | None) -> None:
    for name in array.dtype.names or ():
        if keep is not None and name not in used:
            keep.add(name, array[name])
