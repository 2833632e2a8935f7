"""Normalisation to the unit cube, and the random linear map that resolves cospherical sites.

Teng et al. 1993, section 5.1: sites v become (I + eta M) v with M uniform in [0, 1]. Lines and planes stay
what they are; spheres become ellipsoids, so five cospherical sites are no longer so.
"""

from __future__ import annotations

import numpy as np

# Small against the gaps that decide an in-sphere test of sites at random, large against rounding.
MAGNITUDE = {np.dtype(np.float64): 2.0**-30, np.dtype(np.float32): 2.0**-12}


def normalise(points: np.ndarray) -> np.ndarray:
    """Sites moved to the origin and scaled by a power of two into the unit cube, float64 (n, 3).

    Scaling by a power of two is exact; differences to the least coordinate round once.
    """
    low = points.min(axis=0)
    with np.errstate(over="ignore"):
        extent = (points / 4 - low / 4).max()  # quarters, so that the difference cannot overflow
    exponent = int(np.frexp(extent)[1]) + 2
    scaled: np.ndarray = np.ldexp(points, -exponent) - np.ldexp(low, -exponent)
    return scaled


def perturb(sites: np.ndarray, dtype: np.dtype, seed: int, eta: float | None = None) -> np.ndarray:
    """(I + eta M) applied to sites (n, 3), in the working precision; by default its `MAGNITUDE`."""
    if eta is None:
        eta = MAGNITUDE[np.dtype(dtype)]
    m = np.random.default_rng(seed).random((3, 3))
    # written out, so that equal sites give equal results wherever they stand in the array
    x, y, z = sites.T
    moved = np.column_stack([row[0] * x + row[1] * y + row[2] * z for row in m])
    perturbed: np.ndarray = (sites + eta * moved).astype(dtype)
    return perturbed
