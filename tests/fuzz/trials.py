"""What is done with one set of points: every way to triangulate it, each compared with the oracle."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

import numpy as np

import dt3d
import scanvec as sv
from dt3d import threaded2d
from dt3d._numba import threads as runner
from dt3d.insertion import driver, team
from dt3d.threaded2d.configuration import configured
from dt3d.threaded2d.driver import triangulate as triangulate_plane

from . import oracle
from .families import Rng
from .oracle import Refuted, require

PARALLEL = ("batch", "circumcircle", "pessimistic", "optimistic")
SUBDIVISIONS = ("random", "x-slabs", "distance")
FEW = 16  # sites that extrapolation is tried with, so that few shapes are compiled
QUERIES = 6


def trial(points: np.ndarray, seed: int, thorough: bool = True) -> list[str]:
    """Triangulate points float64 (n, d) in many ways; the names of the ways.

    Raises
    ------
    Refuted
        If a result is wrong, or two ways differ.
    Exception
        Whatever the library raises, but `DegenerateInputError` where it is right.
    """
    rng = np.random.default_rng(seed)
    degenerate = dt3d.DegenerateInputError if points.shape[1] == 3 else threaded2d.DegenerateInputError
    try:
        tri: Any = _class(points)(points, seed=seed)
    except degenerate as error:
        require(oracle.dimension(points) == error.dimension < points.shape[1], "the dimension is right")
        return ["refused"]
    oracle.check(points, _simplices(tri), tri.neighbors, tri.duplicates)
    require(bool(tri.verify()), f"the library's own proof holds: {tri.verify()}")
    _check_location(tri, rng)
    ways = ["default", "verify", "find_simplex"]
    if thorough:
        _check_other_order(points, tri, rng)
        ways += _check_history(points, tri, rng)
        ways += ["other order", *(_space(tri, rng) if points.shape[1] == 3 else _plane(tri, rng))]
    return ways


def _class(points: np.ndarray) -> Any:
    return dt3d.Delaunay if points.shape[1] == 3 else threaded2d.Delaunay


def _simplices(tri: Any) -> np.ndarray:
    return tri.simplices if tri.points.shape[1] == 3 else tri.triangles


def _require_equal(points: np.ndarray, simplices: np.ndarray, tri: Any, way: str) -> None:
    same = np.array_equal(oracle.canonical(points, simplices), oracle.canonical(tri.points, _simplices(tri)))
    require(same, f"{way} finds the same simplices")


def _check_other_order(points: np.ndarray, tri: Any, rng: Rng) -> None:
    """Rows in another order and another seed give the same triangulation."""
    moved = points[rng.permutation(len(points))]
    other = _class(points)(moved, seed=int(rng.integers(2**31)))
    _require_equal(moved, _simplices(other), tri, "another order of the sites")
    oracle.check_duplicates(moved, other.duplicates)


def _check_history(points: np.ndarray, tri: Any, rng: Rng) -> list[str]:
    """Sites that come in several steps give the same triangulation, after each step."""
    k = int(rng.integers(1, len(points) + 1))
    try:
        grown = dt3d.Delaunay(points[:k], incremental=True, seed=int(rng.integers(2**31)))
    except dt3d.DegenerateInputError:
        return []  # the first of them lie on a plane, a line or a point
    while k < len(points):
        step = min(len(points) - k, int(rng.choice([1, 2, 7, 50])))
        grown.add_points(points[k : k + step])
        k += step
        if rng.random() < 0.2:
            oracle.check(points[:k], grown.simplices, grown.neighbors, grown.duplicates)
    _require_equal(points, grown.simplices, tri, "a triangulation that grew")
    require(np.array_equal(grown.duplicates, tri.duplicates), "one that grew has the same duplicates")
    require(bool(grown.verify()), f"the proof of one that grew holds: {grown.verify()}")
    return ["grown"]


@contextlib.contextmanager
def contended(rng: Rng) -> Iterator[None]:
    """Pieces, stretches and blocks so small that threads meet all the time; as many threads as asked for."""
    settings = {
        (team, "LEAST_SITES_PER_THREAD"): int(rng.integers(1, 12)),
        (team, "SITES_PER_CALL"): int(rng.integers(1, 9)),
        (runner, "SECONDS_BETWEEN_LOOKS"): 0.001,
        (driver, "LARGEST_BLOCK"): int(rng.choice([8, 64])),
        (driver, "SLOTS_PER_SITE"): int(rng.choice([1, 8])),
        (driver, "available_cores"): lambda: 8,
    }
    before = {key: getattr(*key) for key in settings}
    for key, value in settings.items():
        setattr(*key, value)
    try:
        yield
    finally:
        for key, value in before.items():
            setattr(*key, value)


def _space(tri: Any, rng: Rng) -> list[str]:
    ways = []
    with contended(rng):
        for _ in range(2):
            threads = int(rng.integers(2, 9))
            other = dt3d.Delaunay(tri.points, threads=threads, seed=int(rng.integers(2**31)))
            _require_equal(tri.points, other.simplices, tri, f"insertion by {threads} threads")
            require(np.array_equal(other.duplicates, tri.duplicates), "threads find the same duplicates")
            ways.append("contended")
    if len(tri.points) <= FEW and rng.random() < 0.05:
        machine = sv.Device() if rng.random() < 0.8 else sv.Simulated(processors=4)
        try:
            other = dt3d.Delaunay(tri.points, machine=machine)
        except ValueError as error:
            # it says so, and that is its documented limit
            require("2^-200" in str(error), f"extrapolation refuses no more than it says: {error}")
            return [*ways, "extrapolation refused"]
        _require_equal(tri.points, other.simplices, tri, "extrapolation")
        ways.append("extrapolation")
    return ways


def _plane(tri: Any, rng: Rng) -> list[str]:
    ways = ["sequential"]
    other = threaded2d.Delaunay(tri.points, method="sequential", location=str(rng.choice(["dag", "walk"])))
    _require_equal(tri.points, other.triangles, tri, "sequential")
    from dt3d._input import exactly_scaled

    sites = exactly_scaled(tri.points)
    for method in (*PARALLEL, "auto"):
        options = configured(
            len(sites),
            method=method,
            threads=int(rng.integers(2, 9)),
            order=str(rng.choice(["brio", "random"])),
            location=str(rng.choice(["dag", "walk"])),
            queue_length=int(rng.choice([2, 3, 64])),
            subdivision=str(rng.choice(SUBDIVISIONS)),
            seed=int(rng.integers(2**31)),
            preset="kohout2004" if rng.integers(2) else None,
        )
        outcome = triangulate_plane(sites, options.contended(2, helping=bool(rng.integers(2))))
        _require_equal(tri.points, outcome.triangles, tri, method)
        ways.append(method)
    return ways


def _check_location(tri: Any, rng: Rng) -> None:
    """Sites, midpoints, their neighbours in float64 and points far off are in the simplex that is named."""
    points, d = tri.points, tri.points.shape[1]
    i, j = rng.integers(len(points), size=(2, QUERIES))
    with np.errstate(over="ignore", under="ignore"):
        queries = np.concatenate([points[i], points[i] / 2 + points[j] / 2, points[i] * 2 - points[j]])
        queries = np.concatenate([queries, np.nextafter(queries, rng.choice([-np.inf, np.inf]))])
    queries = queries[np.isfinite(queries).all(axis=1)]
    found = tri.find_simplex(queries)
    exact = oracle.integers(np.concatenate([points, queries]))
    sites, asked = exact[: len(points)], exact[len(points) :]
    t, k = np.nonzero(tri.neighbors < 0)
    # the corners of simplices at the hull, by which of their facets is on it
    rims = [(j, [sites[_simplices(tri)[t[k == j], i]] for i in range(d + 1)]) for j in range(d + 1)]

    def is_outside(q: np.ndarray) -> bool:
        return any(
            (oracle.orient([*rim[:j], np.broadcast_to(q, rim[j].shape), *rim[j + 1 :]]) < 0).any()
            for j, rim in rims
        )

    for q, simplex in zip(asked, found, strict=True):
        if simplex >= 0:
            corners = [sites[v] for v in _simplices(tri)[simplex]]
            sides = [oracle.orient([*corners[:j], q, *corners[j + 1 :]]) for j in range(d + 1)]
            require(min(sides) >= 0, "find_simplex names a simplex that has the point")
        else:
            require(simplex == -1 and is_outside(q), "a point that is in no simplex is outside the hull")


__all__ = ["Refuted", "contended", "trial"]
