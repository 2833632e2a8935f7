"""Which faces of a Delaunay triangulation are Gabriel, and the squared radii of their own balls.

A face is Gabriel if no vertex lies strictly inside its smallest circumscribed ball. In a Delaunay
triangulation the vertices of its cofaces tell. Signs come from doubles, then from pairs of doubles; a
vertex on the ball to pairs counts as on it, where both values of the face are equal up to rounding. Triangles
as of three sites of a turned grid on a line, which are flat to doubles, have then fractions.
"""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from .._numba.kernel_cache import cached_njit
from ..predicates import double_double as dd
from .measures import fractions
from .vectors import (
    COARSE,
    LEAST,
    cross,
    cross_of_pairs,
    cross_terms,
    dot,
    dot_of_pairs,
    edge_scale,
    magnitudes,
    vector_between,
    vector_between_of_pairs,
)

TIED = 2.0**-90
OPEN = 2


@cached_njit
def _sign(value, terms, flat):
    """1 for negative values, 0 for others and for ties; `OPEN` for ties of what is flat."""
    if not abs(value) > TIED * terms:
        return OPEN if flat and value != 0 else 0
    return 1 if value < 0 else 0


@cached_njit
def _edge_encloses(a, b, p, factor):
    """Whether p is strictly inside the ball with diameter ab."""
    x, y = vector_between(p, a, factor), vector_between(p, b, factor)
    value, terms = dot(x, y), dot(magnitudes(x), magnitudes(y))
    if not abs(value) > COARSE * terms:
        value = dot_of_pairs(vector_between_of_pairs(p, a, factor), vector_between_of_pairs(p, b, factor))[0]
    return _sign(value, terms, False)


@cached_njit
def _triangle_encloses(a, b, c, p, factor):
    """Whether p is strictly inside the smallest ball through a, b, c: power of p times |n|^2."""
    u, v, y = vector_between(a, b, factor), vector_between(a, c, factor), vector_between(a, p, factor)
    n = cross(u, v)
    nn, yy, uu, vv = dot(n, n), dot(y, y), dot(u, u), dot(v, v)
    value = nn * yy - uu * dot(y, cross(v, n)) - vv * dot(y, cross(n, u))
    at, beside = magnitudes(y), cross_terms(u, v)
    terms = dot(beside, beside) * yy
    terms += uu * dot(at, cross_terms(v, beside)) + vv * dot(at, cross_terms(beside, u))
    if abs(value) > COARSE * terms:
        return _sign(value, terms, False)
    flat = not nn > COARSE * dot(beside, beside)
    p1, p2 = vector_between_of_pairs(a, b, factor), vector_between_of_pairs(a, c, factor)
    q = vector_between_of_pairs(a, p, factor)
    m = cross_of_pairs(p1, p2)
    one = dd.multiply(dot_of_pairs(m, m), dot_of_pairs(q, q))
    two = dd.multiply(dot_of_pairs(p1, p1), dot_of_pairs(q, cross_of_pairs(p2, m)))
    three = dd.multiply(dot_of_pairs(p2, p2), dot_of_pairs(q, cross_of_pairs(m, p1)))
    return _sign(dd.subtract(dd.subtract(one, two), three)[0], terms, flat)


@cached_njit
def _squared_radius(a, b, c, factor):
    """|u|^2 |v|^2 |u - v|^2 / (4 |u x v|^2), scaled; infinite where underflow leaves nothing."""
    u, v, w = vector_between(a, b, factor), vector_between(a, c, factor), vector_between(b, c, factor)
    n = cross(u, v)
    nn, terms = dot(n, n), dot(cross_terms(u, v), cross_terms(u, v))
    if not nn > COARSE * terms:
        m = cross_of_pairs(vector_between_of_pairs(a, b, factor), vector_between_of_pairs(a, c, factor))
        nn = dot_of_pairs(m, m)[0]
    if not nn > LEAST:
        return math.inf
    return 0.25 * (dot(u, u) * dot(v, v) / nn) * dot(w, w)


@cached_njit(nogil=True)
def _of_triangles(points, tetrahedra, rows, triangles, own, states):
    for i in range(len(triangles)):
        scale = edge_scale(points, triangles, i)
        a, b, c = points[triangles[i, 0]], points[triangles[i, 1]], points[triangles[i, 2]]
        own[i] = _squared_radius(a, b, c, 1 / scale) * scale * scale
    for t in range(len(tetrahedra)):
        scale = edge_scale(points, tetrahedra, t)
        for k in range(4):
            i = rows[t, k]
            a, b, c = points[triangles[i, 0]], points[triangles[i, 1]], points[triangles[i, 2]]
            states[t, k] = _triangle_encloses(a, b, c, points[tetrahedra[t, k]], 1 / scale)


@cached_njit(nogil=True)
def _of_edges(points, triangles, states):
    for t in range(len(triangles)):
        scale = edge_scale(points, triangles, t)
        for k in range(3):
            p, a, b = triangles[t, k], triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
            states[t, k] = _edge_encloses(points[a], points[b], points[p], 1 / scale)


def _decided(points: np.ndarray, simplices: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Whether the k-th vertex is in the ball of the opposite face: bool as simplices, (m, 3) or (m, 4)."""
    for t, k in np.argwhere(states == OPEN):
        differences = fractions(points[simplices[t, [k, *(j for j in range(simplices.shape[1]) if j != k)]]])
        states[t, k] = _encloses(*differences)
    inside: np.ndarray = states == 1
    return inside


def _encloses(x: list[Fraction], y: list[Fraction], z: list[Fraction] | None = None) -> bool:
    """Whether the origin is strictly inside the ball of x, y and z, or of x and y, of any dimension."""
    if z is None:
        return _dot(x, y) < 0
    u, v = ([q - p for p, q in zip(x, other, strict=True)] for other in (y, z))
    uu, vv, uv = _dot(u, u), _dot(v, v), _dot(u, v)
    # the center is x + (s u + t v) / (2 (uu vv - uv uv))
    s, t = vv * (uu - uv), uu * (vv - uv)
    return (uu * vv - uv * uv) * _dot(x, x) + s * _dot(x, u) + t * _dot(x, v) < 0


def _dot(p: list[Fraction], q: list[Fraction]) -> Fraction:
    return sum((x * y for x, y in zip(p, q, strict=True)), Fraction(0))


def triangles_of_tetrahedra(
    points: np.ndarray, tetrahedra: np.ndarray, rows: np.ndarray, triangles: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Squared radii of triangles, float64 (f,), and whether they are not Gabriel, bool (f,).

    rows, int32 (m, 4), are the triangles opposite the vertices of tetrahedra.
    """
    own, states = np.empty(len(triangles)), np.empty(tetrahedra.shape, np.int8)
    _of_triangles(points, tetrahedra, rows, triangles, own, states)
    return own, _beaten(rows, _decided(points, tetrahedra, states), len(triangles))


def edges_of_triangles(
    points: np.ndarray, triangles: np.ndarray, rows: np.ndarray, edges: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Squared halves of the lengths of edges, float64 (e,), and whether they are not Gabriel, bool (e,)."""
    half = 0.5 * (points[edges[:, 0]] - points[edges[:, 1]])
    states = np.empty(triangles.shape, np.int8)
    _of_edges(points, triangles, states)
    return (half * half).sum(axis=1), _beaten(rows, _decided(points, triangles, states), len(edges))


def _beaten(rows: np.ndarray, inside: np.ndarray, faces: int) -> np.ndarray:
    beaten = np.zeros(faces, bool)
    beaten[rows[inside]] = True
    return beaten
