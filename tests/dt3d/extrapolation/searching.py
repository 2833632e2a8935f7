"""Sets and queries that tests of the searches share."""

import numpy as np

import scanvec as sv
from dt3d.extrapolation.buckets import bucket
from dt3d.extrapolation.gift_wrapping import NEAREST, Start
from dt3d.extrapolation.points import Point
from dt3d.extrapolation.search import search
from dt3d.extrapolation.warrants import NO_SITE

MACHINE = sv.Device()


RNG = np.random.default_rng(0)


SETS = {
    "uniform": RNG.random((300, 3)),
    "clusters": RNG.random((6, 3))[RNG.integers(6, size=300)] + 0.01 * RNG.standard_normal((300, 3)),
    "surface": np.c_[RNG.random((300, 2)), 0.02 * RNG.random(300)],
    "six sites": RNG.random((6, 3)),
}


def buckets_of(points):
    """Buckets of points, rows of an array."""
    return bucket(Point(*(MACHINE.vector(c.copy()) for c in points.T)))


def in_order(buckets):
    return np.stack([v.to_numpy() for v in buckets.sites], axis=1)


def nearest(buckets):
    n = len(buckets.origin)
    return search(buckets, Start(buckets.sites, MACHINE.iota(n)), (buckets.sites, buckets.sites), NEAREST)


def fourth_vertex(sites, a, b, c):
    """The site of the face's positive side with the empty sphere, by solving for every centre; or NO_SITE."""
    normal = np.cross(sites[b] - sites[a], sites[c] - sites[a])
    offsets = sites - sites[a]
    candidates = np.flatnonzero(offsets @ normal > 1e-12)
    best, least = NO_SITE, np.inf
    for d in candidates:
        rows = np.stack([offsets[b], offsets[c], offsets[d]])
        centre = np.linalg.solve(rows, (rows**2).sum(axis=1) / 2)
        if centre @ normal < least:
            best, least = d, centre @ normal
    return best
