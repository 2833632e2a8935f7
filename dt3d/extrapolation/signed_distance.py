"""The two numerical primitives of a face expansion, from one QR decomposition per face.

Teng et al. 1993, section 4.1. For a face (a, b, c) write [b-a, c-a] = QR; q1, q2 span its plane and
q3 = q1 x q2 is its normal. With a as origin and o the centre of the face's circumcircle, the sphere through
a, b, c and a fourth point d has its centre at o + SD(d) q3, where

    SD(d) = (|d|^2 - 2 <d, o>) / (2 <d, q3>),

since |d - o - s q3|^2 = |o|^2 + s^2 is linear in s. d lies in the positive half-space where <d, q3> > 0
(Orientation), and among those the d of least SD has a circumsphere that is empty on that side (InSphere).
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import Array

from .points import Point, add, cross, dot, epsilon, norm, scale, sub


class Frame(NamedTuple):
    """What the expansion of a face needs to know of it; 11 floats."""

    origin: Point[Array]  # the vertex a
    normal: Point[Array]  # q3, of length 1, towards the positive half-space
    centre: Point[Array]  # o - a
    height_error: Array  # heights above the plane are known to about height_error * (1 + height): see below
    longest_edge: Array  # at a, the scale of `height_error`


def frame(a: Point[Array], b: Point[Array], c: Point[Array]) -> Frame:
    """The frame of the face (a, b, c), whose normal is (b-a) x (c-a)."""
    u, v = sub(b, a), sub(c, a)
    r11 = norm(u)
    q1 = scale(1 / r11, u)
    r12 = dot(q1, v)
    w = sub(v, scale(r12, q1))
    # once more, so that q2 is orthogonal to q1 also where the face is thin
    again = dot(q1, w)
    w = sub(w, scale(again, q1))
    r12 = r12 + again
    r22 = norm(w)
    q2 = scale(1 / r22, w)
    q3 = cross(q1, q2)
    # <x, b-a> = |b-a|^2 / 2 and <x, c-a> = |c-a|^2 / 2, solved by forward substitution in R
    x1 = r11 / 2
    x2 = ((r12 * r12 + r22 * r22) / 2 - x1 * r12) / r22
    centre = add(scale(x1, q1), scale(x2, q2))
    # Coordinates carry rounding errors of about the unit roundoff of 1 (the unit cube). In the normal they
    # are magnified by the ratio of the face's length to its height.
    longest_edge = jnp.maximum(r11, norm(v))
    height_error = 8 * epsilon(a.x) * (1 + longest_edge / r22)
    return Frame(a, q3, centre, height_error, longest_edge)


def signed_distance(face: Frame, site: Point[Array]) -> Array:
    """SD(site), or inf where the site does not lie in the positive half-space.

    A site whose height above the plane is within rounding error counts as coplanar: it would give a flat
    tetrahedron (the perturbation keeps coplanar sites coplanar, section 5.1).
    """
    d = sub(site, face.origin)
    height = dot(d, face.normal)
    size = jnp.abs(d.x) + jnp.abs(d.y) + jnp.abs(d.z)
    above = height > face.height_error * (1 + size / face.longest_edge)
    numerator = dot(d, sub(d, scale(2, face.centre)))
    return jnp.where(above, numerator / jnp.where(above, 2 * height, 1), jnp.inf)


def circumsphere(face: Frame, distance: Array) -> tuple[Point[Array], Array]:
    """Centre and squared radius of the sphere through the face whose signed distance is ``distance``."""
    relative = add(face.centre, scale(distance, face.normal))
    return add(face.origin, relative), dot(face.centre, face.centre) + distance * distance
