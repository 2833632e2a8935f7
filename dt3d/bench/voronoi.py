"""Voronoi diagrams beside SciPy's."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ..voronoi import Voronoi
from .pairs import Pair, in_turn

if TYPE_CHECKING:
    import scipy.spatial


def pairs(rounds: int, quick: bool) -> list[Pair]:
    """Diagrams of uniform sites in space and in the plane, ``rounds`` times each.

    SciPy makes all when it is called, with lists of lists. Here arrays have the same, and lists are made when
    they are asked for, so there is a pair for each. Both begin with the sites.
    """
    import scipy.spatial

    found = []
    sites = 1000 if quick else 100_000
    for d, where in ((3, "space"), (2, "the plane")):
        points = np.random.default_rng(0).random((sites, d))
        note = _agreement(lists(points), scipy.spatial.Voronoi(points))
        for task, call in (("Voronoi diagram in arrays", arrays), ("Voronoi diagram in lists", lists)):
            ours, theirs = in_turn(partial(call, points), partial(scipy.spatial.Voronoi, points), rounds)
            found.append(Pair(task, f"{sites:,} uniform sites in {where}", "scipy", ours, theirs, note))
    return found


def arrays(points: np.ndarray) -> Voronoi:
    """The diagram with all that SciPy makes, in arrays."""
    vor = Voronoi(points)
    vor.vertices, vor.ridge_points, vor.ridge_indices, vor.region_indices, vor.point_region  # noqa: B018
    return vor


def lists(points: np.ndarray) -> Voronoi:
    """The same, and lists of what SciPy has in lists."""
    vor = arrays(points)
    vor.ridge_vertices, vor.regions  # noqa: B018
    return vor


def _agreement(ours: Voronoi, theirs: scipy.spatial.Voronoi) -> str:
    """How far the two are the same, in words."""
    same = len(ours.vertices) == len(theirs.vertices)
    lengths = (
        dict(
            zip(map(tuple, np.sort(v.ridge_points, axis=1).tolist()), map(len, v.ridge_vertices), strict=True)
        )
        for v in (ours, theirs)
    )
    own, other = lengths
    same = same and other.items() <= own.items() and all(own[pair] == 2 for pair in own.keys() - other.keys())
    return f"{len(ours.vertices):,} vertices, {len(own):,} ridges" + ("" if same else ", not the same ones")
