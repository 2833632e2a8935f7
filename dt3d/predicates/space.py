"""Orientation and in-sphere in space, and which perturbed site is inside a sphere: exact signs.

Sign conventions, as drawn::

        d
        |            orient3d(a, b, c, d) = +1: b-a, c-a, d-a as thumb, first and second finger of a right
        |            hand. It is 0 where the four are coplanar, and -1 mirrored.
        a------c
       /             in_sphere(a, b, c, d, e) = +1 where e is inside the sphere through a positive a, b, c, d;
      /              0 where it is on the sphere, -1 outside.
     b

Points are named by their rows in an array, so that compiled code makes no views of it. ``w`` is the workspace
of the calling thread (`workspace.work_array`), made for these points.

A sign comes from the least arithmetic that decides:

1. The filter: the determinant in doubles, where it is beyond a bound of its error.
2. The lattice: if all differences are small multiples of one power of two, that determinant has no rounding
   error.
3. Pairs of doubles: certain beyond a bound of about 2^-51 times the filter's. If the differences are
   multiples of g, the determinant is a multiple of g^3 or g^5: closer to 0 than that it is 0.
4. Integers of any size (`big_integers`).

Lattices and grids end in 2, nearly cospherical sites in 3; so do exact ties of some 18 bits (in-sphere) or 32
(orientation).

The bounds. Let u = 2^-53, X, Y, Z the largest absolute differences of coordinates, M the largest of them.
What under- and overflow can do is the slack of the workspace.

* orientation: 6 monomials, each at most XYZ. In doubles a monomial is rounded at most 3 times in its
  differences, 2 in its 2x2 minor, once in the product with the third row, twice in sums: error <= 6 XYZ
  ((1+u)^8 - 1) < 48.1 u XYZ. In pairs differences are exact and each rounding is at most 5 u^2: 6 * 25 u^2
  XYZ.
* in-sphere: 4 x 6 monomials XYZ times a lift of at most 3 M^2. In doubles rounded at most 5 times in
  differences (three, and two in the lift), 2 in a minor, 3 in the product with the third row and its sums, 3
  in the lift's square and sums, once in the product with the lift, 3 in the last sums: error <= 72 XYZ M^2
  ((1+u)^17 - 1) < 1225 u XYZ M^2. In pairs twice in a minor, three times in a 3x3 minor, three times in a
  lift, three times more: 72 * 55 u^2 XYZ M^2.

Contraction to fused multiply-add leaves out roundings and adds none, so all hold with it.
"""

from __future__ import annotations

from .._numba.kernel_cache import cached_njit
from .layout import SLACK_INDEX
from .lexicographic import before
from .open_stages import call_in_sphere_open, call_orient3d_open

ORIENT3D_BOUND = 49.0 * 2.0**-53
IN_SPHERE_BOUND = 1240.0 * 2.0**-53


@cached_njit
def _at(points, a):
    """The coordinates of a row."""
    return points[a, 0], points[a, 1], points[a, 2]


@cached_njit
def orient3d(points, a, b, c, d, w):
    """Sign of det[b-a, c-a, d-a] of four rows of ``points``."""
    x, y, z = points[a, 0], points[a, 1], points[a, 2]
    bx, by, bz = points[b, 0] - x, points[b, 1] - y, points[b, 2] - z
    cx, cy, cz = points[c, 0] - x, points[c, 1] - y, points[c, 2] - z
    dx, dy, dz = points[d, 0] - x, points[d, 1] - y, points[d, 2] - z
    det = bx * (cy * dz - cz * dy) + cx * (dy * bz - dz * by) + dx * (by * cz - bz * cy)
    x, y, z = max(abs(bx), abs(cx), abs(dx)), max(abs(by), abs(cy), abs(dy)), max(abs(bz), abs(cz), abs(dz))
    bound = ORIENT3D_BOUND * (x * y * z) + w[SLACK_INDEX]
    if det > bound:
        return 1
    if det < -bound:
        return -1
    rows = _at(points, a), _at(points, b), _at(points, c), _at(points, d)
    return call_orient3d_open(w, rows, det, (x, y, z), w)


@cached_njit
def in_sphere(points, a, b, c, d, e, w):
    """1 inside, -1 outside, 0 on the circumsphere of the positive tetrahedron abcd; rows of ``points``."""
    x, y, z = points[e, 0], points[e, 1], points[e, 2]
    ax, ay, az = points[a, 0] - x, points[a, 1] - y, points[a, 2] - z
    bx, by, bz = points[b, 0] - x, points[b, 1] - y, points[b, 2] - z
    cx, cy, cz = points[c, 0] - x, points[c, 1] - y, points[c, 2] - z
    dx, dy, dz = points[d, 0] - x, points[d, 1] - y, points[d, 2] - z
    ab, bc, cd = ax * by - bx * ay, bx * cy - cx * by, cx * dy - dx * cy
    da, ac, bd = dx * ay - ax * dy, ax * cy - cx * ay, bx * dy - dx * by
    abc = az * bc - bz * ac + cz * ab
    bcd = bz * cd - cz * bd + dz * bc
    cda = cz * da + dz * ac + az * cd
    dab = dz * ab + az * bd + bz * da
    a_lift = ax * ax + ay * ay + az * az
    b_lift = bx * bx + by * by + bz * bz
    c_lift = cx * cx + cy * cy + cz * cz
    d_lift = dx * dx + dy * dy + dz * dz
    det = (a_lift * bcd - b_lift * cda) + (c_lift * dab - d_lift * abc)
    x = max(max(abs(ax), abs(bx)), max(abs(cx), abs(dx)))
    y = max(max(abs(ay), abs(by)), max(abs(cy), abs(dy)))
    z = max(max(abs(az), abs(bz)), max(abs(cz), abs(dz)))
    m = max(x, y, z)
    bound = IN_SPHERE_BOUND * (x * y * z * (m * m)) + w[SLACK_INDEX]
    if det > bound:
        return 1
    if det < -bound:
        return -1
    rows = _at(points, a), _at(points, b), _at(points, c), _at(points, d), _at(points, e)
    return call_in_sphere_open(w, rows, det, (x, y, z), w)


# Ties. Site p is lifted to height |p|^2 + e_p, with infinitesimals e_p in the lexicographic order of the
# coordinates, the first infinitely larger than the next. Orientation is untouched, every five sites have a
# strict in-sphere sign, and no tetrahedron of the triangulation is flat (H. Edelsbrunner, E. P. Muecke:
# Simulation of Simplicity, ACM Transactions on Graphics 9, 1990; O. Devillers, M. Teillaud: Perturbations and
# vertex removal in a 3D Delaunay triangulation, SODA 2003).


@cached_njit
def inside(points, v, site, w):
    """Whether a site is inside the perturbed circumsphere of the positive tetrahedron v, four sites."""
    sign = in_sphere(points, v[0], v[1], v[2], v[3], site, w)
    if sign != 0:
        return sign > 0
    return _inside_tied(points, v, site, w)


@cached_njit
def _inside_tied(points, v, site, w):
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
def orientation_with(points, v, k, site, w):
    """Orientation of a tetrahedron with the site in the place of its k-th vertex."""
    a = site if k == 0 else v[0]
    b = site if k == 1 else v[1]
    c = site if k == 2 else v[2]
    d = site if k == 3 else v[3]
    return orient3d(points, a, b, c, d, w)


@cached_njit
def orient3d_of_cases(cases, w, out):
    """Write the signs of cases float64 (m, 4, 3)."""
    for i in range(len(out)):
        out[i] = orient3d(cases[i], 0, 1, 2, 3, w)


@cached_njit
def in_sphere_of_cases(cases, w, out):
    """Write the signs of cases float64 (m, 5, 3)."""
    for i in range(len(out)):
        out[i] = in_sphere(cases[i], 0, 1, 2, 3, 4, w)
