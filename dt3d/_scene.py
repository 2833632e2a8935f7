"""What is shown of a triangulation in pictures, windows and pages: which simplices, which of their faces.

Only faces on the border of what is shown are drawn: the hull, the cut, and what peeling has laid bare. So a
million tetrahedra are some ten thousand triangles, and nothing that can be seen is missing.

Where hardly anything of the hull belongs to the set, as for points on surfaces and in clusters, its long
tetrahedra hide all. So by default `longest` is five medians of the longest edges if tetrahedra with a longer
one fill more than half of the hull; nothing is cut then. Their share of the volume is 1 % for points that
fill a box, 25 % for normal ones, 43 % for a protein; 72 % and more for a terrain, clusters, a sphere, a scan.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ._cell_data import Simplices, cell_data, neighbors_of, varies
from ._topology import OUTSIDE, OUTWARD
from .plot import CUT, View, camera

if TYPE_CHECKING:
    from ._mesh import Tetrahedra

MEDIANS = 5.0  # what is longer is peeled where it fills more than
MOST_EMPTY = 0.5  # of the volume
ORDER = ("depth", "longest_edge", "volume", "area", "circumradius", "iteration", "thread")
FROM_ABOVE = View(azimuth=-90.0, elevation=90.0)  # x to the right, y up


@dataclass(frozen=True)
class Choice:
    """What of a scene is shown; None leaves it to the scene.

    Attributes
    ----------
    scalars : str, optional
        The cell data, or the point data, that colours show; "depth" by default where it varies.
    longest : float, optional
        Simplices with a longer edge are left out; `numpy.inf` leaves out none.
    cut : float, optional
        How much is cut away on the side of the eye, from 0 to 1, as a share of the set's extent there.
    upto : int, optional
        Only what was found up to this iteration.
    azimuth, elevation : float, optional
        Where the eye is, in degrees about the z axis and above the xy plane.
    """

    scalars: str | None = None
    longest: float | None = None
    cut: float | None = None
    upto: int | None = None
    azimuth: float | None = None
    elevation: float | None = None


@dataclass(frozen=True)
class _Cells:
    """What cell data are computed from."""

    points: np.ndarray
    simplices: np.ndarray
    neighbors: np.ndarray
    iteration: np.ndarray


class Scene:
    """Simplices with their data, and what is shown of them.

    Parameters
    ----------
    tri : Delaunay, Subset, Mesh, or anything with their points and simplices
        In the plane z is 0.

    Attributes
    ----------
    points : float64 (n, 3)
        Moved and scaled into the unit ball: graphics are in single precision, which an offset would use up.
    simplices, neighbors : int (m, d + 1)
    data : dict
        Cell data by name, as `cell_data` has them, first what colours show by default.
    point_data : dict
        Data of the points by name, (n,): numbers, and the lengths of vectors. A name that cell data have,
        too, gets " of points" behind it.
    """

    def __init__(self, tri: Tetrahedra | Simplices) -> None:
        points = np.asarray(tri.points, np.float64)
        simplices = np.asarray(tri.simplices)
        if not len(simplices):
            msg = "there is nothing to show: no simplices"
            raise ValueError(msg)
        self.plane = points.shape[1] == 2
        neighbors = getattr(tri, "neighbors", None)
        self.neighbors = neighbors_of(simplices) if neighbors is None else np.asarray(neighbors)
        iteration = np.ones(len(simplices), np.int32)
        if not self.plane:
            iteration = np.asarray(getattr(tri, "iteration", iteration))
        found = cell_data(_Cells(points, simplices, self.neighbors, iteration))
        self.data = {name: found[name] for name in ORDER if name in found}
        self.point_data = _scalars(getattr(tri, "point_data", {}), len(points), self.data)
        self.points = _in_ball(
            np.column_stack([points, np.zeros(len(points))]) if self.plane else points, simplices
        )
        self.simplices = simplices
        self.middles = self.points[simplices].mean(axis=1)

    @property
    def names(self) -> list[str]:
        """What colours can show: the data of cells and of points that vary."""
        every = {**self.data, **self.point_data}
        return [name for name, values in every.items() if varies(values)]

    def values(self, name: str) -> np.ndarray:
        """The data of a name, (m,) of simplices or (n,) of points."""
        return self.data[name] if name in self.data else self.point_data[name]

    @property
    def last(self) -> int:
        """The last iteration; 1 where iterations mean nothing, as by insertion."""
        return int(self.data["iteration"].max()) if "iteration" in self.data else 1

    def chosen(self, choice: Choice) -> Choice:
        """The choice without None, but for `upto`, which stays None where all is shown.

        Raises
        ------
        ValueError
            If there are no such data, a number is out of range, or nothing would be left.
        """
        varied = [name for name, values in self.data.items() if varies(values)]
        scalars = choice.scalars or (varied or list(self.data))[0]
        if scalars not in self.data and scalars not in self.point_data:
            known = ", ".join([*self.data, *self.point_data])
            msg = f"scalars must be one of {known}, got {scalars!r}"
            if scalars == "iteration":
                msg += "; by insertion there are no iterations"
            raise ValueError(msg)
        usual = self.usual_longest()
        longest = usual if choice.longest is None else choice.longest
        cut = choice.cut
        if cut is None:
            cut = 0.0 if self.plane or (choice.longest is None and np.isfinite(usual)) else 0.5
        if not 0 <= cut <= 1:
            msg = f"cut must be from 0, nothing, to 1, all of the extent, got {cut!r}"
            raise ValueError(msg)
        edges = self.data["longest_edge"]
        if not (edges <= longest).any():
            msg = (
                f"longest={longest!r} leaves nothing: the longest edges are {edges.min():.6g} at least, "
                f"{np.median(edges):.6g} in the median, and {edges.max():.6g} at most"
            )
            raise ValueError(msg)
        view = FROM_ABOVE if self.plane else View()
        azimuth = view.azimuth if choice.azimuth is None else choice.azimuth
        elevation = view.elevation if choice.elevation is None else choice.elevation
        if not (np.isfinite(azimuth) and np.isfinite(elevation)):
            msg = f"azimuth and elevation must be finite, in degrees, got {azimuth!r} and {elevation!r}"
            raise ValueError(msg)
        return replace(
            choice, scalars=scalars, longest=longest, cut=cut, azimuth=azimuth, elevation=elevation
        )

    def usual_longest(self) -> float:
        """The longest edge that is shown by default, infinite where nothing is peeled."""
        edges = self.data["longest_edge"]
        size = np.abs(self.data["area" if self.plane else "volume"])  # meshes of others may be turned
        bound = MEDIANS * float(np.median(edges))
        return bound if size[edges > bound].sum() > MOST_EMPTY * size.sum() else np.inf

    def shown(self, choice: Choice) -> np.ndarray:
        """Which simplices a choice from `chosen` shows, bool (m,); the cut follows the eye of the choice."""
        kept: np.ndarray = self.data["longest_edge"] <= choice.longest
        if choice.upto is not None and "iteration" in self.data:
            kept &= self.data["iteration"] <= choice.upto
        if choice.cut and kept.any():
            along = self.middles @ cut_direction(choice)
            low, high = along[kept].min(), along[kept].max()
            kept &= along <= high - choice.cut * (high - low)
        return kept

    def faces(self, shown: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The triangles that are drawn, int (f, 3), counter-clockwise from outside, and whose they are."""
        if self.plane:
            rows = np.flatnonzero(shown)
            return self.simplices[rows], rows
        rows = np.flatnonzero(shown)
        beside = self.neighbors[rows]
        row, k = np.nonzero((beside == OUTSIDE) | ~shown[beside])
        return self.simplices[rows[row][:, None], OUTWARD[k]], rows[row]


def _scalars(
    point_data: Mapping[str, np.ndarray], n: int, taken: Mapping[str, object]
) -> dict[str, np.ndarray]:
    """A number for each point, of those data that are numbers."""
    found = {}
    for name, values in point_data.items():
        values = np.asarray(values)
        if values.dtype.kind not in "biuf" or values.shape[:1] != (n,) or not values.size:
            continue
        if values.dtype.kind == "b":
            values = values.astype(np.uint8)
        if values.ndim > 1:
            values = np.linalg.norm(values.reshape(n, -1).astype(np.float64), axis=1)
        found[f"{name} of points" if name in taken else name] = values
    return found


def _in_ball(points: np.ndarray, simplices: np.ndarray) -> np.ndarray:
    """The points, those that simplices use in the unit ball."""
    used = points[np.unique(simplices)]
    middle = used.min(axis=0) / 2 + used.max(axis=0) / 2  # the sum may be too large for float64
    radius = np.hypot.reduce(used - middle, axis=1).max()
    placed: np.ndarray = (points - middle) / (radius or 1.0)
    return placed


def eye(choice: Choice) -> np.ndarray:
    """The directions of a choice's eye, float64 (3, 3): rows to the right, up, and towards the eye."""
    assert choice.azimuth is not None
    assert choice.elevation is not None
    return camera(View(azimuth=choice.azimuth, elevation=choice.elevation))


def cut_direction(choice: Choice) -> np.ndarray:
    """The unit normal of the cut, which faces the eye from a little to the right, float64 (3,)."""
    normal = CUT @ eye(choice)
    return np.asarray(normal / np.linalg.norm(normal))


def is_wide(values: np.ndarray) -> bool:
    """Whether colours show logarithms: values are positive, and the ends of the colours differ fivefold."""
    if values.dtype.kind in "iu" or not (values > 0).all():
        return False
    low, high = color_range(values)
    return high > 5 * low


def color_range(values: np.ndarray) -> tuple[float, float]:
    """What the ends of the colours stand for: of numbers of which there are many the middle 98 %."""
    values = values[np.isfinite(values)] if values.dtype.kind == "f" else values
    if not len(values):
        return 0.0, 1.0
    low, high = values.min(), values.max()
    if values.dtype.kind == "f" and len(values) >= 100:
        inner = np.quantile(values, [0.01, 0.99])
        low, high = inner if inner[0] < inner[1] else (low, high)
    return float(low), float(high)


def title_of(name: str) -> str:
    """The name of data, above their colours."""
    return name.replace("_", " ")


def explained(name: str) -> str:
    """What data are, in a line."""
    return {
        "depth": "depth: how many facets lie between a simplex and the hull",
        "iteration": "iteration: the round that found a tetrahedron",
        "longest_edge": "longest edge: of each simplex",
        "circumradius": "circumradius: the radius of the circumscribed sphere",
        "volume": "volume: of each tetrahedron",
        "area": "area: of each triangle",
        "thread": "thread: which one made a triangle",
    }.get(name, f"{title_of(name)}: of each point, and along faces between")
