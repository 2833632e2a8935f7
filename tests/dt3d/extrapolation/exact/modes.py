"""Sets with and without ties, as sites in buckets."""

import numpy as np

import scanvec as sv
from dt3d._input import exactly_scaled
from dt3d.extrapolation.buckets import bucket
from dt3d.extrapolation.exact.sites import ExactSites
from dt3d.extrapolation.points import Point

MACHINE = sv.Device()


RNG = np.random.default_rng(0)


def exact_sites(points):
    """Sites of rows in lexicographic order."""
    points = exactly_scaled(points)
    return ExactSites(bucket(Point(*(MACHINE.vector(c.copy()) for c in points.T))), points)


def lexicographic(points):
    return np.unique(points, axis=0)


SETS = {
    "uniform": RNG.random((60, 3)),
    "lattice": RNG.integers(0, 5, (60, 3)).astype(float),
    "tenths": RNG.integers(0, 5, (60, 3)) * 0.1,
    "far": RNG.integers(0, 5, (60, 3)) + 2.0**40,
    "nearly flat": np.c_[RNG.random((60, 2)), 1e-12 * RNG.random(60)],
    "two scales": RNG.random((60, 3)) * np.repeat([1.0, 2.0**-60], 30)[:, None],
    "an ulp": 1 + np.ldexp(RNG.integers(0, 4, (60, 3)), -52),
}
