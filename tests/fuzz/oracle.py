"""What a Delaunay triangulation is, decided in integers of any size, in the plane and in space.

It shares no code with the library, and nothing but the definition with the other oracles of the tests. Five
statements together say that simplices are *the* triangulation that the symbolic perturbation defines:

1. every simplex is positively oriented;
2. every facet belongs to one simplex, or to two that lie on opposite sides of it;
3. no site lies beyond a facet that belongs to one simplex only;
4. the centroid of one simplex lies in no other;
5. no perturbed site lies inside the circumsphere of a neighbour across a facet.

By 1 and 2 the number of simplices over a point changes only where the point crosses a facet of one simplex.
By 3 these lie on the boundary of the convex hull, so the number is the same everywhere inside; by 4 it is 1.
So the simplices tile the convex hull, and a tiling that is Delaunay across every facet is Delaunay (B.
Delaunay, Sur la sphere vide, 1934). Sites that are no vertices are found by counting.
"""

from __future__ import annotations

from functools import reduce
from itertools import combinations

import numpy as np


class Refuted(AssertionError):
    """What a result says is not true; the message says which statement."""


def require(truth: bool | np.bool_, sentence: str) -> None:
    """Raise `Refuted` with the sentence unless it holds."""
    if not truth:
        raise Refuted(sentence)


def integers(points: np.ndarray) -> np.ndarray:
    """The points times a power of two that makes them integers, Python ints (n, d)."""
    ratios = [[x.as_integer_ratio() for x in row] for row in points.tolist()]
    scale = max((q for row in ratios for _, q in row), default=1)
    whole = [[p * (scale // q) for p, q in row] for row in ratios]
    # without common powers of two numbers are shorter
    bits = [x & -x for row in whole for x in row if x]
    least = min(bits, default=1)
    return np.array([[x // least for x in row] for row in whole], dtype=object).reshape(points.shape)


def _determinant(rows: list[np.ndarray], columns: tuple[int, ...] | None = None) -> np.ndarray:
    """Of d vectors (..., d), or of these columns of them, expanded by the first vector."""
    columns = tuple(range(len(rows))) if columns is None else columns
    if len(rows) == 1:
        return rows[0][..., columns[0]]
    total = 0
    for k, column in enumerate(columns):
        minor = _determinant(rows[1:], columns[:k] + columns[k + 1 :])
        total = total + (-1) ** k * rows[0][..., column] * minor
    return total


def orient(corners: list[np.ndarray]) -> np.ndarray:
    """det of the differences of d + 1 corners (..., d) to the first; positive for positive orientation."""
    return _determinant([c - corners[0] for c in corners[1:]])


def distinct(points: np.ndarray) -> dict[tuple[float, ...], int]:
    """The least row of each site."""
    first: dict[tuple[float, ...], int] = {}
    for i, site in enumerate(map(tuple, points.tolist())):
        first.setdefault(site, i)
    return first


def dimension(points: np.ndarray) -> int:
    """Of the affine hull, by elimination without fractions."""
    rows = [list(row) for row in integers(points) - integers(points)[0]]
    rank = 0
    for k in range(points.shape[1]):
        at = next((i for i in range(rank, len(rows)) if rows[i][k]), None)
        if at is None:
            continue
        rows[rank], rows[at] = rows[at], rows[rank]
        pivot = rows[rank]
        for i in range(rank + 1, len(rows)):
            if rows[i][k]:
                p, q = pivot[k], rows[i][k]
                rows[i] = [p * x - q * y for x, y in zip(rows[i], pivot, strict=True)]
        rank += 1
    return rank


def ranks(points: np.ndarray) -> np.ndarray:
    """The place of each point among the distinct ones in lexicographic order, int64 (n,)."""
    sites = list(map(tuple, points.tolist()))
    place = {site: i for i, site in enumerate(sorted(set(sites)))}
    return np.array([place[site] for site in sites], np.int64)


def canonical(points: np.ndarray, simplices: np.ndarray) -> np.ndarray:
    """Simplices by the ranks of their sites, rows sorted: equal for equal triangulations of the sites."""
    rows = np.sort(ranks(points)[simplices], axis=1)
    return rows[np.lexsort(rows.T[::-1])]


def check_duplicates(points: np.ndarray, duplicates: np.ndarray) -> None:
    """Every copy is listed once, with the first of its kind, by index."""
    first = distinct(points)
    want = [[i, first[site]] for i, site in enumerate(map(tuple, points.tolist())) if first[site] != i]
    require(np.array_equal(duplicates, np.array(want, int).reshape(-1, 2)), "duplicates are the copies")


def check(points: np.ndarray, simplices: np.ndarray, neighbors: np.ndarray, duplicates: np.ndarray) -> None:
    """Raise `Refuted` unless the simplices are the triangulation of the points.

    Parameters
    ----------
    points : float64 (n, d)
        d is 2 or 3.
    simplices, neighbors : int (m, d + 1)
    duplicates : int (k, 2)
    """
    d = points.shape[1]
    m = len(simplices)
    require(simplices.shape == neighbors.shape == (m, d + 1), "there are d + 1 vertices and neighbors")
    require(m > 0, "there are simplices")
    require(simplices.min() >= 0 and simplices.max() < len(points), "vertices are rows of the points")
    check_duplicates(points, duplicates)
    used = sorted(set(distinct(points).values()))
    require(np.array_equal(np.unique(simplices), used), "the vertices are the first of equal sites")

    exact = integers(points)
    corners = [exact[simplices[:, k]] for k in range(d + 1)]
    require((orient(corners) > 0).all(), "every simplex is positively oriented")
    outer = _check_facets(simplices, neighbors)
    _check_hull(exact, simplices, outer, used)
    _check_covered_once(exact, simplices)
    _check_spheres(points, exact, simplices, neighbors)


def _parity(row: tuple[int, ...]) -> int:
    return sum(a > b for a, b in combinations(row, 2)) % 2


def _check_facets(simplices: np.ndarray, neighbors: np.ndarray) -> list[tuple[int, int]]:
    """The facets of one simplex, as (simplex, opposite vertex)."""
    sides: dict[tuple[int, ...], list[tuple[int, int, int]]] = {}
    for t, row in enumerate(simplices.tolist()):
        for k in range(len(row)):
            facet = tuple(row[:k] + row[k + 1 :])
            sides.setdefault(tuple(sorted(facet)), []).append((t, k, (k + _parity(facet)) % 2))
    outer = []
    for here in sides.values():
        require(len(here) <= 2, "a facet belongs to two simplices at most")
        (t, k, turn), (u, j, other) = here[0], here[-1]
        if len(here) == 2:
            require(turn != other, "two simplices lie on opposite sides of their facet")
            require(neighbors[t, k] == u and neighbors[u, j] == t, "neighbors are across the facets")
        else:
            require(neighbors[t, k] == -1, "beyond the hull there is no neighbor")
            outer.append((t, k))
    return outer


def _check_hull(exact: np.ndarray, simplices: np.ndarray, outer: list, used: list[int]) -> None:
    """No site lies beyond a facet that belongs to one simplex only."""
    sites = exact[used]
    for t, k in outer:
        corners = [exact[v] for v in simplices[t]]
        corners[k] = sites
        beyond = orient([np.broadcast_to(c, sites.shape) for c in corners]) < 0
        require(not beyond.any(), "no site lies beyond the hull")


def _check_covered_once(exact: np.ndarray, simplices: np.ndarray) -> None:
    """The centroid of the first simplex lies in no other, not even on its border."""
    d = exact.shape[1]
    middle = exact[simplices[0]].sum(axis=0)
    scaled = exact * (d + 1)
    corners = [scaled[simplices[:, k]] for k in range(d + 1)]
    inside = np.ones(len(simplices), bool)
    for k in range(d + 1):
        there = corners.copy()
        there[k] = np.broadcast_to(middle, corners[k].shape)
        inside &= np.asarray(orient(there) >= 0, bool)
    require(inside.sum() == 1, "the simplices cover the hull once")


def _check_spheres(
    points: np.ndarray, exact: np.ndarray, simplices: np.ndarray, neighbors: np.ndarray
) -> None:
    """No perturbed site inside the sphere of a neighbour: heights |p|^2 + e_rank, e_0 >> e_1 >> ... > 0."""
    t, k = np.nonzero(neighbors >= 0)
    once = t < neighbors[t, k]
    t, k = t[once], k[once]
    if not len(t):
        return
    other = simplices[neighbors[t, k]]
    apex = other[neighbors[neighbors[t, k]] == t[:, None]]
    five = np.c_[simplices[t], apex]
    rows = [exact[five[:, j]] - exact[apex] for j in range(five.shape[1] - 1)]
    weights = _weights(rows)
    lifts = [(row * row).sum(axis=-1) for row in rows]
    # the height of the apex above the plane through the lifted corners, times the (positive) volume
    below = reduce(lambda x, y: x + y, (w * h for w, h in zip(weights, lifts, strict=True)))
    require(not (below > 0).any(), "no site is inside the circumsphere of a neighbour")
    place = ranks(points)
    for i in np.flatnonzero(below == 0):
        coefficient = {int(v): weights[j][i] for j, v in enumerate(five[i, :-1])}
        coefficient[int(apex[i])] = -sum(coefficient.values())
        first = next(c for v in sorted(coefficient, key=place.__getitem__) if (c := coefficient[v]))
        require(first < 0, "cospherical sites are decided by the perturbation")


def _weights(rows: list[np.ndarray]) -> list[np.ndarray]:
    """The coefficients of the corners' heights in the in-sphere determinant, which is positive inside.

    The rows are c_j - e for the corners of a positive simplex and a site e; the determinant of (c_j - e, h_j)
    is expanded by the heights.
    """
    d = len(rows) - 1
    return [(-1) ** j * _determinant(rows[:j] + rows[j + 1 :]) for j in range(d + 1)]
