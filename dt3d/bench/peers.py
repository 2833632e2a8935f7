"""The libraries that are compared: how each is called, with nothing in the time but the triangulation.

Each gets the points in the form that it takes them in, made beforehand, and what it finds is counted
afterwards. None of them but dt3d is needed: those that are not installed are left out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import pyvista
    import scipy.spatial

    from ..delaunay import Delaunay

from .._numba.cores import available_cores

T = TypeVar("T")  # what a library takes
R = TypeVar("R")  # and what it makes of that


def _simplices_of(result: Delaunay | scipy.spatial.Delaunay) -> np.ndarray:
    return np.asarray(result.simplices)


@dataclass(frozen=True)
class Calls(Generic[T, R]):
    """A library that is loaded.

    ``prepare(points)`` makes what ``triangulate`` takes; ``simplices`` gets int (m, 4) from its result, the
    vertices of a tetrahedron in any order, or is None where they cannot be had in reasonable time; ``count``
    gets m.
    """

    triangulate: Callable[[T], R]
    simplices: Callable[[R], np.ndarray] | None
    prepare: Callable[[np.ndarray], T]
    count: Callable[[R], int] | None = None

    def tetrahedra(self, result: R) -> int:
        """How many a result has."""
        if self.count is not None:
            return self.count(result)
        assert self.simplices is not None
        return len(self.simplices(result))


def _dt3d(threads: int | None) -> Calls[Any, Any]:
    from ..delaunay import Delaunay

    return Calls(lambda points: Delaunay(points, threads=threads), _simplices_of, np.asarray)


def _scipy(threads: int | None) -> Calls[Any, Any]:
    from scipy.spatial import Delaunay

    return Calls(Delaunay, _simplices_of, np.asarray)


def _vtk(threads: int | None) -> Calls[Any, Any]:
    import pyvista

    def triangulate(cloud: pyvista.PolyData) -> pyvista.UnstructuredGrid:
        made: pyvista.UnstructuredGrid = cloud.delaunay_3d(progress_bar=False)
        return made

    def simplices(grid: pyvista.UnstructuredGrid) -> np.ndarray:
        tetrahedra = grid.cells_dict.get(np.uint8(pyvista.CellType.TETRA))
        return np.empty((0, 4), np.int64) if tetrahedra is None else np.asarray(tetrahedra)

    return Calls(triangulate, simplices, pyvista.PolyData)


def _tetgen(threads: int | None) -> Calls[Any, Any]:
    import tetgen

    anything = np.array([[0, 1, 2]], np.int32)  # it asks for facets, and does not look at them

    def triangulate(points: np.ndarray) -> Any:
        made = tetgen.TetGen(points, anything)
        made.tetrahedralize(switches="fzQ")  # its Python part crashes if there are no facets to read
        return made

    return Calls(triangulate, lambda made: np.asarray(made.elem), np.asarray)


def _gmsh(threads: int | None) -> Calls[Any, Any]:
    import gmsh

    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", threads or available_cores())

    def triangulate(flat: np.ndarray) -> Any:
        return gmsh.algorithm.tetrahedralize(flat)[0]

    def simplices(numbers: npt.ArrayLike) -> np.ndarray:
        return np.asarray(numbers, np.int64).reshape(-1, 4) - 1

    return Calls(triangulate, simplices, np.ravel)


def _cgal(threads: int | None) -> Calls[Any, Any]:
    from CGAL.CGAL_Kernel import Point_3
    from CGAL.CGAL_Triangulation_3 import Delaunay_triangulation_3

    def prepare(points: np.ndarray) -> list[Any]:
        return [Point_3(x, y, z) for x, y, z in points.tolist()]

    return Calls(Delaunay_triangulation_3, None, prepare, lambda made: made.number_of_finite_cells())


@dataclass(frozen=True)
class Peer:
    """A library by its name, the module that it is installed as, and how it is loaded."""

    name: str
    module: str
    load: Callable[[int | None], Calls[Any, Any]]

    @property
    def installed(self) -> bool:
        """Whether it is here."""
        return find_spec(self.module) is not None


PEERS = {
    peer.name: peer
    for peer in (
        Peer("dt3d", "dt3d", _dt3d),
        Peer("scipy", "scipy", _scipy),
        Peer("vtk", "pyvista", _vtk),
        Peer("tetgen", "tetgen", _tetgen),
        Peer("gmsh", "gmsh", _gmsh),
        Peer("cgal", "CGAL", _cgal),
    )
}
