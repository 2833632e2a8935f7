"""Meshes of triangles and tetrahedra that are no triangulation, though near each simplex they look it."""

from __future__ import annotations

import itertools

import numpy as np


def facets_of(simplices: np.ndarray) -> dict:
    """The simplices that have each facet, by the set of its vertices."""
    found: dict = {}
    for t, simplex in enumerate(simplices.tolist()):
        for k in range(len(simplex)):
            found.setdefault(frozenset(simplex[:k] + simplex[k + 1 :]), []).append(t)
    return found


def cover(
    points: np.ndarray, simplices: np.ndarray, sheets: int, shift: dict
) -> tuple[np.ndarray, np.ndarray]:
    """The mesh laid down ``sheets`` times, one above the other.

    Who goes from the first simplex of a facet to its second one also goes up by ``shift[facet]`` sheets,
    from the last one to the first. Where the shifts of the facets round an edge (in the plane, of the edges
    at a vertex) do not add up to nothing, the cover branches. Without shifts it falls into sheets. A site has
    one vertex for each set of corners that are glued.
    """
    parent = {
        (t, s, v): (t, s, v) for t, row in enumerate(simplices.tolist()) for s in range(sheets) for v in row
    }

    def root(x):
        while parent[x] != x:
            x = parent[x]
        return x

    for facet, sides in facets_of(simplices).items():
        if len(sides) == 2:
            t, u = sides
            for s, v in itertools.product(range(sheets), facet):
                parent[root((t, s, v))] = root((u, (s + shift.get(facet, 0)) % sheets, v))
    number: dict = {}
    rows = [
        [number.setdefault(root((t, s, v)), len(number)) for v in row]
        for t, row in enumerate(simplices.tolist())
        for s in range(sheets)
    ]
    return points[[v for _, _, v in number]], np.array(rows)


def star_polygon(corners: int, step: int) -> np.ndarray:
    """The centre and its neighbours round it, (0, i, i + step), which wind ``step`` times."""
    rim = np.arange(corners)
    return np.column_stack([np.zeros(corners, int), 1 + rim, 1 + (rim + step) % corners])


def wheel(corners: int) -> np.ndarray:
    """The origin and a regular polygon around it."""
    angle = 2 * np.pi * np.arange(corners) / corners
    return np.concatenate([[[0, 0]], np.column_stack([np.cos(angle), np.sin(angle)])])


def round_an_axis(corners: int, step: int, height: float) -> tuple[np.ndarray, np.ndarray]:
    """Tetrahedra round the axis from (0, 0, -height) to (0, 0, height), which wind ``step`` times."""
    ring = np.column_stack([wheel(corners)[1:], np.zeros(corners)])
    points = np.concatenate([[[0, 0, -height], [0, 0, height]], ring])
    around = star_polygon(corners, step)[:, 1:] + 1
    return points, np.column_stack([np.zeros(corners, int), np.ones(corners, int), around])


def slit_wheel(corners: int) -> tuple[np.ndarray, np.ndarray]:
    """A wheel cut open along one spoke: the sides of the slit lie on one line, and both look convex."""
    points = np.concatenate([wheel(corners), wheel(corners)[1:2]])
    rim = np.arange(1, corners + 1)
    return points, np.column_stack([np.zeros(corners, int), rim, rim + 1])


def slit_axis(corners: int, height: float) -> tuple[np.ndarray, np.ndarray]:
    """Tetrahedra round an axis, cut open along one half-plane."""
    points, simplices = round_an_axis(corners, 1, height)
    simplices[-1, 3] = len(points)
    return np.concatenate([points, points[2:3]]), simplices
