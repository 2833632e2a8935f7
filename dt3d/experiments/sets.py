"""Point sets of Teng et al. 1993, Table 1: made again, or others of the same kind; and one of clusters.

The paper publishes none of its sets. Random sets, cube and dodecahedron can be made again, the random ones by
another seed. Its torus, tori, spiral, Lissajous tube, teapot and polymers are known by name and size only:
those here have as many sites, and a shape that the name suggests, which is ours. Of m1, m2, bust, fract2 and
phone1 not even the kind is known well enough to make one.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np


def rand(n: int, seed: int = 0) -> np.ndarray:
    """``rand.n``: n sites at random in the unit cube, float64 (n, 3).

    The paper's own sets are not published; each size and seed gives another set of their kind.
    """
    return np.random.default_rng([seed, n]).random((n, 3))


def cube(side: int = 7) -> np.ndarray:
    """``cube``: the grid of side^3 integer sites, float64. The paper's has 343 sites, so 7 a side."""
    return np.array(list(itertools.product(range(side), repeat=3)), float)


def dodecahedron() -> np.ndarray:
    """``dodecahedron``: the 20 vertices of the regular dodecahedron, all on one sphere; float64 (20, 3)."""
    phi = (1 + 5**0.5) / 2
    vertices: list[tuple[float, ...]] = list(itertools.product((-1.0, 1.0), repeat=3))
    for s, t in itertools.product((-1, 1), repeat=2):
        vertices += [(0, s / phi, t * phi), (s / phi, t * phi, 0), (s * phi, 0, t / phi)]
    return np.array(vertices, float)


def clusters(n: int, seed: int = 0, *, count: int = 20, spread: float = 0.01) -> np.ndarray:
    """n sites in ``count`` normal clusters of that standard deviation in the unit cube, float64 (n, 3)."""
    rng = np.random.default_rng([seed, n])
    centres = rng.random((count, 3))
    return centres[rng.integers(0, count, n)] + spread * rng.standard_normal((n, 3))


def torus(around: int = 16, rings: int = 16, *, radius: float = 2.0, tube_radius: float = 1.0) -> np.ndarray:
    """A set of the kind of ``torus``: a regular grid of angles on a torus, float64 (around * rings, 3).

    The paper's has 256 sites, here 16 circles of 16; its radii are not known. Each circle, and many a sphere,
    holds 16 sites and more.
    """
    t = 2 * np.pi * np.arange(rings) / rings
    circle = np.column_stack([radius * np.cos(t), radius * np.sin(t), np.zeros(rings)])
    outward = circle / radius
    return _tube(circle, outward, np.tile([0.0, 0.0, 1.0], (rings, 1)), tube_radius, around)


def tori() -> np.ndarray:
    """A set of the kind of ``tori``: two tori like the links of a chain, each of 20 circles of 20; (800, 3).

    Their tubes have a quarter of the radius of their circles and lie apart.
    """
    one = torus(20, 20, radius=2.0, tube_radius=0.5)
    x, y, z = one.T
    return np.concatenate([one, np.column_stack([x + 2, -z, y])])


def spiral() -> np.ndarray:
    """A set of the kind of ``spiral``: a tube about a helix of four turns, 104 circles of 12; (1248, 3)."""
    t = np.linspace(0, 8 * np.pi, 104)
    return _transported(np.column_stack([np.cos(t), np.sin(t), 0.12 * t]), 0.25, 12)


def lissajous() -> np.ndarray:
    """A set of the kind of ``liss-5-8``: a tube about a closed curve of frequencies 5, 8 and 13; (4200, 3).

    525 circles of 8 sites. The third frequency and the phases, for which the curve does not meet itself, are
    ours.
    """
    t = 2 * np.pi * np.arange(525) / 525
    curve = np.column_stack([np.cos(5 * t), np.cos(8 * t + 0.7), np.cos(13 * t + 0.2)])
    return _transported(curve, 0.03, 8)


def teapot() -> np.ndarray:
    """A set of the size of ``teapot``, float64 (4668, 3); not the teapot of Utah, but a pot with a lid.

    A body of revolution of 59 circles of 60 sites, a spout of 40 circles of 12, a handle of 54 circles of 12.
    """
    knots = np.array(  # of the outline: radius and height, from the foot to the knob of the lid
        [(0.9, 0.0), (1.35, 0.15), (1.8, 0.7), (1.9, 1.1), (1.7, 1.6), (1.35, 2.1), (1.3, 2.25),
         (1.1, 2.4), (0.5, 2.65), (0.2, 2.75), (0.25, 2.95), (0.1, 3.1)]
    )  # fmt: skip
    at = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(knots, axis=0), axis=1))])
    along = np.linspace(0, at[-1], 59)
    radius, height = (np.interp(along, at, column) for column in knots.T)
    angle = 2 * np.pi * np.arange(60) / 60
    body = np.stack(
        [np.outer(radius, np.cos(angle)), np.outer(radius, np.sin(angle)), np.outer(height, np.ones(60))], -1
    )
    s = np.linspace(0, 1, 40)
    spout = np.column_stack([2.0 + 1.3 * s, np.zeros(40), 0.9 + 1.3 * s**2])
    h = np.linspace(0.1, 0.9, 54) * np.pi
    handle = np.column_stack([-1.75 - 1.1 * np.sin(h), np.zeros(54), 1.35 + 0.75 * np.cos(h)])
    return np.concatenate(
        [body.reshape(-1, 3), _transported(spout, 0.3 - 0.15 * s, 12), _transported(handle, 0.13, 12)]
    )


def polymer(n: int, seed: int = 0) -> np.ndarray:
    """A set of the kind of ``polymer.n``: a random coil of n atoms, float64 (n, 3) in ångström.

    A chain of bonds of 1.5, whose atoms keep 2.4 from all others, so that bonds meet at 106 degrees or more.
    It is grown an atom at a time in random directions, and loses its end where it finds no place to go. A
    real molecule has branches, rings and side chains, and may be folded.
    """
    rng = np.random.default_rng([seed, n])
    atoms = np.zeros((n, 3))
    count = 1
    while count < n:
        directions = rng.standard_normal((20, 3))
        tried = atoms[count - 1] + 1.5 * directions / np.linalg.norm(directions, axis=1)[:, None]
        gaps = np.linalg.norm(tried[:, None] - atoms[: count - 1], axis=2).min(axis=1, initial=np.inf)
        free = np.flatnonzero(gaps >= 2.4)
        if len(free):
            atoms[count] = tried[free[0]]
            count += 1
        else:
            count = max(1, count - int(rng.integers(5, 50)))
    return atoms


def _transported(curve: np.ndarray, radius: float | np.ndarray, around: int) -> np.ndarray:
    """A tube about a curve, whose circles do not turn about it from one to the next."""
    along = np.gradient(curve, axis=0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    first = np.empty_like(curve)
    side = np.eye(3)[np.abs(along[0]).argmin()]
    for k, tangent in enumerate(along):
        side = side - (side @ tangent) * tangent
        side /= np.linalg.norm(side)
        first[k] = side
    return _tube(curve, first, np.cross(along, first), radius, around)


def _tube(
    centres: np.ndarray, first: np.ndarray, second: np.ndarray, radius: float | np.ndarray, around: int
) -> np.ndarray:
    """Circles about points, each in the plane of two unit vectors: float64 (points * around, 3)."""
    angle = 2 * np.pi * np.arange(around) / around
    radii = np.broadcast_to(radius, len(centres))[:, None, None]
    spokes = first[:, None] * np.cos(angle)[:, None] + second[:, None] * np.sin(angle)[:, None]
    return np.asarray((centres[:, None] + radii * spokes).reshape(-1, 3))


# The sets that are those of the paper, and those that only are of their kind, by the paper's names.
SAME: dict[str, Callable[[], np.ndarray]] = {"cube": cube, "dodecahedron": dodecahedron}
OF_THE_KIND: dict[str, Callable[[], np.ndarray]] = {
    "torus": torus,
    "tori": tori,
    "spiral": spiral,
    "liss-5-8": lissajous,
    "teapot": teapot,
}


def of_the_kind(name: str) -> bool:
    """Whether the set of this name is not the paper's, but one of as many sites that its name suggests."""
    return name in OF_THE_KIND or name.startswith("polymer.")


def can_be_made(name: str) -> bool:
    """Whether there is a set for a name of the paper."""
    return name.startswith("rand.") or name in SAME or of_the_kind(name)


def named(name: str, seed: int = 0) -> np.ndarray:
    """The set for a name of the paper, float64 (n, 3); a ValueError if there is none.

    ``seed`` is that of random sets and polymers.
    """
    kind, _, size = name.partition(".")
    if kind == "rand":
        return rand(int(size), seed)
    if kind == "polymer":
        return polymer(int(size), seed)
    if not can_be_made(name):
        msg = f"the paper does not say enough of {name!r} to make it"
        raise ValueError(msg)
    return (SAME | OF_THE_KIND)[name]()
