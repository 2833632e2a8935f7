"""The signed distance between bounds: what of a face expansion floating point can decide.

With a as origin, u = b-a, v = c-a, w = d-a, N = u x v and o the centre of the face's circumcircle, the sphere
through a face and a site d on its positive side has its centre at o + (s/2) N with

    s(d) = <w, w - 2o> / <N, w>,

the signed distance of Teng et al. 1993, section 4.1, times 2 / |N|. N is not made a unit vector, as
`signed_distance` does by QR, because then the height <N, w> is exact where the coordinates are small
integers, and its error is zero where face and site lie in a plane along the axes: hulls of grids and boxes
are decided without exact arithmetic.

The bounds, with e = 2^-53 and |.| of each coordinate; U, V, S the lengths of u, v, N. Every rounding
multiplies by at most 1 + e; contraction to fused multiply-add leaves roundings out.

* N_i = u_j v_k - u_k v_j is rounded 4 times (two differences, product, sum): its error is at most 5e P_i,
  P_i = |u_j v_k| + |u_k v_j|.
* The height is rounded 4 times more (w, product, two sums): error <= 9.1e sum P_i |w_i| <= sum p_i |w_i| with
  p_i = 12e P_i, which leaves room for the roundings of that sum and of height +- error.
* o = (D x N) / (2 S^2), D = U^2 v - V^2 u. |D| <= UV (U+V), with an error of at most 8e UV (U+V). So the
  error of D x N is at most e UV (U+V) (7.1 UV + 8S + 2.9S) <= 18e (UV)^2 (U+V), since |P| <= sqrt(2) UV and S
  <= UV. S^2 has a relative error of 14.2e k + 4e, k = UV / S. With |o| <= k (U+V) / 2, o is known to 20e k^2
  (U+V).
* The numerator is rounded 5 times (w twice, difference, product, sums), and has the error of o: at most sum
  |w_i| (10e |w_i - 2 o_i| + q), q = 44e k^2 (U+V), with room for the roundings of numerator +- error and of
  the quotient.

Where k exceeds 2^40 (a face so thin that terms of second order count) nothing is decided. No product over- or
underflows: `sites.check_magnitudes` sees to that.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import Array

from ..points import Point, cross, dot, epsilon, scale, sub, total


class Frame(NamedTuple):
    """What the expansion of a face needs to know of it, with errors; 13 floats."""

    origin: Point[Array]  # a vertex, the one opposite the longest edge, where the errors are least
    normal: Point[Array]  # N, towards the positive half-space
    normal_error: Point[Array]  # p: <N, w> is known to sum p_i |w_i|
    centre: Point[Array]  # o, relative to the origin
    centre_error: Array  # q: <w, w - 2o> is known to sum |w_i| (10e |w_i - 2 o_i| + q)


def absolute(p: Point[Array]) -> Point[Array]:
    """The absolute values of the coordinates."""
    return Point(jnp.abs(p.x), jnp.abs(p.y), jnp.abs(p.z))


def frame(a: Point[Array], b: Point[Array], c: Point[Array], lattice: Array | bool) -> Frame:
    """The frame of the face (a, b, c); ``lattice`` says that heights are exact, for small integers."""
    e = epsilon(a.x)
    ab, bc, ca = sub(b, a), sub(c, b), sub(a, c)
    lengths = dot(ab, ab), dot(bc, bc), dot(ca, ca)
    longest = jnp.maximum(jnp.maximum(lengths[0], lengths[1]), lengths[2])
    opposite_a, opposite_b = lengths[1] == longest, lengths[2] == longest
    turned = [
        Point(
            *(jnp.where(opposite_a, i, jnp.where(opposite_b, j, k)) for i, j, k in zip(*three, strict=True))
        )
        for three in ((a, b, c), (b, c, a), (c, a, b))
    ]
    origin, u, v = turned[0], sub(turned[1], turned[0]), sub(turned[2], turned[0])
    normal = cross(u, v)
    size = cross_sizes(absolute(u), absolute(v))
    uu, vv, ss = dot(u, u), dot(v, v), dot(normal, normal)
    thinness = uu * vv / ss
    centre = scale(0.5 / ss, cross(sub(scale(uu, v), scale(vv, u)), normal))
    decided = thinness < 2.0**80
    centre_error = jnp.where(decided, 44 * e * thinness * (jnp.sqrt(uu) + jnp.sqrt(vv)), jnp.inf)
    exact = jnp.where(lattice, 0.0, 12 * e)
    normal_error = Point(*(jnp.where(decided, exact * x, jnp.inf) for x in size))
    return Frame(origin, normal, normal_error, centre, centre_error)


def cross_sizes(u: Point[Array], v: Point[Array]) -> Point[Array]:
    """The sizes P of the products that a cross product is made of."""
    return Point(u.y * v.z + u.z * v.y, u.z * v.x + u.x * v.z, u.x * v.y + u.y * v.x)


def distance_bounds(face: Frame, site: Point[Array]) -> tuple[Array, Array]:
    """Bounds (low, high) of s(site); (inf, inf) where the site is not above the face.

    A site that may be above or not has no upper bound; one that may be coplanar and on the circumcircle of
    the face has no lower one either. A site that is coplanar and certainly beyond it counts as not above.
    """
    w = sub(site, face.origin)
    size = absolute(w)
    height, error = dot(face.normal, w), dot(face.normal_error, size)
    beside = sub(sub(w, face.centre), face.centre)
    numerator = dot(w, beside)
    e = 10 * epsilon(w.x)
    numerator_error = total(
        m * (e * jnp.abs(x) + face.centre_error) for m, x in zip(size, beside, strict=True)
    )
    least, most = numerator - numerator_error, numerator + numerator_error
    near, far = height - error, height + error
    # comparisons are put so that a NaN, where nothing is known, leaves the site a candidate
    low = jnp.where(
        least >= 0,
        jnp.where(far > 0, least / far, jnp.inf),
        jnp.where(near > 0, least / near, -jnp.inf),
    )
    high = jnp.where(near > 0, most / jnp.where(most > 0, near, far), jnp.inf)
    below = far < 0
    return jnp.where(below, jnp.inf, low), jnp.where(below, jnp.inf, high)


def may_contain(face: Frame, bound: Array, low: Point[Array], high: Point[Array]) -> Array:
    """Whether a box may hold a site above the face with s(site) <= bound, or one in its circumcircle."""
    lo, hi = sub(low, face.origin), sub(high, face.origin)
    size = Point(*(jnp.maximum(jnp.abs(x), jnp.abs(y)) for x, y in zip(lo, hi, strict=True)))
    height = dot(face.normal_error, size)
    for n, x, y in zip(face.normal, lo, hi, strict=True):
        height += jnp.maximum(n * x, n * y)
    # a box without volume above the plane matters only for the face's own circle
    s = jnp.where(height > 0, bound, 0)
    # s(w) > bound where <w, w> - <w, 2 o + bound N> is positive: least along each axis by itself
    gap, error = jnp.zeros_like(s), jnp.zeros_like(s)
    e = 10 * epsilon(low.x)
    for o, n, p, x, y, m in zip(face.centre, face.normal, face.normal_error, lo, hi, size, strict=True):
        twice = 2 * o + s * n
        w = jnp.clip(twice / 2, x, y)
        gap += w * (w - twice)
        error += m * (e * (m + 2 * jnp.abs(o) + jnp.abs(s * n)) + face.centre_error + jnp.abs(s) * p)
    return ~(height < 0) & ~(gap > error)
