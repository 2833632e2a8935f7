"""The cavity of a site: the tetrahedra that it destroys, and the facets around them.

Most are decided by the rounded spheres that tetrahedra keep, the others by exact arithmetic, and ties by the
symbolic perturbation.
"""

from __future__ import annotations

import numba
from numba.core import types
from numba.extending import intrinsic

from .._numba.by_address import call_at
from .._numba.kernel_cache import cached_njit
from ..predicates.layout import CONFLICTS
from ..predicates.open_stages import FUNCTIONS, WORKSPACE
from ..predicates.space import inside, orientation_with
from .mesh import (
    INFINITE,
    MESH,
    mark,
    neighbor,
    prefetch_sphere,
    prefetch_tetrahedron,
    radius_above,
    radius_below,
    squared_distance,
    tetrahedron,
    unmark,
    vertex,
)
from .ownership import owns_all

NOT_OWNED, NO_ROOM = -1, -2  # in place of a number of facets


@cached_njit(inline="always", error_model="numpy")
def search(mesh, start, site, part, scratch, w):
    """Find the tetrahedra in conflict with a site, from ``start`` on, and the facets around them.

    Returns the number of tetrahedra, which are marked; of facets; and of tetrahedra that were tested. The
    number of facets is `NOT_OWNED` where the cavity has tetrahedra that the thread does not own, `NO_ROOM`
    where there is no room for more.
    """
    cavity, rim, outer = scratch.cavity, scratch.rim, scratch.outer
    whole = part.length == part.sites
    room = min(len(cavity), len(outer)) - 4
    size, facets, seen, tested = 0, 0, 0, 0
    # what it does not own it must not mark even for a moment, in which another thread may look at it
    if whole or owns_all(mesh, start, part):
        cavity[0] = start
        mark(mesh, start)
        size = 1
    else:
        facets = NOT_OWNED
    while seen < size and facets >= 0:
        t = numba.int64(cavity[seen])
        seen += 1
        if size > room or facets > room:
            facets = NO_ROOM
            break
        if seen < size:
            following = numba.int64(cavity[seen])
            for k in range(4):
                prefetch_sphere(mesh, tetrahedron(neighbor(mesh, following, k)))
        for k in range(4):
            beyond = neighbor(mesh, t, k)
            u = tetrahedron(beyond)
            above = radius_above(mesh, u)
            if above >= 0:  # not in the cavity yet
                tested += 1
                squared = squared_distance(mesh, u, site)
                if squared > above or not (
                    squared < radius_below(mesh, u) or call_conflicts(w, mesh, u, site.v, w)
                ):
                    rim[0, facets] = vertex(mesh, t, k ^ 1)
                    rim[1, facets] = vertex(mesh, t, k ^ 2)
                    rim[2, facets] = vertex(mesh, t, k ^ 3)
                    outer[facets] = beyond
                    facets += 1
                elif whole or owns_all(mesh, u, part):
                    mark(mesh, u)
                    cavity[size] = u
                    prefetch_tetrahedron(mesh, u)
                    size += 1
                else:
                    facets = NOT_OWNED
                    break
    return size, facets, tested


@cached_njit(inline="always", error_model="numpy")
def unmark_cavity(mesh, cavity, size):
    """Unmark what was found."""
    for i in range(size):
        unmark(mesh, numba.int64(cavity[i]))


@cached_njit
def conflicts(mesh, t, v, w):
    """Whether site v destroys tetrahedron t."""
    corners = _signed_vertices(mesh, t)
    for ghost in range(4):
        if corners[ghost] < 0:
            # the site in the place of the infinite vertex: beyond the facet, or on its plane
            sign = orientation_with(mesh.points, corners, ghost, v, w)
            if sign != 0:
                return sign > 0
            # the sphere of the tetrahedron within meets the plane in the facet's circle
            corners = _signed_vertices(mesh, tetrahedron(neighbor(mesh, t, ghost)))
            break
    return inside(mesh.points, corners, v, w)


FUNCTIONS.add(CONFLICTS, conflicts, (MESH, types.int64, types.int64, WORKSPACE))


@intrinsic
def call_conflicts(typingctx, work, mesh, t, v, w):
    """The same, compiled apart from the kernel; ``work`` is the workspace, as is ``w``."""
    return call_at(work, CONFLICTS, types.boolean, FUNCTIONS)


@cached_njit
def _signed_vertices(mesh, t):
    """The vertices of tetrahedron t, -1 for the infinite one."""
    return (
        _signed(vertex(mesh, t, 0)),
        _signed(vertex(mesh, t, 1)),
        _signed(vertex(mesh, t, 2)),
        _signed(vertex(mesh, t, 3)),
    )


@cached_njit
def _signed(v):
    return -1 if v == INFINITE else v
