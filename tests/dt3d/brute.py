"""The Delaunay triangulation of few sites by its definition: every simplex with an empty sphere, in integers.

Of the plane and of space. Cospherical sites have the heights |p|^2 + e_p, infinitesimals in the lexicographic
order of coordinates, the first dominant.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from .exact import integers


def determinant(rows: list) -> int:
    if len(rows) == 1:
        return rows[0][0]
    return sum(
        (-1) ** k * rows[0][k] * determinant([row[:k] + row[k + 1 :] for row in rows[1:]])
        for k in range(len(rows))
        if rows[0][k]
    )


def orientation(corners: list) -> int:
    return determinant([[x - y for x, y in zip(p, corners[0], strict=True)] for p in corners[1:]])


def delaunay(points: np.ndarray) -> set:
    """The simplices, as sets of rows; of equal sites the first is used."""
    exact = [tuple(p) for p in integers(points).tolist()]
    first = {p: i for i, p in reversed(list(enumerate(exact)))}
    sites = sorted(first.values())
    return {
        frozenset(chosen)
        for chosen in combinations(sites, points.shape[1] + 1)
        if (volume := orientation([exact[v] for v in chosen]))
        and not any(_inside(exact, chosen, volume, site) for site in sites if site not in chosen)
    }


def _inside(exact: list, chosen: tuple, volume: int, site: int) -> bool:
    """Whether the lifted site is below the lifted simplex, all times |volume|."""
    corners = [exact[v] for v in chosen]
    sign = 1 if volume > 0 else -1
    weights = [
        sign * orientation([*corners[:k], exact[site], *corners[k + 1 :]]) for k in range(len(corners))
    ]
    below = sum(w * sum(x * x for x in p) for w, p in zip(weights, corners, strict=True))
    height = abs(volume) * sum(x * x for x in exact[site]) - below
    if height:
        return height < 0
    ranked = sorted([(exact[site], -1), *zip(corners, weights, strict=True)])
    return next(w for _, w in ranked if w) > 0
