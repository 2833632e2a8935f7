"""Voronoi cells within a box: what `Voronoi.clipped` returns."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, ClassVar, NamedTuple, SupportsIndex

import numpy as np
import numpy.typing as npt

from .._exact_conversion import to_float64
from .._given import as_numbers
from .._results import Names, Result, frozen
from .._topology import OUTSIDE
from .parts import run_in_parts

if TYPE_CHECKING:
    from .clipping import Sites
    from .diagram import Voronoi
    from .polytope import Polytope

FLATTEST = 2.0**-900  # a box's volume, beside that of a cube as large as its coordinates


class Cell(NamedTuple):
    """A convex polytope, in the plane a polygon.

    Attributes
    ----------
    vertices : float64 (k, d)
        Its corners; in the plane counter-clockwise.
    faces : list of lists of int
        In space the corners around each face, counter-clockwise from outside; in the plane the two ends of
        each edge.
    neighbors : int32 (f,)
        The site beyond each face, -1 where that is a wall of the box.
    """

    vertices: npt.NDArray[np.float64]
    faces: list[list[int]]
    neighbors: npt.NDArray[np.int32]


class Clipped(Result):
    """The regions of a Voronoi diagram within a box, which they fill.

    Each region is the box, cut by the bisectors between its site and those that share a ridge with it (C. H.
    Rycroft: Voro++: A three-dimensional Voronoi cell library in C++, Chaos 19, 2009). Sites may lie on the
    walls and outside of the box.

    Attributes
    ----------
    voronoi : dt3d.Voronoi
    box : float64 (2, d)
        The low and the high corner.

    Examples
    --------
    >>> import dt3d
    >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
    >>> inside = vor.clipped([[-1, -1], [3, 3]])
    >>> inside.volumes.tolist()
    [3.5, 3.5, 3.5, 3.5, 2.0]
    >>> cell = inside.cell(0)
    >>> cell.vertices.tolist()
    [[1.0, 0.0], [0.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]
    >>> cell.faces, cell.neighbors.tolist()
    ([[0, 1], [1, 2], [2, 3], [3, 4], [4, 0]], [4, 2, -1, -1, 1])
    """

    voronoi: Voronoi
    """The diagram of the whole plane, or space."""
    box: np.ndarray
    """The low and the high corner, float64 (2, d)."""

    _others: ClassVar[Names] = ("voronoi", "box")

    def __init__(self, voronoi: Voronoi, box: npt.ArrayLike | None = None) -> None:
        if box is None:
            box = np.stack([voronoi.min_bound, voronoi.max_bound])
        self._keep(voronoi=voronoi, box=_check_box(box, voronoi.ndim))

    @cached_property
    def _exponent(self) -> int:
        """Sites and box times 2 to minus this are about 1."""
        return int(np.frexp(max(np.abs(self.voronoi.points).max(), np.abs(self.box).max()))[1])

    @cached_property
    def _sites(self) -> Sites:
        from .clipping import Sites, ridges_of_sites

        vor, e = self.voronoi, self._exponent
        points, box = np.zeros((vor.npoints, 3)), np.array([[0.0] * 3, [1.0] * 3])
        points[:, : vor.ndim] = np.ldexp(vor.points, -e)
        box[:, : vor.ndim] = np.ldexp(self.box, -e)
        if np.prod(box[1] - box[0]) < FLATTEST:
            msg = (
                f"the box {self.box.tolist()} is too flat or small to be measured: its volume is less than "
                "2^-900 of that of a cube which has the sites and the box"
            )
            raise ValueError(msg)
        begin, around = ridges_of_sites(vor.ridge_points, vor.npoints)
        reach = _reaches(vor, e)
        return Sites(vor.ndim, *map(frozen, (points, reach, box, begin, around, vor.ridge_points)))

    @cached_property
    def _measured(self) -> tuple[np.ndarray, np.ndarray]:
        from .clipping import measure_cells

        sites, d = self._sites, self.voronoi.ndim
        volumes, areas = np.zeros(len(sites.points)), np.zeros(len(sites.ends))

        def work(part: int, begin: int, end: int) -> None:
            measure_cells(sites, (begin, end), volumes[begin:end], areas)

        run_in_parts(work, len(sites.points), self.voronoi.threads, sites.begin)
        with np.errstate(over="ignore", under="ignore"):
            volumes, areas = np.ldexp(volumes, d * self._exponent), np.ldexp(areas, (d - 1) * self._exponent)
        return frozen(volumes), frozen(areas)

    @property
    def volumes(self) -> np.ndarray:
        """The volume of each site's region in the box, in the plane its area, float64 (n,); 0 for duplicates.

        They sum to the volume of the box, up to rounding.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.clipped([[0, 0], [2, 2]]).volumes.tolist()
        [0.5, 0.5, 0.5, 0.5, 2.0]
        """
        return self._measured[0]

    @property
    def areas(self) -> np.ndarray:
        """The area of each ridge in the box, in the plane its length, float64 (r,).

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> vor.clipped([[0, 0], [2, 2]]).areas.round(3).tolist()
        [0.0, 1.414, 0.0, 1.414, 0.0, 1.414, 1.414, 0.0]
        """
        return self._measured[1]

    def cell(self, site: SupportsIndex) -> Cell:
        """The region of a site in the box, as a polytope; without vertices if it is empty.

        Raises
        ------
        IndexError
            If there is no such site.

        Examples
        --------
        >>> import dt3d
        >>> vor = dt3d.Voronoi([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]])
        >>> cell = vor.clipped().cell(4)
        >>> sorted(cell.vertices.tolist()), sorted(cell.neighbors.tolist())
        ([[0.0, 1.0], [1.0, 0.0], [1.0, 2.0], [2.0, 1.0]], [0, 1, 2, 3])
        """
        from .clipping import measure_cells

        k, n = site.__index__(), self.voronoi.npoints
        if not 0 <= k < n:
            msg = f"there are sites 0 to {n - 1}, got {k}"
            raise IndexError(msg)
        sites = self._sites
        polytope = measure_cells(sites, (k, k + 1), np.empty(1), np.empty(0))
        origin = np.clip(sites.points[k], *sites.box)
        at = np.ldexp(polytope.at[: polytope.size[0], :3] + origin, self._exponent)
        loops, labels = _loops(polytope)
        if self.voronoi.ndim == 2:
            loops, labels = _polygon(loops, labels)
            at = at[:, :2]
        ends = sites.ends[np.maximum(labels, 0)]
        neighbors = np.where(ends[:, 0] == k, ends[:, 1], ends[:, 0])
        neighbors[labels < 0] = OUTSIDE
        return _without_repetition(at, loops, neighbors.astype(np.int32))

    def __reduce__(self) -> tuple[Callable[..., Clipped], tuple[object, ...]]:
        """Restored from the diagram, and so computed again."""
        return type(self), (self.voronoi, self.box)

    def _refuse(self, name: str, what: str) -> None:
        if name in self._others + self._derived:
            msg = f"{name} cannot be {what}: results stay as they were computed; take a copy to change it"
            raise AttributeError(msg)

    def __repr__(self) -> str:
        """Which diagram in which box."""
        return f"<{self.voronoi!r} in {self.box.tolist()}>"


def _check_box(box: npt.ArrayLike, d: int) -> np.ndarray:
    given, name = as_numbers(box, "box", d)
    if given.shape != (2, d):
        msg = f"box must have shape (2, {d}), its low and its high corner, got {given.shape}"
        raise ValueError(msg)
    array = np.array(to_float64(given, name), order="C")
    if not np.isfinite(array).all():
        msg = f"box must be finite, got {array.tolist()}"
        raise ValueError(msg)
    if not (array[0] < array[1]).all():
        msg = (
            f"the low corner of a box must be less than its high corner in each coordinate, got "
            f"{array.tolist()}"
        )
        raise ValueError(msg)
    return array


def _reaches(vor: Voronoi, exponent: int) -> np.ndarray:
    """How far the vertices of each site's region are from it, scaled; float64 (n,), at least about."""
    tri = vor.triangulation
    reach = np.zeros(vor.npoints)
    for corners in tri.simplices.T:
        np.maximum.at(reach, corners, tri.circumradii)
    with np.errstate(under="ignore"):
        reach = np.ldexp(reach, -exponent)
    reach[tri.convex_hull] = np.inf
    return reach


def _loops(polytope: Polytope) -> tuple[list[list[int]], np.ndarray]:
    """Vertices around each face, and its label."""
    faces = polytope.faces[: polytope.size[1] + 1]
    loop = polytope.loop.tolist()
    return [loop[begin:end] for begin, end in pairwise(faces[:, 0].tolist())], faces[:-1, 1]


def _polygon(loops: list[list[int]], labels: np.ndarray) -> tuple[list[list[int]], np.ndarray]:
    """The edges of the face that is on top of a prism, and the labels of the faces beside it."""
    from .clipping import WALLS

    beside = {
        edge: label
        for loop, label in zip(loops, labels.tolist(), strict=True)
        for edge in zip(loop, loop[1:] + loop[:1], strict=True)
    }
    top = [loop for loop, label in zip(loops, labels, strict=True) if label == WALLS[5]]
    edges = [[v, w] for loop in top for v, w in zip(loop, loop[1:] + loop[:1], strict=True)]
    return edges, np.array([beside[w, v] for v, w in edges], np.int64)


def _without_repetition(at: np.ndarray, loops: list[list[int]], neighbors: np.ndarray) -> Cell:
    """Vertices that are at the same place as one, and without faces that have no area for that reason."""
    first: dict[tuple[float, ...], int] = {}
    least = at.shape[1]
    faces, kept = [], []
    for i, loop in enumerate(loops):
        places = [tuple(at[v].tolist()) for v in loop]
        own = [place for j, place in enumerate(places) if place != places[j - 1]]
        if len(own) >= least:
            faces.append([first.setdefault(place, len(first)) for place in own])
            kept.append(i)
    return Cell(np.array(list(first)).reshape(-1, least), faces, neighbors[kept])
