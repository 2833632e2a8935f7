"""The readers of points in formats that are not columns of text."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from .gmsh import read_gmsh_points
from .las import read_las
from .medit import read_medit
from .npy import read_npy, read_npz
from .pcd import read_pcd
from .ply import read_ply
from .point_data import PointData
from .stl import read_stl
from .vtk_legacy import read_legacy
from .vtk_xml import read_xml


def _points_of(
    read: Callable[[Path, PointData | None], dict[str, np.ndarray]],
) -> Callable[[Path, PointData | None], np.ndarray]:
    return lambda path, keep: read(path, keep)["points"]


BINARY_READERS: dict[str, Callable[[Path, PointData | None], np.ndarray]] = {
    ".npy": read_npy,
    ".npz": read_npz,
    ".ply": read_ply,
    ".pcd": read_pcd,
    **dict.fromkeys([".las", ".laz"], read_las),
    ".vtk": _points_of(read_legacy),
    **dict.fromkeys([".vtu", ".vtp", ".vti", ".vts", ".vtr", ".vtm"], _points_of(read_xml)),
    ".stl": lambda path, _: read_stl(path),
    ".msh": read_gmsh_points,
    ".mesh": lambda path, _: read_medit(path)["points"],
}
"""A reader for each extension: takes a Path, gives an array of numbers (n, k), and what it says of each point
to a `PointData`, if there is one."""
