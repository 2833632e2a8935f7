"""The lexicographic order of coordinates, in which ties are decided and equal sites are found."""

from __future__ import annotations

from .._numba.kernel_cache import cached_njit


@cached_njit
def before(points, i, j):
    """Whether row i of ``points`` precedes row j in the lexicographic order of coordinates."""
    for k in range(points.shape[1]):
        if points[i, k] != points[j, k]:
            return points[i, k] < points[j, k]
    return False


@cached_njit
def equal(points, i, j):
    """Whether rows i and j of ``points`` have the same coordinates."""
    for k in range(points.shape[1]):  # noqa: SIM110 - numba compiles no generators
        if points[i, k] != points[j, k]:
            return False
    return True
