"""Families of point sets on which geometric programs go wrong, drawn at random, in the plane and in space.

A family is a function of a random generator, the dimension d (2 or 3) and a number of sites. It returns an
array (n, d), where n may differ from what was asked for. `draw` makes a set of it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

Rng = np.random.Generator
Family = Callable[[Rng, int, int], np.ndarray]

LEAST = -1074  # exponent of the least subnormal number
GREATEST = 1023


def uniform(rng: Rng, d: int, n: int) -> np.ndarray:
    return rng.random((n, d))


def gauss(rng: Rng, d: int, n: int) -> np.ndarray:
    return rng.standard_normal((n, d))


def lattice(rng: Rng, d: int, n: int) -> np.ndarray:
    """Of a small grid at random, so many cospherical sites, and copies."""
    return rng.integers(0, rng.integers(2, 9), (n, d)).astype(float)


def whole_grid(rng: Rng, d: int, n: int) -> np.ndarray:
    sides = rng.integers(2, max(3, round(n ** (1 / d)) + 1), d)
    return np.stack(np.meshgrid(*map(np.arange, sides)), -1).reshape(-1, d).astype(float)


def sheared_grid(rng: Rng, d: int, n: int) -> np.ndarray:
    return whole_grid(rng, d, n) @ (np.eye(d) + np.triu(rng.integers(-2, 3, (d, d)), 1))


def tenths(rng: Rng, d: int, n: int) -> np.ndarray:
    """A grid whose coordinates are rounded."""
    return whole_grid(rng, d, n) * 0.1


def far_grid(rng: Rng, d: int, n: int) -> np.ndarray:
    return whole_grid(rng, d, n) + rng.choice([1e9, 2.0**52, -1e15])


def centred_grid(rng: Rng, d: int, n: int) -> np.ndarray:
    """A body-centred lattice, or one whose coordinates have an even sum."""
    sites = whole_grid(rng, d, n)
    return np.concatenate([sites, sites + 0.5]) if rng.random() < 0.5 else sites[sites.sum(axis=1) % 2 == 0]


def integer_sphere(rng: Rng, d: int, n: int) -> np.ndarray:
    """Integer sites at one distance from the origin, and perhaps the origin."""
    squared = int(rng.choice([2, 5, 9, 14, 25, 26, 41, 65] if d == 3 else [25, 50, 65, 325, 1105]))
    reach = int(squared**0.5)
    axes = [np.arange(-reach, reach + 1)] * d
    sites = np.stack(np.meshgrid(*axes), -1).reshape(-1, d).astype(float)
    sites = sites[(sites**2).sum(axis=1) == squared]
    return np.concatenate([sites, np.zeros((int(rng.integers(2)), d))])


def sphere(rng: Rng, d: int, n: int) -> np.ndarray:
    """On a sphere or circle up to rounding."""
    sites = rng.standard_normal((n, d))
    return sites / np.linalg.norm(sites, axis=1)[:, None]


def rings(rng: Rng, d: int, n: int) -> np.ndarray:
    """Regular polygons, in space at several levels; perhaps with a centre or an apex."""
    levels = int(rng.integers(1, 4)) if d == 3 else 1
    angle = 2 * np.pi * np.arange(max(3, n // levels)) / max(3, n // levels)
    ring = np.c_[np.cos(angle), np.sin(angle)]
    centre = np.zeros((1, d))
    if d == 2:
        return np.concatenate([ring, centre[: rng.integers(2)]])
    centre[0, 2] = rng.choice([0.0, 1.0, 7.0])
    stacked = [np.c_[ring, np.full(len(ring), float(z))] for z in range(levels)]
    return np.concatenate([*stacked, centre])


def moment_curve(rng: Rng, d: int, n: int) -> np.ndarray:
    """(t, t^2, t^3): in space every two sites share an edge."""
    t = np.sort(rng.random(n)) if rng.random() < 0.5 else np.arange(n, dtype=float)
    return np.c_[t, t**2, t**3][:, :d]


def skew_lines(rng: Rng, d: int, n: int) -> np.ndarray:
    t = np.arange(n // 2, dtype=float)[:, None]
    if d == 2:
        return np.concatenate([t * [1, 0], t * [1, 1] + [0, 1]])
    return np.concatenate([t * [1, 0, 0], t * [0, 1, 0] + [0, 0, 1]])


def almost_flat(rng: Rng, d: int, n: int) -> np.ndarray:
    """A plane or a line up to rounding."""
    sites = rng.random((n, d)) if rng.random() < 0.5 else lattice(rng, d, n) * 0.1
    sites[:, -1] = sites[:, :-1] @ rng.random(d - 1)
    return sites


def flat(rng: Rng, d: int, n: int) -> np.ndarray:
    """Exactly on a plane, a line or a point, but for a few sites perhaps."""
    rank = int(rng.integers(0, d))
    sites = rng.integers(-8, 9, (n, rank)) @ rng.integers(-4, 5, (rank, d)) + rng.integers(-9, 10, d)
    beside = rng.integers(-8, 9, (int(rng.integers(0, 3)), d))
    return np.concatenate([sites, beside]).astype(float)


def flat_first(rng: Rng, d: int, n: int) -> np.ndarray:
    """A full plane or line, and one site beside it."""
    sites = lattice(rng, d, n)
    sites[:, -1] = 0
    sites[-1] = rng.integers(1, 5, d)
    return sites


def an_ulp_apart(rng: Rng, d: int, n: int) -> np.ndarray:
    """Sites of a grid, and their neighbours in float64."""
    sites = lattice(rng, d, n) + rng.choice([0.0, 1.0, 1e6])
    towards = rng.choice([-np.inf, np.inf], sites.shape)
    return np.where(rng.random(sites.shape) < 0.5, np.nextafter(sites, towards), sites)


def jittered(rng: Rng, d: int, n: int) -> np.ndarray:
    return lattice(rng, d, n) + 10.0 ** rng.integers(-17, -5) * rng.standard_normal((n, d))


def near_duplicates(rng: Rng, d: int, n: int) -> np.ndarray:
    sites = rng.standard_normal((max(2, n // 3), d))
    return np.concatenate([sites, sites * (1 + 2.0**-52), sites * (1 - 2.0**-53)])


def copies(rng: Rng, d: int, n: int) -> np.ndarray:
    """Few sites, many times, in some order."""
    few = rng.choice([uniform, lattice, an_ulp_apart, exponents])(rng, d, max(2, n // 4))
    return few[rng.integers(0, len(few), n)]


def _powers(rng: Rng, shape: tuple[int, ...], low: int = LEAST, high: int = 1000) -> np.ndarray:
    return np.ldexp(1.0, rng.integers(low, high, shape))


def exponents(rng: Rng, d: int, n: int) -> np.ndarray:
    """Every coordinate has a magnitude of its own."""
    low, high = sorted(rng.integers(LEAST, 1001, 2))
    return rng.choice([-1.0, 1.0], (n, d)) * _powers(rng, (n, d), int(low), int(high) + 1)


def exponents_row(rng: Rng, d: int, n: int) -> np.ndarray:
    """Every site has a magnitude of its own; few different directions."""
    low, high = sorted(rng.integers(LEAST, 1001, 2))
    return rng.integers(-3, 4, (n, d)) * _powers(rng, (n, 1), int(low), int(high) + 1)


def exponents_column(rng: Rng, d: int, n: int) -> np.ndarray:
    """Every axis has a magnitude of its own."""
    return lattice(rng, d, n) * _powers(rng, (1, d), -1070, 1000)


def crowded(rng: Rng, d: int, n: int) -> np.ndarray:
    """Many sites in one cell, however small beside the others, with copies."""
    deep = int(rng.integers(-1070, -1))
    reach = int(rng.choice([2, 8, 40]))
    cluster = np.ldexp(rng.integers(-reach, reach + 1, (n, d)).astype(float), deep)
    if rng.random() < 0.5:
        cluster = np.unique(cluster, axis=0)
    frame = np.concatenate([np.eye(d), -np.ones((1, d))])
    beside = np.zeros((4, d))
    beside[:, 0] = np.ldexp(1.0, np.maximum(LEAST, deep - rng.integers(-80, 80, 4)))
    beside[3] = beside[0]
    return np.concatenate([frame, beside, cluster])


def nested(rng: Rng, d: int, n: int) -> np.ndarray:
    """Clusters, each many times as small as the one before."""
    step, levels = int(rng.integers(1, 200)), int(rng.integers(2, 6))
    parts = [np.ldexp(rng.standard_normal((n // levels + 1, d)), -step * k) for k in range(levels)]
    return np.concatenate(parts)


def subnormal(rng: Rng, d: int, n: int) -> np.ndarray:
    return np.ldexp(rng.integers(-20, 21, (n, d)).astype(float), LEAST)


def huge(rng: Rng, d: int, n: int) -> np.ndarray:
    """Up to the greatest number that there is."""
    sites = rng.uniform(-1, 1, (n, d)) * 1.7e308
    sites[rng.random((n, d)) < 0.2] = np.finfo(float).max * rng.choice([-1, 1])
    return sites


def huge_and_tiny(rng: Rng, d: int, n: int) -> np.ndarray:
    return np.where(rng.random((n, 1)) < 0.5, huge(rng, d, n), subnormal(rng, d, n))


def signed_zeros(rng: Rng, d: int, n: int) -> np.ndarray:
    return rng.choice([-1.0, -0.0, 0.0, 1.0, 2.0], (n, d))


def track(rng: Rng, d: int, n: int) -> np.ndarray:
    """A walk with stops, rounded as a receiver writes it."""
    steps = rng.standard_normal((n, d)) * (rng.random((n, 1)) < 0.5)
    return np.round(steps.cumsum(axis=0) + 4.8e6, 2)


def spiral(rng: Rng, d: int, n: int) -> np.ndarray:
    t = np.linspace(0, 12, n)
    return np.c_[t * np.cos(t), t * np.sin(t), t][:, :d]


def paraboloid(rng: Rng, d: int, n: int) -> np.ndarray:
    sites = lattice(rng, d, n)
    sites[:, -1] = (sites[:, :-1] ** 2).sum(axis=1)
    return sites


def two_far_clusters(rng: Rng, d: int, n: int) -> np.ndarray:
    sites = lattice(rng, d, n) * 2.0 ** -int(rng.integers(0, 40))
    return sites + (rng.random((n, 1)) < 0.5) * 2.0 ** int(rng.integers(0, 12))


def slab(rng: Rng, d: int, n: int) -> np.ndarray:
    sites = rng.random((n, d))
    sites[:, -1] *= 10.0 ** -rng.integers(1, 300)
    return sites


def ill_conditioned_rotation(rng: Rng, d: int, n: int) -> np.ndarray:
    """A lattice turned at random, so that what was flat or cospherical nearly is."""
    turn, _ = np.linalg.qr(rng.standard_normal((d, d)))
    return lattice(rng, d, n) @ turn


FAMILIES: dict[str, Family] = {
    f.__name__: f
    for f in (
        uniform, gauss, lattice, whole_grid, sheared_grid, tenths, far_grid, centred_grid,
        integer_sphere, sphere, rings, moment_curve, skew_lines, almost_flat, flat, flat_first,
        an_ulp_apart, jittered, near_duplicates, copies, exponents, exponents_row, exponents_column,
        crowded, nested, subnormal, huge, huge_and_tiny, signed_zeros, track, spiral, paraboloid,
        two_far_clusters, slab, ill_conditioned_rotation,
    )
}  # fmt: skip


def mixture(rng: Rng, d: int, n: int) -> np.ndarray:
    """Two families at once, one of them moved and scaled by powers of two."""
    one, other = rng.choice(list(FAMILIES), 2)
    moved = np.ldexp(FAMILIES[other](rng, d, n // 2 + 1), int(rng.integers(-60, 1)))
    return np.concatenate([FAMILIES[one](rng, d, n // 2 + 1), moved])


def fixed(rng: Rng, d: int, n: int) -> np.ndarray:
    """One of the sets that the other tests use, some of its rows, scaled by a power of two."""
    from ..dt3d.families import SMALL
    from ..threaded2d.families import EVERY_SET

    if d == 3:
        sites = SMALL[str(rng.choice(list(SMALL)))]
    else:
        sites = EVERY_SET[str(rng.choice(list(EVERY_SET)))](max(4, n))
    keep = rng.permutation(len(sites))[: int(rng.integers(d + 1, max(n, d + 2)))]
    return np.ldexp(sites[keep], int(rng.integers(-1000, 900)))


def draw(rng: Rng, name: str, d: int, n: int) -> np.ndarray:
    """A set of the family, finite, with rows in random order and some of them repeated, perhaps."""
    with np.errstate(over="ignore", under="ignore"):
        points = np.asarray(ALL[name](rng, d, n), float)
    points = points[np.isfinite(points).all(axis=1)]
    if rng.random() < 0.3:
        points = np.concatenate([points, points[rng.random(len(points)) < 0.2]])
    if rng.random() < 0.8:
        points = points[rng.permutation(len(points))]
    return np.ascontiguousarray(points[:, rng.permutation(d)])


ALL: dict[str, Family] = FAMILIES | {"mixture": mixture, "fixed": fixed}
