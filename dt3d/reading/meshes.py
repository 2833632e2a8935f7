"""Triangulations read from files, to look at them and to verify them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from .._paths import by_extension, check_file
from .columns import as_float64
from .compressed import inner, unpacked
from .gmsh import read_gmsh
from .guarded import guarded
from .medit import read_medit
from .npy import read_arrays
from .point_data import PointData
from .vtk_legacy import CELL_DATA, read_legacy
from .vtk_xml import read_xml

TETRAHEDRON = 10
"""VTK's number for this kind of cell; the readers of other formats use VTK's numbers."""

VOLUMES = {
    11: "voxels", 12: "hexahedra", 13: "wedges", 14: "pyramids",
    15: "pentagonal prisms", 16: "hexagonal prisms",
    24: "quadratic tetrahedra", 25: "quadratic hexahedra", 26: "quadratic wedges", 27: "quadratic pyramids",
    29: "triquadratic hexahedra", 42: "polyhedra", 71: "Lagrange tetrahedra", 78: "Bezier tetrahedra",
}  # fmt: skip
"""Other kinds that fill space: where they are, the tetrahedra alone are not the mesh."""

ITERATION = (CELL_DATA + "iteration", CELL_DATA + "medit:ref", "iteration")
"""What the iteration of each cell is called: in files of VTK, in meshio's from Medit's, in others."""

T = TypeVar("T")

SURFACES = (".ply", ".stl", ".obj", ".off", ".vtp", ".vti", ".vts", ".vtr")


@dataclass(frozen=True)
class Mesh:
    """Tetrahedra from a file, as `read_mesh` gives them.

    Attributes
    ----------
    points : float64 (n, 3)
    simplices : int32 (m, 4)
        Numbers of points, all of them from 0 to n - 1.
    iteration : int32 (m,)
        The iteration that found each tetrahedron; 1 where the file does not say.
    point_data : mapping of str to arrays (n,) or (n, ...)
        What the file says of each point, in its types; of .vtu, .vtk, .npz and .msh.
    """

    points: np.ndarray
    simplices: np.ndarray
    iteration: np.ndarray
    point_data: Mapping[str, np.ndarray] = field(default_factory=dict)


def read_mesh(path: str | Path) -> Mesh:
    """The tetrahedra of a file that `write_mesh` or another program wrote.

    =============== ==========================================================================================
    .npz            arrays points and simplices, and iteration if there is one
    .vtu .vtk       an unstructured grid, in text or binary
    .msh .mesh      of Gmsh (2.2 and 4.1, in text or binary) and Medit (in text)
    .gz after any   the same, packed by gzip
    =============== ==========================================================================================

    Triangles, edges and vertices among the cells are not read.

    Raises
    ------
    OSError
        If the file is missing or cannot be read.
    ValueError
        If it holds no tetrahedra, or other cells that fill space; for tetrahedra that name points that are
        not there; for an unknown extension or a file that is damaged. One line that names the file.

    Examples
    --------
    >>> import tempfile, dt3d
    >>> from dt3d.files import read_mesh, write_mesh
    >>> tri = dt3d.Delaunay([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_mesh(tri, f"{folder}/mesh.npz")
    ...     mesh = read_mesh(f"{folder}/mesh.npz")
    >>> mesh.simplices.shape, mesh.points.dtype
    ((1, 4), dtype('float64'))
    """
    keep = PointData()
    return replace(read_with(path, tetrahedra_of, keep), point_data=keep.arrays)


def read_with(
    path: str | Path, make: Callable[[Path, dict[str, np.ndarray]], T], keep: PointData | None = None
) -> T:
    """What ``make(path, arrays)`` makes of the arrays of a file, by name, as its format has them.

    ``keep`` gets the data of the points.
    """
    path = Path(path)
    if inner(path).suffix.lower() in SURFACES:
        msg = f"{check_file(path)} holds no tetrahedra: files of this kind have points or surfaces only"
        raise ValueError(msg)
    reader = by_extension(inner(path), CELLS, "read a mesh from")
    check_file(path)

    def mesh_of(path: Path) -> T:
        with unpacked(path) as plain:
            return guarded(made, plain, path)

    def made(plain: Path) -> T:
        found = reader(plain, keep)
        mesh = make(plain, found)
        if keep is not None:
            keep.check(str(plain), len(found["points"]))
        return mesh

    return guarded(mesh_of, path)


def tetrahedra_of(path: Path, found: dict[str, np.ndarray]) -> Mesh:
    """The tetrahedra among the arrays of a file, checked: their numbers can be used without another look."""
    found = _named(path, found) if path.suffix.lower() == ".npz" else tetrahedra(path, found)
    points, simplices = found["points"], found["simplices"]
    if points.ndim != 2 or points.shape[1] != 3:
        msg = f"{path}: expected points of shape (n, 3), found {points.shape}"
        raise ValueError(msg)
    points = np.ascontiguousarray(as_float64(points, f"{path}: points"))
    if simplices.ndim != 2 or simplices.shape[1] != 4:
        msg = f"{path}: expected simplices of shape (m, 4), tetrahedra; found {simplices.shape}"
        raise ValueError(msg)
    if not len(simplices):
        msg = f"{path} holds no tetrahedra"
        raise ValueError(msg)
    simplices = _whole(path, "simplices", simplices)
    if wrong := np.argwhere((simplices < 0) | (simplices >= len(points))).tolist():
        row, column = wrong[0]
        msg = (
            f"{path}: tetrahedron {row} names point {simplices[row, column]}, "
            f"and there are points 0 to {len(points) - 1} only"
        )
        raise ValueError(msg)
    iteration = found.get("iteration")
    iteration = np.ones(len(simplices)) if iteration is None else iteration
    iteration = _whole(path, "iteration", iteration)
    if iteration.shape != (len(simplices),):
        n = len(simplices)
        msg = f"{path}: expected one iteration per tetrahedron, {n}; found shape {iteration.shape}"
        raise ValueError(msg)
    if (np.abs(iteration) >= 2**31).any():
        msg = f"{path}: iterations must be less than 2^31"
        raise ValueError(msg)
    return Mesh(points, simplices.astype(np.int32), iteration.astype(np.int32))


def _whole(path: Path, what: str, array: np.ndarray) -> np.ndarray:
    """The array as int64, if all its numbers are whole and fit."""
    if array.dtype.kind in "iu" and (array.dtype.itemsize < 8 or array.dtype.kind == "i"):
        return array.astype(np.int64)
    if array.dtype.kind in "fu":
        with np.errstate(invalid="ignore"):
            fits = (array >= -(2.0**62)) & (array <= 2.0**62) & (np.floor(array) == array)
        if fits.all():
            return array.astype(np.int64)
        where = np.argwhere(~fits)[0]
        msg = f"{path}: {what} should be whole numbers, found {array[tuple(where)]} in row {where[0]}"
        raise ValueError(msg)
    msg = f"{path}: {what} should be whole numbers, found {array.dtype}"
    raise ValueError(msg)


def _named(path: Path, found: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The arrays of an .npz, if those that a mesh needs are there."""
    if missing := {"points", "simplices"} - found.keys():
        msg = f"{path} holds no mesh: there is no array {' and none '.join(sorted(missing))}"
        raise ValueError(msg)
    return found


def tetrahedra(path: Path, found: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The tetrahedra among cells of several kinds.

    Parameters
    ----------
    path : Path
        What messages call the file.
    found : dict
        "points"; "types" (m,), VTK's numbers; "offsets" (m + 1,) into "connectivity"; perhaps "iteration", in
        files of VTK as data of cells.

    Raises
    ------
    ValueError
        If the arrays contradict each other, there are none, or there are other cells that fill space.
    """
    if "types" not in found or "offsets" not in found:
        msg = f"{path} holds no tetrahedra: it is no unstructured grid with cells"
        raise ValueError(msg)
    types = found["types"]
    offsets = _whole(path, "offsets", found["offsets"])
    sizes = np.diff(offsets)
    if len(offsets) != len(types) + 1 or offsets[0] != 0 or (sizes < 0).any():
        msg = f"{path} is damaged: its {len(types)} types of cells do not go with {len(offsets)} offsets"
        raise ValueError(msg)
    if offsets[-1] != len(found["connectivity"]):
        msg = f"{path} is damaged: cells end at {offsets[-1]} of {len(found['connectivity'])} numbers"
        raise ValueError(msg)
    chosen = types == TETRAHEDRON
    others = {kind: VOLUMES[kind] for kind in np.unique(types).tolist() if kind in VOLUMES}
    if others:
        names = ", ".join(f"{np.count_nonzero(types == kind)} {name}" for kind, name in others.items())
        msg = f"{path} holds {names} beside {np.count_nonzero(chosen)} tetrahedra; expected tetrahedra only"
        raise ValueError(msg)
    if not chosen.any():
        msg = f"{path} holds no tetrahedra"
        raise ValueError(msg)
    if (sizes[chosen] != 4).any():
        msg = f"{path} is damaged: a tetrahedron has {sizes[chosen][sizes[chosen] != 4][0]} points"
        raise ValueError(msg)
    simplices = found["connectivity"][offsets[:-1][chosen, None] + np.arange(4)]
    mesh = {"points": found["points"], "simplices": simplices}
    iteration = next((found[name] for name in ITERATION if name in found), None)
    if iteration is not None:
        mesh["iteration"] = iteration[chosen] if len(iteration) == len(types) else iteration
    return mesh


CELLS: dict[str, Callable[[Path, PointData | None], dict[str, np.ndarray]]] = {
    ".npz": lambda path, keep: read_arrays(path, ["points", "simplices", "iteration", "triangles"], keep),
    ".vtu": read_xml,
    ".vtk": read_legacy,
    ".msh": read_gmsh,
    ".mesh": lambda path, _: read_medit(path),
}
"""The readers of meshes by extension: each gives the arrays of a file by name, and what it says of each point
to a `PointData`, if there is one."""
