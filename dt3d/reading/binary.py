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
from .stl import read_stl
from .vtk_legacy import read_legacy
from .vtk_xml import read_xml


def _points_of(read: Callable[[Path], dict[str, np.ndarray]]) -> Callable[[Path], np.ndarray]:
    return lambda path: read(path)["points"]


BINARY_READERS: dict[str, Callable[[Path], np.ndarray]] = {
    ".npy": read_npy,
    ".npz": read_npz,
    ".ply": read_ply,
    ".pcd": read_pcd,
    **dict.fromkeys([".las", ".laz"], read_las),
    ".vtk": _points_of(read_legacy),
    **dict.fromkeys([".vtu", ".vtp", ".vti", ".vts", ".vtr", ".vtm"], _points_of(read_xml)),
    ".stl": read_stl,
    ".msh": read_gmsh_points,
    ".mesh": _points_of(read_medit),
}
"""A reader for each extension: takes a Path, gives an array of numbers (n, k)."""
