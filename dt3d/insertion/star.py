"""The star of a new site: a tetrahedron at every facet of the cavity, linked with those beside it."""

from __future__ import annotations

import numba
from numba.core import types
from numba.extending import intrinsic

from .._numba.by_address import call_at
from .._numba.kernel_cache import cached_njit
from ..predicates.layout import LINK_WIDE
from ..predicates.open_stages import FUNCTIONS
from .mesh import (
    INFINITE,
    MESH,
    facet,
    free_slot,
    label,
    next_free,
    offset,
    set_label,
    set_neighbor,
    set_tetrahedron_of,
    set_vertex,
    side,
    tetrahedron,
)
from .worker import SCRATCH, TABLE_BITS, FreeSlots


@cached_njit(inline="always", error_model="numpy")
def number_vertices(mesh, site, scratch, facets):
    """Replace the vertices of the facets by 0, 1, 2, ...; returns how many there are.

    ``scratch`` gets the vertices, the infinite one first, a facet of each, and their coordinates relative to
    the site with the squared lengths. A label is valid if the vertex of that number agrees with it, so
    nothing has to be cleared. 0 where the facets have more vertices than a triangulated sphere, F / 2 + 2 of
    them.
    """
    rim, vertices = scratch.rim, scratch.vertices
    most = (facets >> 1) + 3
    count = 1
    for f in range(facets):
        for i in range(3):
            v = numba.int64(rim[i, f])
            number = 0
            if v != INFINITE:
                number = label(mesh, v)
                if number >= count or numba.int64(vertices[number]) != v:
                    if count == most:
                        return 0
                    number = count
                    vertices[count] = v
                    scratch.facet_of[count] = f
                    set_label(mesh, v, count)
                    x, y, z = offset(mesh, v, site)
                    scratch.x[count], scratch.y[count], scratch.z[count] = x, y, z
                    scratch.squared[count] = x * x + y * y + z * z
                    count += 1
            rim[i, f] = number
    return count


@cached_njit(inline="always", error_model="numpy")
def make_tetrahedra(mesh, v, scratch, size, facets, free):
    """Write the star of site v, whose cavity has ``size`` tetrahedra, without the links within it.

    The slots of the cavity serve first, which are in the cache, then those on the list of free ones, then
    fresh ones. Returns the list without what was used, and with what the cavity left.
    """
    cavity, vertices, p, q, r = scratch.cavity, scratch.vertices, scratch.p, scratch.q, scratch.r
    first, listed, fresh = free.first, free.listed, free.fresh
    for f in range(facets):
        if f < size:
            t = numba.int64(cavity[f])
        elif listed > 0:
            t = first
            first = next_free(mesh, t)
            listed -= 1
        else:
            t = fresh
            fresh += 1
        scratch.slots[f] = t
        set_vertex(mesh, t, 0, v)
        set_vertex(mesh, t, 1, vertices[numba.int64(p[f])])
        set_vertex(mesh, t, 2, vertices[numba.int64(q[f])])
        set_vertex(mesh, t, 3, vertices[numba.int64(r[f])])
        beyond = numba.int64(scratch.outer[f])
        set_neighbor(mesh, t, 0, beyond)
        set_neighbor(mesh, tetrahedron(beyond), side(beyond), facet(t, 0))
    for f in range(facets, size):
        t = numba.int64(cavity[f])
        free_slot(mesh, t, first)
        first = t
        listed += 1
    return FreeSlots(first, listed, fresh, free.fresh_end)


@cached_njit(inline="always", error_model="numpy")
def note_tetrahedra(mesh, v, scratch, count):
    """Let site v and the vertices around it know a tetrahedron of theirs."""
    slots = scratch.slots
    set_tetrahedron_of(mesh, v, numba.int64(slots[0]))
    for i in range(1, count):
        u = numba.int64(scratch.vertices[i])
        set_tetrahedron_of(mesh, u, numba.int64(slots[numba.int64(scratch.facet_of[i])]))


@cached_njit(inline="always", error_model="numpy")
def link(mesh, scratch, facets, count, w):
    """Make neighbours of star tetrahedra that share an edge of the rim; whether each edge has two."""
    if count <= 1 << TABLE_BITS:
        linked = link_narrow(mesh, scratch, facets)
    else:
        linked = call_link_wide(w, mesh, scratch, facets)
    return linked


@cached_njit(inline="always", error_model="numpy")
def link_narrow(mesh, scratch, facets):
    """In a table of directed edges.

    The facet opposite p belongs to the directed edge (q, r) as seen from the site, and to (r, q) as seen
    from the other tetrahedron that has it. Whether what was written and what was read have one sum: in a torn
    star a place is read that was not written.
    """
    p, q, r, slots, edges = scratch.p, scratch.q, scratch.r, scratch.slots, scratch.edges
    rest = 0
    for f in range(facets):
        i, j, k = numba.int64(p[f]), numba.int64(q[f]), numba.int64(r[f])
        t = numba.int64(slots[f])
        edges[j << TABLE_BITS | k] = facet(t, 1)
        edges[k << TABLE_BITS | i] = facet(t, 2)
        edges[i << TABLE_BITS | j] = facet(t, 3)
        rest += facet(t, 1) + facet(t, 2) + facet(t, 3)
    for f in range(facets):
        i, j, k = numba.int64(p[f]), numba.int64(q[f]), numba.int64(r[f])
        t = numba.int64(slots[f])
        a, b, c = edges[k << TABLE_BITS | j], edges[i << TABLE_BITS | k], edges[j << TABLE_BITS | i]
        set_neighbor(mesh, t, 1, a)
        set_neighbor(mesh, t, 2, b)
        set_neighbor(mesh, t, 3, c)
        rest -= numba.int64(a) + numba.int64(b) + numba.int64(c)
    return rest == 0


@cached_njit(error_model="numpy")
def link_wide(mesh, scratch, facets):
    """In a hash table of a power of two slots, over 6 * facets, for any number of vertices.

    Half of the slots stay free, so every search comes to its key or to a free slot. Whether all edges were
    found, each with its reverse.
    """
    p, q, r, slots, keys = scratch.p, scratch.q, scratch.r, scratch.slots, scratch.keys
    size = 64
    while size < 6 * facets:
        size *= 2
    keys[:size] = -1
    for f in range(facets):
        for i in range(3):
            key = _edge(p[f], q[f], r[f], i)
            h = _first_slot(key, size)
            while keys[h] >= 0:
                h = (h + 1) & (size - 1)
            keys[h] = key
            scratch.values[h] = facet(numba.int64(slots[f]), i + 1)
    for f in range(facets):
        for i in range(3):
            key = _edge(p[f], q[f], r[f], i)
            key = (key & 0xFFFFFFFF) << 32 | key >> 32
            h = _first_slot(key, size)
            while keys[h] != key:
                if keys[h] < 0:
                    return False
                h = (h + 1) & (size - 1)
            set_neighbor(mesh, numba.int64(slots[f]), i + 1, scratch.values[h])
    return True


FUNCTIONS.add(LINK_WIDE, link_wide, (MESH, SCRATCH, types.int64))


@intrinsic
def call_link_wide(typingctx, work, mesh, scratch, facets):
    """The same, compiled apart from the kernel; ``work`` is the workspace."""
    return call_at(work, LINK_WIDE, types.boolean, FUNCTIONS)


@cached_njit(inline="always")
def _edge(p, q, r, i):
    """The directed edge opposite the i-th of three vertices."""
    a, b = (q, r) if i == 0 else ((r, p) if i == 1 else (p, q))
    return numba.int64(a) << 32 | numba.int64(b)


@cached_njit(inline="always")
def _first_slot(key, size):
    return ((key * 0x9E3779B97F4A7C1) >> 20) & (size - 1)
