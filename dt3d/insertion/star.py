"""The star of a new site: a tetrahedron to every facet of the cavity, each in its place among the
others."""

from __future__ import annotations

import numba

from .._numba.kernel_cache import cached_njit
from .layout import INFINITE

NARROW = 6  # a star of up to 2^6 vertices is linked through a table of all edges


@cached_njit(inline="always", error_model="numpy")
def number_vertices(rows, labels, x, y, z, rim, facets, near, rel, at):
    """Replace the vertices of the facets by 0, 1, 2, ...; returns how many there are.

    ``near`` gets the vertices, the infinite one first, ``at`` a facet of each, ``rel`` their coordinates
    relative to x, y, z and the squared lengths. A label is valid if ``near`` agrees with it, so nothing
    has to be cleared. 0 where the facets have more vertices than a triangulated sphere, F / 2 + 2 of them.
    """
    most = (facets >> 1) + 3
    count = 1
    for f in range(facets):
        for i in range(3):
            v = numba.int64(rim[i, f])
            label = 0
            if v != INFINITE:
                label = numba.int64(labels[8 * v + 6])
                if label >= count or numba.int64(near[label]) != v:
                    if count == most:
                        return 0
                    label = count
                    near[count] = v
                    at[count] = f
                    labels[8 * v + 6] = count
                    vx, vy, vz = rows[4 * v] - x, rows[4 * v + 1] - y, rows[4 * v + 2] - z
                    rel[0, count], rel[1, count], rel[2, count] = vx, vy, vz
                    rel[3, count] = vx * vx + vy * vy + vz * vz
                    count += 1
            rim[i, f] = label
    return count


@cached_njit(inline="always", error_model="numpy")
def link_narrow(mesh, p, q, r, slots, facets, edges):
    """Make neighbours of star tetrahedra that share an edge of the rim, in a table of directed edges.

    The facet opposite p belongs to the directed edge (q, r) as seen from the site, and to (r, q) as seen
    from the other tetrahedron that has it. Whether what was written and what was read have one sum: in a torn
    star a place is read that was not written.
    """
    rest = 0
    for f in range(facets):
        i, j, k = numba.int64(p[f]), numba.int64(q[f]), numba.int64(r[f])
        t = numba.int64(slots[f]) << 2
        edges[j << NARROW | k] = t | 1
        edges[k << NARROW | i] = t | 2
        edges[i << NARROW | j] = t | 3
        rest += 3 * t + 6
    for f in range(facets):
        i, j, k = numba.int64(p[f]), numba.int64(q[f]), numba.int64(r[f])
        t = 8 * numba.int64(slots[f])
        a, b, c = edges[k << NARROW | j], edges[i << NARROW | k], edges[j << NARROW | i]
        mesh[t + 5], mesh[t + 6], mesh[t + 7] = a, b, c
        rest -= numba.int64(a) + numba.int64(b) + numba.int64(c)
    return rest == 0


@cached_njit(error_model="numpy")
def link_wide(mesh, p, q, r, slots, facets, keys, values):
    """The same for any number of vertices, in a hash table of a power of two slots, over 6 * facets.

    Half of the slots stay free, so every search comes to its key or to a free slot. Whether all edges were
    found, each with its reverse.
    """
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
            values[h] = slots[f] << 2 | (i + 1)
    for f in range(facets):
        for i in range(3):
            key = _edge(p[f], q[f], r[f], i)
            key = (key & 0xFFFFFFFF) << 32 | key >> 32
            h = _first_slot(key, size)
            while keys[h] != key:
                if keys[h] < 0:
                    return False
                h = (h + 1) & (size - 1)
            mesh[8 * numba.int64(slots[f]) + 5 + i] = values[h]
    return True


@cached_njit(inline="always")
def _edge(p, q, r, i):
    """The directed edge opposite the i-th of three vertices."""
    a, b = (q, r) if i == 0 else ((r, p) if i == 1 else (p, q))
    return numba.int64(a) << 32 | numba.int64(b)


@cached_njit(inline="always")
def _first_slot(key, size):
    return ((key * 0x9E3779B97F4A7C1) >> 20) & (size - 1)
