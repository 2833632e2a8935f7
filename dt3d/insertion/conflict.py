"""Decisions that the rounded spheres leave open: exact, and ties by the symbolic perturbation."""

from __future__ import annotations

import numba

from .._numba.kernel_cache import cached_njit
from ..predicates.perturbed import inside, orientation_with
from .layout import INFINITE


@cached_njit
def corners(mesh, t):
    """The vertices of tetrahedron t, as signed integers; -1 for the infinite one."""
    return (
        _signed(mesh[8 * t]),
        _signed(mesh[8 * t + 1]),
        _signed(mesh[8 * t + 2]),
        _signed(mesh[8 * t + 3]),
    )


@cached_njit
def _signed(v):
    return -1 if v == INFINITE else numba.int64(v)


@cached_njit
def conflicts(points, mesh, t, site, w):
    """Whether a site destroys tetrahedron t."""
    v = corners(mesh, t)
    for ghost in range(4):
        if v[ghost] < 0:
            # the site in the place of the infinite vertex: beyond the facet, or on its plane
            sign = orientation_with(points, v, ghost, site, w)
            if sign != 0:
                return sign > 0
            # the sphere of the tetrahedron within meets the plane in the facet's circle
            v = corners(mesh, numba.int64(mesh[8 * t + 4 + ghost]) >> 2)
            break
    return inside(points, v, site, w)
