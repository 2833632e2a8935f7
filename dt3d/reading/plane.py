"""Triangulations in the plane, read back from files to be verified."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from .columns import as_float64
from .compressed import inner
from .meshes import CELLS, TETRAHEDRON, VOLUMES, Mesh, read_with, tetrahedra_of
from .point_data import PointData

TRIANGLE = 5
"""VTK's number for this kind of cell; the readers of other formats use VTK's numbers."""

FILLS_SPACE = [TETRAHEDRON, *VOLUMES]


@dataclass(frozen=True)
class PlaneMesh:
    """Triangles in the plane from a file.

    Attributes
    ----------
    points : float64 (n, 2)
    triangles : int (m, 3)
        As the file has them: `dt3d.threaded2d.verify` checks them before it uses them.
    point_data : mapping of str to arrays (n,) or (n, ...)
        What the file says of each point, where it was asked for.
    """

    points: np.ndarray
    triangles: np.ndarray
    point_data: Mapping[str, np.ndarray] = field(default_factory=dict)


def read_either(path: str | Path, *, point_data: bool = False) -> PlaneMesh | Mesh:
    """The triangles of a file where it holds triangles in the plane z = 0, else its tetrahedra.

    With what it says of its points, where ``point_data`` asks for that.

    Raises
    ------
    OSError, ValueError
        As `read_mesh` does, where it holds neither.
    """

    def make(path: Path, found: dict[str, np.ndarray]) -> PlaneMesh | Mesh:
        return triangles_of(path, found) or tetrahedra_of(path, found)

    if not point_data:
        return read_with(path, make)
    keep = PointData()
    return replace(read_with(path, make, keep), point_data=keep.arrays)


def read_plane_mesh(path: str | Path) -> PlaneMesh | None:
    """The triangles of a file that `write_plane_mesh` or another program wrote.

    None if it holds no triangles in the plane z = 0, or cells that fill space beside them. Reads .npz .vtu
    .vtk .msh .mesh, and each of them packed by gzip.

    Raises
    ------
    OSError, ValueError
        If the file is missing or damaged: one line that names it.
    """
    path = Path(path)
    return read_with(path, triangles_of) if inner(path).suffix.lower() in CELLS else None


def triangles_of(path: Path, found: dict[str, np.ndarray]) -> PlaneMesh | None:
    """The triangles among the arrays of a file; None if there are none in the plane."""
    if path.suffix.lower() == ".npz":
        if "triangles" not in found or "points" not in found:
            return None
        return _in_plane(path, found["points"], found["triangles"])
    if "types" not in found or "offsets" not in found:
        return None
    types, offsets = np.asarray(found["types"]), np.asarray(found["offsets"])
    chosen = types == TRIANGLE
    if np.isin(types, FILLS_SPACE).any() or not chosen.any() or len(offsets) != len(types) + 1:
        return None
    starts, ends = offsets[:-1][chosen], offsets[1:][chosen]
    if (ends - starts != 3).any() or starts.min() < 0 or ends.max() > len(found["connectivity"]):
        msg = f"{path} is damaged: a triangle has other than three points"
        raise ValueError(msg)
    return _in_plane(path, found["points"], found["connectivity"][starts[:, None] + np.arange(3)])


def _in_plane(path: Path, points: np.ndarray, triangles: np.ndarray) -> PlaneMesh | None:
    """A mesh of points (n, 2), or (n, 3) with z = 0; None for others."""
    if points.ndim == 2 and points.shape[1] == 3 and not points[:, 2].any():
        points = points[:, :2]
    if points.ndim != 2 or points.shape[1] != 2:
        return None
    return PlaneMesh(np.ascontiguousarray(as_float64(points, f"{path}: points")), triangles)
