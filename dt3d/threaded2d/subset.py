"""A part of a triangulation of the plane: some of its triangles."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from .. import subset as in_space
from .._results import Names, frozen

if TYPE_CHECKING:
    import pyvista


class Subset(in_space.Subset):
    """Some of the triangles of a triangulation, as `dt3d.threaded2d.Delaunay.subset` makes it.

    Read-only, as the triangulation. It need be neither convex nor connected. Sites keep their numbers, those
    that no triangle uses included.
    """

    thread: np.ndarray
    """The thread that made each, int16 (k,)."""
    inserted_by: np.ndarray
    """That of the whole, int16 (n,)."""

    _arrays: ClassVar[Names] = (
        "kept", "points", "simplices", "neighbors", "thread", "inserted_by", "duplicates"
    )  # fmt: skip
    _derived: ClassVar[Names] = ("triangles", "boundary", "_number")

    @staticmethod
    def _carried(whole: Any, kept: np.ndarray) -> dict[str, np.ndarray]:
        return {"thread": whole.thread[kept], "inserted_by": whole.inserted_by}

    @property
    def triangles(self) -> np.ndarray:
        """The same as `simplices`."""
        return self.simplices

    @cached_property
    def boundary(self) -> np.ndarray:
        """Edges with no neighbour, int32 (b, 2), counter-clockwise about the triangles.

        Those of the hull, and those towards what was not kept.
        """
        return border(self.simplices, self.neighbors)

    def to_pyvista(self) -> pyvista.PolyData:
        """The triangles as a PyVista surface with cell data "thread".

        Raises ImportError, saying what to install, where PyVista is missing.
        """
        from .picture import to_pyvista

        return to_pyvista(self)

    def plot(self, ax: Any = None, **options: Any) -> Any:
        """Draw the triangles, coloured by the threads that made them; see `picture.plot`."""
        from .picture import plot

        return plot(self, ax, **options)


def border(triangles: np.ndarray, neighbors: np.ndarray) -> np.ndarray:
    """Edges with no neighbour, int32 (b, 2), counter-clockwise about the triangles; read-only."""
    t, k = np.nonzero(neighbors < 0)
    return frozen(np.column_stack([triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]]))
