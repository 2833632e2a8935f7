"""A part of a triangulation: some of its simplices, as for meshes with holes and alpha shapes."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from . import _topology
from ._input import check_queries
from ._results import Names, Result, frozen
from ._topology import OUTSIDE

if TYPE_CHECKING:
    import pyvista


class Subset(Result):
    """Some of the tetrahedra of a triangulation, as `dt3d.Delaunay.subset` makes it.

    Read-only, as the triangulation. It need be neither convex nor connected. Sites keep their numbers, those
    that no tetrahedron uses included.

    Examples
    --------
    >>> import numpy as np, dt3d
    >>> tri = dt3d.Delaunay(np.random.default_rng(0).random((200, 3)))
    >>> corners = tri.points[tri.simplices]
    >>> longest = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=-1).max(axis=(1, 2))
    >>> part = tri.subset(longest < 0.5)
    >>> part.find_simplex([0.5, 0.5, 0.5]) >= 0, part.find_simplex([9, 9, 9]) == dt3d.OUTSIDE
    (np.True_, np.True_)
    """

    whole: Any
    """The triangulation whose part this is."""
    kept: np.ndarray
    """The row in the whole's simplices of each of these, int32 (k,)."""
    points: np.ndarray
    """All sites of the whole, float64 (n, d)."""
    simplices: np.ndarray
    """Those that were kept, int32 (k, d + 1)."""
    neighbors: np.ndarray
    """Rows of `simplices`; `dt3d.OUTSIDE` (-1) at the border, where the neighbour was not kept, too."""
    iteration: np.ndarray
    """The iteration that found each, int32 (k,)."""
    duplicates: np.ndarray
    """Those of the whole, int32 (., 2)."""

    _arrays: ClassVar[Names] = ("kept", "points", "simplices", "neighbors", "iteration", "duplicates")
    _others: ClassVar[Names] = ("whole",)
    _derived: ClassVar[Names] = ("boundary", "_number")

    def __init__(self, whole: Any, keep: Any) -> None:
        kept = check_keep(keep, len(whole.simplices))
        self._keep(whole=whole, kept=kept)
        self._keep(
            points=whole.points,
            simplices=whole.simplices[kept],
            # OUTSIDE leads to the last entry
            neighbors=self._number[whole.neighbors[kept]],
            duplicates=whole.duplicates,
            **self._carried(whole, kept),
        )

    @staticmethod
    def _carried(whole: Any, kept: np.ndarray) -> dict[str, np.ndarray]:
        """What the simplices have beside their vertices."""
        return {"iteration": whole.iteration[kept]}

    @cached_property
    def _number(self) -> np.ndarray:
        """The row here of each simplex of the whole, and of OUTSIDE at the end: int32 (m + 1,)."""
        number = np.full(len(self.whole.simplices) + 1, OUTSIDE, np.int32)
        number[self.kept] = np.arange(len(self.kept), dtype=np.int32)
        return frozen(number)

    @cached_property
    def boundary(self) -> np.ndarray:
        """Facets with no neighbour, int32 (b, 3), oriented outwards.

        Those of the hull, and those towards what was not kept.
        """
        return frozen(_topology.hull_facets(self.simplices, self.neighbors))

    def find_simplex(self, xi: Any) -> np.ndarray:
        """The simplex of this part that contains each point, exactly, as `dt3d.Delaunay.find_simplex`.

        `dt3d.OUTSIDE` (-1) where there is none: outside the hull, and in holes. Borders belong to the part.

        Raises
        ------
        ValueError
            If the points are not finite, real and of shape (..., d).
        """
        points, shape = check_queries(xi, self.points.shape[1])
        locator = self.whole._locator
        found = locator.find_checked(points)
        found[found < 0] = OUTSIDE
        out = self._number[found]
        # what contains these is not kept; if they lie on its border, something beside it may be
        rest = np.flatnonzero((out == OUTSIDE) & (found != OUTSIDE))
        if len(rest):
            beside = locator.find_kept(points[rest], found[rest], self._number[:-1] != OUTSIDE)
            out[rest] = self._number[beside]
        return out.reshape(shape)

    def subset(self, keep: Any) -> Self:
        """A part of this part: keep says which of its simplices; `kept` of the result are the whole's."""
        return type(self)(self.whole, self.kept[check_keep(keep, len(self.kept))])

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """The tetrahedra as a PyVista grid with cell data "iteration" and "volume".

        Raises ImportError, saying what to install, where PyVista is missing.
        """
        from ._mesh import to_pyvista

        return to_pyvista(self)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.whole, self.kept)  # and so checked again

    def __repr__(self) -> str:
        return f"<{len(self.simplices)} of {len(self.whole.simplices)} simplices of {self.whole!r}>"


def check_keep(keep: Any, m: int) -> np.ndarray:
    """The rows that a mask, bool (m,), or rows, integers (k,) without repetition, choose of m: int32 (k,).

    Raises
    ------
    ValueError
        If it is neither.
    """
    given = np.asarray(keep)
    if given.dtype == bool:
        if given.shape != (m,):
            msg = f"keep must be a mask of shape ({m},), one value for each simplex, got shape {given.shape}"
            raise ValueError(msg)
        return np.flatnonzero(given).astype(np.int32)
    if given.ndim != 1 or (given.size and given.dtype.kind not in "iu"):
        msg = (
            f"keep must be a mask, bool of shape ({m},), or rows of simplices, integers of shape (k,); got "
            f"dtype {given.dtype}, shape {given.shape}"
        )
        raise ValueError(msg)
    if given.size and (given.min() < 0 or given.max() >= m):
        bad = int(given[(given < 0) | (given >= m)][0])
        msg = f"keep names simplex {bad}, but there are simplices 0 to {m - 1}"
        raise ValueError(msg)
    rows = given.astype(np.int32)
    if len(np.unique(rows)) < len(rows):
        twice = int(np.argmax(np.bincount(rows)))
        msg = f"keep names simplex {twice} more than once; pass np.unique(keep)"
        raise ValueError(msg)
    return rows
