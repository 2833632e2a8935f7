"""Interpolation beside SciPy's, and natural neighbours beside MetPy's."""

from __future__ import annotations

from importlib.util import find_spec

import numpy as np

from .pairs import Pair, in_turn


def pairs(rounds: int, quick: bool) -> list[Pair]:
    """Linear, nearest and natural neighbour interpolation of uniform sites at uniform points.

    Triangulations and trees are made beforehand, but for natural neighbours, where MetPy makes them in the
    same call, and so does ours. SciPy's linear interpolation takes a tenth of the points, times ten: it takes
    a time per point that does not depend on how many there are.
    """
    n, k = (2000, 5000) if quick else (100_000, 1_000_000)
    measured = []
    for d in (3, 2):
        measured += _beside_scipy(d, n, k, rounds)
    if find_spec("metpy") is not None:
        measured.append(_beside_metpy(500 if quick else 2000, rounds))
    return measured


def _beside_scipy(d: int, n: int, k: int, rounds: int) -> list[Pair]:
    from scipy.interpolate import LinearNDInterpolator, NearestNDInterpolator

    from ..delaunay import Delaunay
    from ..interpolate import Linear, Nearest

    rng = np.random.default_rng(0)
    points, xi = rng.random((n, d)), rng.random((k, d))
    values = np.sin(3 * points).sum(axis=1)
    where = "in space" if d == 3 else "in the plane"
    size = f"{k:,} points, {n:,} sites"
    found = []
    tri = Delaunay(points)
    linear, theirs = Linear(tri, values), LinearNDInterpolator(tri.to_scipy(), values)
    part = xi[: k // 10]
    seconds = in_turn(lambda: linear(xi), lambda: theirs(part), rounds)
    apart = np.nanmax(np.abs(linear(part) - theirs(part)))
    tenfold = tuple(10 * s for s in seconds[1])
    found.append(Pair(f"linear {where}", size, "scipy", seconds[0], tenfold, f"apart by at most {apart:.1g}"))
    nearest, other = Nearest(tri, values), NearestNDInterpolator(points, values)
    seconds = in_turn(lambda: nearest(xi), lambda: other(xi), rounds)
    unequal = int((nearest(xi) != other(xi)).sum())
    found.append(Pair(f"nearest {where}", size, "scipy", *seconds, f"{unequal} of the values differ"))
    return found


def _beside_metpy(n: int, rounds: int) -> Pair:
    from metpy.interpolate import natural_neighbor_to_points

    from ..interpolate import NaturalNeighbor

    rng = np.random.default_rng(0)
    points, xi = rng.random((n, 2)), rng.uniform(0.05, 0.95, (n, 2))
    values = np.sin(3 * points).sum(axis=1)
    seconds = in_turn(
        lambda: NaturalNeighbor(points, values)(xi),
        lambda: natural_neighbor_to_points(points, values, xi),
        rounds,
    )
    apart = np.nanmax(
        np.abs(NaturalNeighbor(points, values)(xi) - natural_neighbor_to_points(points, values, xi))
    )
    size = f"{n:,} points, {n:,} sites"
    return Pair("natural neighbours in the plane", size, "metpy", *seconds, f"apart by at most {apart:.1g}")
