"""The in-circle test of perturbed sites in the plane, which is never undecided: as `perturbed` in space.

Site p is lifted to height |p|^2 + e_p, with infinitesimals e_p in the lexicographic order of the
coordinates, the first infinitely larger than the next.
"""

from __future__ import annotations

from .._numba.kernel_cache import cached_njit
from .filtered2d import in_circle, orient2d


@cached_njit
def inside(points, rank, v, site, w):
    """Whether a site is inside the perturbed circumcircle of the positive triangle v, three sites.

    ``rank`` holds the place of each site in the lexicographic order of coordinates.
    """
    sign = in_circle(points, v[0], v[1], v[2], site, w)
    if sign != 0:
        return sign > 0
    return _inside_tied(points, rank, v, site, w)


@cached_njit
def _inside_tied(points, rank, v, site, w):
    """The perturbed in-circle test of a site on the circumcircle of triangle v.

    Of the four in the order of `rank` the first whose coefficient is not zero decides. A site on the circle
    is on no line through two vertices, so that is the first of all.
    """
    k, least = 3, rank[site]
    for i in range(3):
        if rank[v[i]] < least:
            k, least = i, rank[v[i]]
    return k < 3 and orientation_with(points, v, k, site, w) > 0


@cached_njit
def orientation_with(points, v, k, site, w):
    """Orientation of a triangle with the site in the place of its k-th vertex."""
    a = site if k == 0 else v[0]
    b = site if k == 1 else v[1]
    c = site if k == 2 else v[2]
    return orient2d(points, a, b, c, w)
