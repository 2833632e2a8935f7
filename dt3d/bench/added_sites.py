"""Sites added to a triangulation, beside all of them from scratch."""

from __future__ import annotations

import numpy as np

from ..delaunay import Delaunay
from .pairs import Pair, in_turn

ONE_BY_ONE = 1000  # calls, of which each adds a site; their time is divided by their number


def pairs(rounds: int, quick: bool) -> list[Pair]:
    """Sites of the unit cube added to others, many at once and one by one, ``rounds`` times each.

    The arrays are made when they are asked for; that is a pair of its own. From scratch they are always made.
    """
    rng = np.random.default_rng(0)
    there, more = (2000, 50) if quick else (1_000_000, 10_000)
    tri = Delaunay(rng.random((there, 3)), incremental=True)

    def many() -> None:
        tri.add_points(rng.random((more, 3)))

    def many_with_arrays() -> None:
        many()
        tri.simplices, tri.neighbors  # noqa: B018

    def one_by_one() -> None:
        for site in rng.random((ONE_BY_ONE, 1, 3)):
            tri.add_points(site)

    def scratch() -> None:
        Delaunay(tri.points)

    found = []
    size = f"to {there:,} uniform sites in space"
    for task, call, count in (
        (f"{more:,} sites added", many, 1),
        (f"{more:,} sites added, arrays made", many_with_arrays, 1),
        ("one site added", one_by_one, ONE_BY_ONE),
    ):
        ours, theirs = in_turn(call, scratch, rounds)
        each = tuple(seconds / count for seconds in ours)
        same = len(tri.simplices) == len(Delaunay(tri.points).simplices)
        note = f"{len(tri.points):,} sites then" + ("" if same else ", not the same simplices")
        found.append(Pair(task, size, "from scratch", each, theirs, note))
    return found
