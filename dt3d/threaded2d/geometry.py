"""Conflict and side, for sites and the vertices at infinity; exact.

A site is in conflict with a triangle if it lies in its circumcircle, where sites have the infinitesimal
heights of the symbolic perturbation, so that it is never on it. The circle of a ghost, the triangle beyond
the hull edge ab, is the half-plane beyond ab, and of its border the part between a and b.

Where the history has to tell which child of a ghost contains a site, the vertex at infinity is the end of the
ray that leads away from a centre. The centre is infinitesimally close to the first vertex of the first
triangle, and inside it: s0 + e (s1 - s0) + e^2 (s2 - s0). So no two sites lie on one ray, and each ray meets
the hull once.
"""

from __future__ import annotations

from numba.extending import intrinsic

from .._numba.kernel_cache import cached_njit
from .._numba.noinline import call_noinline
from ..predicates.plane import inside, orient2d
from .columns import INFINITE


@cached_njit
def _between(points, a, b, q):
    """Whether q, on the line ab and neither a nor b, lies between them."""
    if points[a, 0] != points[b, 0]:
        return (points[a, 0] < points[q, 0]) == (points[q, 0] < points[b, 0])
    return (points[a, 1] < points[q, 1]) == (points[q, 1] < points[b, 1])


@cached_njit
def _conflicts_with_ghost(points, a, b, q, w):
    sign = orient2d(points, a, b, q, w)
    return sign > 0 or (sign == 0 and _between(points, a, b, q))


@intrinsic
def _call_conflicts_with_ghost(typingctx, points, a, b, q, w):
    return call_noinline(typingctx, _conflicts_with_ghost, (points, a, b, q, w))


@cached_njit(forceinline=True)
def conflicts(points, a, b, c, q, w):
    """Whether site q is in conflict with the triangle abc, one vertex of which may be infinite.

    No vertex is q.
    """
    if min(a, b, c) >= 0:
        return inside(points, (a, b, c), q, w)
    if a == INFINITE:
        return _call_conflicts_with_ghost(points, b, c, q, w)
    if b == INFINITE:
        return _call_conflicts_with_ghost(points, c, a, q, w)
    return _call_conflicts_with_ghost(points, a, b, q, w)


@cached_njit
def _side_of_ray(points, s0, s1, s2, p, q, w):
    """Orientation of the centre, p and q; 0 only where p is q."""
    sign = orient2d(points, s0, p, q, w)
    if sign == 0:
        sign = orient2d(points, s1, p, q, w)
    if sign == 0:
        sign = orient2d(points, s2, p, q, w)
    return sign


@intrinsic
def _call_side_of_ray(typingctx, points, s0, s1, s2, p, q, w):
    return call_noinline(typingctx, _side_of_ray, (points, s0, s1, s2, p, q, w))


@cached_njit(forceinline=True)
def in_conflict(mesh, t, q):
    """Whether site q, which is no vertex of triangle t, is in conflict with it."""
    nodes = mesh.nodes
    return conflicts(mesh.points, nodes[t, 0], nodes[t, 1], nodes[t, 2], q, mesh.workspace)


@cached_njit(forceinline=True)
def side_of_line(mesh, p, v, q):
    """Where q lies from the line from site p to v, a site or infinite: 1 left, -1 right, 0 on it."""
    if v >= 0:
        return orient2d(mesh.points, p, v, q, mesh.workspace)
    nodes = mesh.nodes
    return _call_side_of_ray(mesh.points, nodes[0, 0], nodes[0, 1], nodes[0, 2], p, q, mesh.workspace)


@cached_njit
def _root_of(points, s0, s1, s2, q, w):
    # seen from the centre, q lies in the sector of one edge
    if _side_of_ray(points, s0, s1, s2, s0, q, w) >= 0:
        sector = 0 if _side_of_ray(points, s0, s1, s2, s1, q, w) <= 0 else 1
    else:
        sector = 2 if _side_of_ray(points, s0, s1, s2, s2, q, w) >= 0 else 1
    a, b = (s0, s1) if sector == 0 else ((s1, s2) if sector == 1 else (s2, s0))
    if orient2d(points, a, b, q, w) >= 0:
        return 0
    return 1 + (sector + 2) % 3


@cached_njit(forceinline=True)
def root_of(mesh, q):
    """The root, 0 to 3, that contains site q, which is not a vertex of the first triangle."""
    nodes = mesh.nodes
    return _root_of(mesh.points, nodes[0, 0], nodes[0, 1], nodes[0, 2], q, mesh.workspace)
