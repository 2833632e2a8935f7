"""An independent oracle: what a Delaunay triangulation is, decided in integers of any size.

`validate(tri)` is what every test of a triangulation ends in. It shares no code with the library.

Why it is enough. Tetrahedra are positive and lie on the two sides of their common facets, so how many of
them cover a point changes at hull facets only. These turn their backs to the first centroid, whose
surroundings are covered once. Seen from there no ray meets the hull twice, or it would have to enter again,
through a facet that turns its face. So the tetrahedra tile what the hull bounds, which is convex since its
edges are; and a tiling of a convex body with empty spheres across facets has empty spheres (B. Delaunay,
1934).
"""

from __future__ import annotations

import numpy as np

FACETS = [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]  # seen from outside, opposite vertex 0, 1, 2, 3


def integers(points: np.ndarray) -> np.ndarray:
    """The points times a power of two that makes them integers, as Python ints."""
    ratios = [[float(x).as_integer_ratio() for x in p] for p in points]
    scale = max(d for row in ratios for _, d in row)
    return np.array([[n * (scale // d) for n, d in row] for row in ratios], dtype=object)


def det3(u: np.ndarray, v: np.ndarray, w: np.ndarray) -> np.ndarray:
    return (
        u[..., 0] * (v[..., 1] * w[..., 2] - v[..., 2] * w[..., 1])
        - u[..., 1] * (v[..., 0] * w[..., 2] - v[..., 2] * w[..., 0])
        + u[..., 2] * (v[..., 0] * w[..., 1] - v[..., 1] * w[..., 0])
    )


def orient(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> np.ndarray:
    """det[b-a, c-a, d-a], exact."""
    return det3(b - a, c - a, d - a)


def in_sphere(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray, e: np.ndarray) -> np.ndarray:
    """Positive where e is strictly inside the circumsphere of the positive tetrahedron abcd; exact."""
    rows = [x - e for x in (a, b, c, d)]
    lifts = [(r * r).sum(axis=-1) for r in rows]
    total = 0
    for k in range(4):
        others = [rows[j] for j in range(4) if j != k]
        total = total + (-1) ** k * lifts[k] * det3(*others)
    return total  # 4x4 determinant, expanded by its last column


def canonical(simplices: np.ndarray) -> np.ndarray:
    """Rows and their vertices in ascending order: equal for equal sets of simplices."""
    rows = np.sort(simplices, axis=1)
    return rows[np.lexsort(rows.T[::-1])]


def as_coordinates(points: np.ndarray, simplices: np.ndarray) -> set:
    """The tetrahedra as sets of coordinates, for inputs whose rows were moved."""
    return {frozenset(map(tuple, points[s].tolist())) for s in simplices}


def validate(tri) -> None:
    """Assert every invariant of a Delaunay triangulation, exactly."""
    check_indices(tri)
    facet_of = check_neighbors(tri)
    points = integers(tri.points)
    corners = [points[tri.simplices[:, k]] for k in range(4)]
    assert (orient(*corners) > 0).all(), "a tetrahedron is flat or turned"
    check_locally_delaunay(tri, points, corners)
    check_hull(tri, points, facet_of)
    check_once(tri, points, corners)


def check_indices(tri) -> None:
    n, m = len(tri.points), len(tri.simplices)
    assert tri.simplices.dtype == tri.neighbors.dtype == tri.convex_hull.dtype == np.int32
    assert tri.simplices.shape == tri.neighbors.shape == (m, 4)
    assert tri.duplicates.shape[1:] == (2,)
    used = np.unique(tri.simplices)
    assert set(used.tolist()).isdisjoint(tri.duplicates[:, 0].tolist())
    assert sorted([*used.tolist(), *tri.duplicates[:, 0].tolist()]) == list(range(n)), "a site was dropped"
    same = tri.points[tri.duplicates[:, 0]] == tri.points[tri.duplicates[:, 1]]
    assert same.all(), "a site was listed as a duplicate of another one"


def check_neighbors(tri) -> dict:
    """Every facet has two tetrahedra, one on each side, which `neighbors` names, or is on the hull."""
    seen: dict = {}
    turning: dict = {}
    for t, vertices in enumerate(tri.simplices.tolist()):
        for k, facet in enumerate(FACETS):
            corners = [vertices[j] for j in facet]
            seen.setdefault(frozenset(corners), []).append((t, k))
            least = corners.index(min(corners))
            from_outside = tuple(corners[least:] + corners[:least])
            assert turning.setdefault(from_outside, t) == t, "two tetrahedra are on one side of a facet"
    for sides in seen.values():
        assert len(sides) <= 2
        (t, k), (u, j) = sides[0], sides[-1]
        if len(sides) == 2:
            assert tri.neighbors[t, k] == u
            assert tri.neighbors[u, j] == t
        else:
            assert tri.neighbors[t, k] == -1
    return seen


def check_locally_delaunay(tri, points: np.ndarray, corners: list) -> None:
    for k in range(4):
        t = np.flatnonzero(tri.neighbors[:, k] >= 0)
        u = tri.neighbors[t, k]
        back = np.array([np.flatnonzero(tri.neighbors[x] == y)[0] for x, y in zip(u, t, strict=True)], int)
        apex = points[tri.simplices[u, back]]
        if len(t):
            inside = in_sphere(*(c[t] for c in corners), apex)
            assert (inside <= 0).all(), "a neighbour's vertex lies inside a circumsphere"


def check_hull(tri, points: np.ndarray, facet_of: dict) -> None:
    """The hull is what borders nothing, a closed surface, and convex along every edge."""
    assert {frozenset(f) for f in tri.convex_hull.tolist()} == {
        f for f, sides in facet_of.items() if len(sides) == 1
    }
    across = {}
    for a, b, c in tri.convex_hull.tolist():
        for u, v, w in ((a, b, c), (b, c, a), (c, a, b)):
            assert (u, v) not in across, "two hull facets run along an edge in one direction"
            across[u, v] = w
    for (u, v), w in across.items():
        opposite = across[v, u]
        # seen from outside u, v, w turn to the left, so a site beyond the facet has negative orientation
        assert orient(points[u], points[v], points[w], points[opposite]) <= 0, "the hull is not convex"


def check_once(tri, points: np.ndarray, corners: list) -> None:
    """The centroid of the first tetrahedron is in no other one, and behind every hull facet."""
    assert len(tri.simplices)
    first = sum(points[v] for v in tri.simplices[0])  # four times the centroid
    quadruple = [4 * c for c in corners]
    least, greatest = np.minimum.reduce(quadruple), np.maximum.reduce(quadruple)
    near = np.flatnonzero(((least <= first) & (first <= greatest)).all(axis=1))
    near = near[near > 0]
    a, b, c, d = (q[near] for q in quadruple)
    x = np.broadcast_to(first, a.shape)
    sides = [orient(x, b, c, d), orient(a, x, c, d), orient(a, b, x, d), orient(a, b, c, x)]
    covering = np.logical_and.reduce([s >= 0 for s in sides]) if len(near) else np.zeros(0, bool)
    assert not covering.any(), "a point is covered more than once"
    a, b, c = (4 * points[tri.convex_hull[:, k]] for k in range(3))
    assert (orient(a, b, c, np.broadcast_to(first, a.shape)) < 0).all(), "the hull is seen from outside"
