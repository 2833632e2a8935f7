"""The in-sphere test of perturbed sites, which is never undecided.

Site p is lifted to height |p|^2 + e_p, with infinitesimals e_p in the lexicographic order of the
coordinates, the first infinitely larger than the next. Orientation is untouched, every five sites have a
strict in-sphere sign, and no tetrahedron of the triangulation is flat (H. Edelsbrunner, E. P. Muecke:
Simulation of Simplicity, ACM Transactions on Graphics 9, 1990; O. Devillers, M. Teillaud: Perturbations and
vertex removal in a 3D Delaunay triangulation, SODA 2003).
"""

from __future__ import annotations

from .._numba.kernel_cache import cached_njit
from .filtered import in_sphere, orient3d


@cached_njit
def inside(points, v, site, w):
    """Whether a site is inside the perturbed circumsphere of the positive tetrahedron v, four sites."""
    sign = in_sphere(points, v[0], v[1], v[2], v[3], site, w)
    if sign != 0:
        return sign > 0
    return inside_tied(points, v, site, w)


@cached_njit
def inside_tied(points, v, site, w):
    """The perturbed in-sphere test of a site on the circumsphere of tetrahedron v, a tuple of four sites.

    The lifted site is below the hyperplane of the lifted vertices iff e_p < sum of l_i e_i, with its
    barycentric coordinates l_i. Of the five in lexicographic order, each e infinitely larger than the next,
    the first whose coefficient is not zero decides; the site's own is negative.
    """
    done = -1
    for _ in range(4):
        first, least = 4, site
        for i in range(4):
            if (done < 0 or before(points, done, v[i])) and before(points, v[i], least):
                first, least = i, v[i]
        if first == 4:
            break
        sign = orientation_with(points, v, first, site, w)
        if sign != 0:
            return sign > 0
        done = least
    return False


@cached_njit
def before(points, i, j):
    """Whether row i of ``points`` precedes row j in the lexicographic order of coordinates."""
    for k in range(3):
        if points[i, k] != points[j, k]:
            return points[i, k] < points[j, k]
    return False


@cached_njit
def orientation_with(points, v, k, site, w):
    """Orientation of a tetrahedron with the site in the place of its k-th vertex."""
    a = site if k == 0 else v[0]
    b = site if k == 1 else v[1]
    c = site if k == 2 else v[2]
    d = site if k == 3 else v[3]
    return orient3d(points, a, b, c, d, w)
