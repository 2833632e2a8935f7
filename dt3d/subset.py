"""A part of a triangulation: some of its simplices, as for meshes with holes and alpha shapes."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import numpy.typing as npt

from ._geometry import Geometry
from ._input import check_queries
from ._results import Names, frozen
from ._topology import OUTSIDE
from ._triangulation import PER_SIMPLEX, PER_SITE

if TYPE_CHECKING:
    from .delaunay import Delaunay


class Subset(Geometry):
    """Some of the simplices of a triangulation, as `dt3d.Delaunay.subset` makes it.

    Read-only, as the triangulation. It need be neither convex nor connected. Sites keep their numbers, those
    that no simplex uses included.

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

    whole: Delaunay
    """The triangulation whose part this is."""
    kept: np.ndarray
    """The row in the whole's simplices of each of these, int32 (k,)."""

    _others: ClassVar[Names] = ("whole", "kept")

    def __init__(self, whole: Delaunay, keep: npt.ArrayLike) -> None:
        kept = check_keep(keep, len(whole.simplices))
        self._keep(whole=whole, kept=kept)
        d = whole.ndim
        self._keep(
            points=whole.points,
            simplices=whole.simplices[kept],
            # OUTSIDE leads to the last entry
            neighbors=self._number[whole.neighbors[kept]],
            duplicates=whole.duplicates,
            **{name: getattr(whole, name)[kept] for name in PER_SIMPLEX[d]},
            **{name: getattr(whole, name) for name in PER_SITE[d]},
        )

    @cached_property
    def _number(self) -> np.ndarray:
        """The row here of each simplex of the whole, and of OUTSIDE at the end: int32 (m + 1,)."""
        number = np.full(len(self.whole.simplices) + 1, OUTSIDE, np.int32)
        number[self.kept] = np.arange(len(self.kept), dtype=np.int32)
        return frozen(number)

    @cached_property
    def boundary(self) -> np.ndarray:
        """Facets with no neighbour, int32 (b, d), oriented outwards as `dt3d.Delaunay.convex_hull`.

        Those of the hull, and those towards what was not kept.

        Examples
        --------
        >>> import dt3d
        >>> dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]]).subset([0]).boundary.shape
        (3, 2)
        """
        return self._border()

    def find_simplex(self, xi: npt.ArrayLike) -> np.ndarray:
        """The simplex of this part that contains each point, exactly, as `dt3d.Delaunay.find_simplex`.

        `dt3d.OUTSIDE` (-1) where there is none: outside the hull, in holes, and for points that are not
        finite. Borders belong to the part.

        Parameters
        ----------
        xi : array_like, real (..., d)
            The points.

        Raises
        ------
        ValueError
            If the points are not real and of shape (..., d).

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> part = tri.subset(tri.find_simplex([[0.5, 0.5]]))
        >>> part.find_simplex([[0.5, 0.5], [1, 1], [2, 2]]).tolist()
        [0, 0, -1]
        """
        points, shape = check_queries(xi, self.ndim)
        locator = self.whole._locator
        found = locator.find_checked(points)
        out: np.ndarray = self._number[found]
        # what contains these is not kept; if they lie on its border, something beside it may be
        rest = np.flatnonzero((out == OUTSIDE) & (found != OUTSIDE))
        if len(rest):
            beside = locator.find_kept(points[rest], found[rest], self._number[:-1] != OUTSIDE)
            out[rest] = self._number[beside]
        return out.reshape(shape)

    def subset(self, keep: npt.ArrayLike) -> Subset:
        """A part of this part.

        Parameters
        ----------
        keep : bool (k,), or int (l,)
            A mask of the simplices of this part, or their rows. `kept` of the result has rows of the whole.

        Examples
        --------
        >>> import dt3d
        >>> tri = dt3d.Delaunay([[0, 0], [2, 0], [0, 2], [3, 3]])
        >>> part = tri.subset([1, 0])
        >>> part.subset([0]).kept.tolist()
        [1]
        """
        return Subset(self.whole, self.kept[check_keep(keep, len(self.kept))])

    def __reduce__(self) -> tuple[Callable[..., Subset], tuple[object, ...]]:
        """Restored from the whole, and so checked again."""
        return Subset, (self.whole, self.kept)

    def __repr__(self) -> str:
        """How many simplices of which triangulation."""
        return f"<{len(self.simplices)} of {len(self.whole.simplices)} simplices of {self.whole!r}>"


def check_keep(keep: npt.ArrayLike, m: int) -> np.ndarray:
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
