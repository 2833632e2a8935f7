"""Point sets on which inexact arithmetic goes wrong, by name, and what makes their triangulations unique.

`SMALL` holds sets for `exact.validate`, the oracle in Python integers; `LARGE` holds families at sizes for
`dt3d.Delaunay.verify`. Thousands of sites on one sphere are left out: extrapolation needs quadratic time for
them.
"""

from __future__ import annotations

import itertools

import numpy as np

from dt3d.experiments.sets import dodecahedron

from .exact import canonical, det3, in_sphere, integers


def box(*sides: int) -> np.ndarray:
    """All integer sites with 0 <= x < sides[0], 0 <= y < sides[1], 0 <= z < sides[2]."""
    return np.array(list(itertools.product(*map(range, sides))), float)


def grid(k: int) -> np.ndarray:
    return box(k, k, k)


def body_centred(k: int) -> np.ndarray:
    return np.concatenate([grid(k), grid(k - 1) + 0.5])


def face_centred(k: int) -> np.ndarray:
    sites = grid(k)
    return sites[sites.sum(axis=1) % 2 == 0]


def integer_ball(squared: int) -> np.ndarray:
    """All integer sites whose squared distance from the origin is at most ``squared``."""
    reach = int(squared**0.5)
    sites = grid(2 * reach + 1) - reach
    return sites[(sites**2).sum(axis=1) <= squared]


def integer_sphere(squared: int) -> np.ndarray:
    """All integer sites whose squared distance from the origin is ``squared``."""
    sites = integer_ball(squared)
    return sites[(sites**2).sum(axis=1) == squared]


def with_centre(sites: np.ndarray) -> np.ndarray:
    return np.concatenate([sites, np.zeros((1, 3))])


def octahedron() -> np.ndarray:
    return np.concatenate([np.eye(3), -np.eye(3)])


def icosahedron() -> np.ndarray:
    golden = (1 + 5**0.5) / 2
    rectangle = np.array([[0, s, t * golden] for s, t in itertools.product((-1, 1), repeat=2)])
    return np.concatenate([np.roll(rectangle, k, axis=1) for k in range(3)])


def ring(n: int, z: float = 0.0) -> np.ndarray:
    """A regular n-gon in a horizontal plane, up to rounding."""
    angle = 2 * np.pi * np.arange(n) / n
    return np.c_[np.cos(angle), np.sin(angle), np.full(n, z)]


def rings(n: int, levels: int) -> np.ndarray:
    """A cylinder: the same n-gon at several levels."""
    return np.concatenate([ring(n, z) for z in range(levels)])


def skew_lines(n: int) -> np.ndarray:
    """n sites on each of two skew lines: each step on one makes a tetrahedron with each on the other."""
    steps = np.arange(float(n))[:, None]
    return np.concatenate([steps * [1, 0, 0], steps * [0, 1, 0] + [0, 0, 1]])


def plane_and_apex(k: int) -> np.ndarray:
    return np.concatenate([box(k, k, 1), [[k / 2, k / 2, 1]]])


def jittered(k: int, noise: float) -> np.ndarray:
    return grid(k) + noise * np.random.default_rng(k).standard_normal((k**3, 3))


def an_ulp_apart(k: int) -> np.ndarray:
    """Grid sites, their next neighbours in float64 along each axis, and the one along all three."""
    sites = grid(k) + 1
    nearby = [np.where(axis, np.nextafter(sites, np.inf), sites) for axis in np.eye(3, dtype=bool)]
    return np.concatenate([sites, *nearby, np.nextafter(sites, np.inf)])


def random_integers(n: int, k: int) -> np.ndarray:
    """n sites of a k^3 grid at random, with repetition."""
    return np.random.default_rng([n, k]).integers(k, size=(n, 3)).astype(float)


def on_sphere(n: int) -> np.ndarray:
    """Sites on the unit sphere up to rounding."""
    sites = np.random.default_rng(n).standard_normal((n, 3))
    return sites / np.linalg.norm(sites, axis=1)[:, None]


def near_duplicates(n: int) -> np.ndarray:
    return np.concatenate([on_sphere(n), on_sphere(n) * (1 + 1e-15)])


def nested_clusters(n: int, levels: int) -> np.ndarray:
    """n sites each on concentric spheres, every one 2^-40 times as large as the one before."""
    return np.concatenate([on_sphere(n) * 2.0 ** (-40 * k) for k in range(levels)])


SMALL = {
    "tetrahedron": with_centre(np.eye(3)),
    "octahedron": octahedron(),
    "cube": grid(2),
    "icosahedron": icosahedron(),
    "dodecahedron": dodecahedron(),
    "grid 4": grid(4),
    "grid 6": grid(6),
    "body-centred lattice": body_centred(4),
    "face-centred lattice": face_centred(5),
    "thin grid": box(6, 6, 2),
    "far grid": grid(4) + 1e9,
    "tenths": grid(5) * 0.1,
    "integer sphere 9": integer_sphere(9),
    "integer sphere 26 and centre": with_centre(integer_sphere(26)),
    "integer sphere 81": integer_sphere(81),
    "integer ball": integer_ball(9),
    "rings": rings(60, 3),
    "cone": np.concatenate([ring(100), [[0, 0, 1]]]),
    "skew lines": skew_lines(12),
    "plane and apex": plane_and_apex(5),
    "plane up to rounding": np.c_[ring(30)[:, :2], ring(30)[:, :2] @ [0.3, 0.7]],
    "jitter 1e-8": jittered(4, 1e-8),
    "jitter 1e-15": jittered(4, 1e-15),
    "an ulp apart": an_ulp_apart(3),
    "duplicates": np.concatenate([grid(3), grid(3)[::-1]]),
    "random integers": random_integers(300, 5),
    "near duplicates": near_duplicates(40),
    "nested clusters": nested_clusters(50, 2),
    "sphere": on_sphere(300),
}

LARGE = {
    "grid 11": grid(11),
    "grid 22": grid(22),
    "body-centred lattice": body_centred(10),
    "face-centred lattice": face_centred(15),
    "slab": box(25, 25, 2),
    "far grid": grid(10) + 1e9,
    "tenths": grid(10) * 0.1,
    "integer sphere 425": integer_sphere(425),
    "integer sphere 425 and centre": with_centre(integer_sphere(425)),
    "integer ball": integer_ball(64),
    "rings": rings(60, 12),
    "skew lines": skew_lines(60),
    "plane and apex": plane_and_apex(20),
    "jitter 1e-8": jittered(11, 1e-8),
    "jitter 1e-15": jittered(11, 1e-15),
    "an ulp apart": an_ulp_apart(6),
    "random integers": random_integers(5000, 12),
    "near duplicates": near_duplicates(150),
    "nested clusters": nested_clusters(150, 3),
}


def ranks(points: np.ndarray) -> np.ndarray:
    """The place of each site among the distinct ones in the lexicographic order of coordinates, (n,)."""
    order = np.lexsort(points.T[::-1])
    ordered = points[order]
    rank = np.zeros(len(points), np.int64)
    rank[order[1:]] = np.cumsum((ordered[1:] != ordered[:-1]).any(axis=1))
    return rank


def tetrahedra(tri) -> np.ndarray:
    """The tetrahedra as coordinates: int64 (m, 4), equal arrays for equal sets of tetrahedra.

    Sites are named by their ranks, so neither the order of the rows nor a change of coordinates that keeps
    their lexicographic order changes the result.
    """
    return canonical(ranks(tri.points)[tri.simplices])


def ties(tri) -> np.ndarray:
    """Tetrahedra and the far vertex of a neighbour, on their circumsphere by exact arithmetic; int (k, 5)."""
    t, k = np.nonzero(tri.neighbors >= 0)
    u = tri.neighbors[t, k]
    five = np.c_[tri.simplices[t], tri.simplices[u][tri.neighbors[u] == t[:, None]]]
    return five[in_sphere(*integers(tri.points)[five].swapaxes(0, 1)) == 0]


def check_ties(tri) -> None:
    """Assert that ties went the way of infinitesimal heights e_0 >> e_1 >> ... > 0 in the order of the ranks.

    With heights e the in-sphere determinant of a tie is linear in them. Here they are powers of two, each so
    much greater than the next that the first coefficient that is not zero has more weight than all after it.
    """
    five = ties(tri)
    a, b, c, d, e = integers(tri.points)[five].swapaxes(0, 1)
    rows = np.array([a - e, b - e, c - e, d - e])
    # a coefficient is a sum of four determinants of six products of three coordinates
    bits = int(24 * np.abs(rows).max(initial=1) ** 3).bit_length() + 1
    rank = ranks(tri.points)
    height = np.array([1 << bits * (int(rank.max()) - int(r)) for r in rank], dtype=object)[five]
    inside = sum(
        (-1) ** k * (height[:, k] - height[:, 4]) * det3(*np.delete(rows, k, axis=0)) for k in range(4)
    )
    assert (np.asarray(inside) < 0).all(), "a tie was not decided by the symbolic perturbation"
