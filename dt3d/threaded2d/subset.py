"""A part of a triangulation of the plane: some of its triangles."""

from __future__ import annotations

from typing import ClassVar

from .._results import Names
from .._triangulation import InPlane, Part


class Subset(Part, InPlane):
    """Some of the triangles of a triangulation, as `dt3d.threaded2d.Delaunay.subset` makes it.

    Read-only, as the triangulation. It need be neither convex nor connected. Sites keep their numbers, those
    that no triangle uses included.
    """

    _derived: ClassVar[Names] = (*Part._derived, "triangles")
