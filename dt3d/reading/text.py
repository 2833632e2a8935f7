"""The readers of points in formats that are text, by extension."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from .point_data import PointData
from .text_cif import read_cif
from .text_columns import read_columns, read_leading_columns
from .text_lammps import read_lammps
from .text_node import read_node
from .text_obj import read_obj
from .text_off import read_off
from .text_pdb import read_pdb
from .text_pts import read_pts
from .text_xyz import read_xyz

TEXT_READERS: dict[str, Callable[[Path, PointData | None], np.ndarray]] = {
    **dict.fromkeys([".csv", ".tsv", ".txt", ".dat"], read_columns),
    ".asc": read_leading_columns,
    ".xyz": read_xyz,
    ".pts": read_pts,
    ".pdb": lambda path, _: read_pdb(path),
    **dict.fromkeys([".cif", ".mmcif"], lambda path, _: read_cif(path)),
    **dict.fromkeys([".dump", ".lammpstrj"], read_lammps),
    ".obj": lambda path, _: read_obj(path),
    ".off": lambda path, _: read_off(path),
    ".node": lambda path, _: read_node(path),
}
"""A reader for each extension: takes a Path, gives an array of numbers (n, k), and what it says of each point
to a `PointData`, if there is one."""
