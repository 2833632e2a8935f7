"""What can be wrong with a set, as bits that a compiled program can look at."""

from __future__ import annotations

from enum import IntFlag


class Status(IntFlag):
    """Why a set has no simplices; `Mesh.status` is 0 where all is well.

    Examples
    --------
    >>> from dt3d.jax import Status
    >>> Status(5)
    <Status.OVERFLOW|DEGENERATE: 5>
    """

    OVERFLOW = 1
    """There are more simplices than the capacity; `Mesh.count` says how many."""
    NOT_FINITE = 2
    """A coordinate is NaN or infinite."""
    DEGENERATE = 4
    """The sites lie on a plane, a line or a point; in the plane on a line or a point."""
