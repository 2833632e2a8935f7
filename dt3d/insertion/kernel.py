"""Insertion of sites one by one: walk, cavity, star (A. Bowyer 1981, D. F. Watson 1981).

The triangulation always covers space: beyond each hull facet lies a ghost tetrahedron, whose fourth vertex
is the vertex at infinity. Sites that are cospherical are decided by the symbolic perturbation of their
heights |p|^2 + e_p (O. Devillers, M. Teillaud: Perturbations and vertex removal in a 3D Delaunay
triangulation, SODA 2003), so the result does not depend on the order of insertion, and no tetrahedron is
flat.

Arrays. ``vertices[t]`` are four sites or `INFINITE`; a tetrahedron is positive, a ghost would be if its
infinite vertex were a site beyond its facet. ``neighbors[t, k]`` is 4 u + j where the k-th facet of t
(opposite its k-th vertex) is the j-th of u. `DEAD` in ``vertices[t, 0]`` marks a free slot.
"""

from __future__ import annotations

import numba
import numpy as np

from ..predicates.perturbed import inside, orientation_with

INFINITE = -1
DEAD = -2
UNKNOWN = -1  # in `neighbors`: not found yet

# what `insert` returns when it could not go on
DONE = 0
FULL = 1

# places of `state`
NEXT, SLOTS, FREE, LAST, STAMP, WALKED, TESTED, CREATED = range(8)


@numba.njit(cache=True)
def _corners(vertices, t):
    return vertices[t, 0], vertices[t, 1], vertices[t, 2], vertices[t, 3]


@numba.njit(cache=True)
def _infinite_corner(v):
    """Which vertex of a ghost is the infinite one; -1 for finite tetrahedra."""
    if v[0] == INFINITE:
        return 0
    if v[1] == INFINITE:
        return 1
    if v[2] == INFINITE:
        return 2
    return 3 if v[3] == INFINITE else -1


@numba.njit(cache=True)
def _conflicts(points, rank, vertices, neighbors, t, site, w):
    """Whether a site destroys tetrahedron t."""
    v = _corners(vertices, t)
    ghost = _infinite_corner(v)
    if ghost >= 0:
        # the site in the place of the infinite vertex: beyond the facet, or on its plane
        sign = orientation_with(points, v, ghost, site, w)
        if sign != 0:
            return sign > 0
        # the sphere of the tetrahedron within meets the plane in the facet's circle
        v = _corners(vertices, neighbors[t, ghost] >> 2)
    return inside(points, rank, v, site, w)


@numba.njit(cache=True)
def _walk(points, vertices, neighbors, t, site, w):
    """From t to the tetrahedron that contains a site, or a ghost whose facet it is beyond; and the steps."""
    ghost = _infinite_corner(_corners(vertices, t))
    if ghost >= 0:
        t = neighbors[t, ghost] >> 2
    came, steps = -1, 0
    while True:
        v = _corners(vertices, t)
        if _infinite_corner(v) >= 0:
            return t, steps
        moved = False
        for i in range(4):
            k = (i + steps) & 3  # another first facet each time
            if k != came and orientation_with(points, v, k, site, w) < 0:
                step = neighbors[t, k]
                t, came = step >> 2, step & 3
                steps += 1
                moved = True
                break
        if not moved:
            return t, steps


@numba.njit(cache=True)
def link(neighbors, t, k, u, j):
    """Make the k-th facet of t and the j-th of u one."""
    neighbors[t, k] = 4 * u + j
    neighbors[u, j] = 4 * t + k


@numba.njit(nogil=True, cache=True)
def insert(points, rank, order, store, state, stop, w):
    """Insert the sites order[state[NEXT]], ... up to order[stop - 1]; `DONE`, or `FULL` where memory ran out.

    After `FULL` nothing is half done: give longer arrays and call again.
    """
    vertices, neighbors, free, marks, made, cavity, rim = store
    capacity = len(vertices)
    while state[NEXT] < stop:
        site = order[state[NEXT]]
        t, steps = _walk(points, vertices, neighbors, state[LAST], site, w)
        state[WALKED] += steps

        # the cavity: all tetrahedra in conflict; marks[t] is the stamp for those, its negative for tested
        # others
        state[STAMP] += 1
        stamp = state[STAMP]
        marks[t] = stamp
        cavity[0] = t
        size, seen, facets = 1, 0, 0
        while seen < size:
            t = cavity[seen]
            seen += 1
            for k in range(4):
                u = neighbors[t, k] >> 2
                if marks[u] == stamp:
                    continue
                if marks[u] != -stamp:
                    state[TESTED] += 1
                    if _conflicts(points, rank, vertices, neighbors, u, site, w):
                        marks[u] = stamp
                        if size == len(cavity):
                            state[STAMP] += 1
                            return FULL
                        cavity[size] = u
                        size += 1
                        continue
                    marks[u] = -stamp
                if facets == len(rim):
                    state[STAMP] += 1
                    return FULL
                rim[facets] = 4 * t + k
                facets += 1
        if state[SLOTS] + max(0, facets - state[FREE]) > capacity or state[FREE] + size > len(free):
            state[STAMP] += 1
            return FULL

        # the star: a tetrahedron from the site to each facet of the cavity's boundary
        for f in range(facets):
            t, k = rim[f] >> 2, rim[f] & 3
            if state[FREE] > 0:
                state[FREE] -= 1
                new = free[state[FREE]]
            else:
                new = state[SLOTS]
                state[SLOTS] += 1
            for i in range(4):
                vertices[new, i] = vertices[t, i]
                neighbors[new, i] = UNKNOWN
            vertices[new, k] = site
            marks[new] = 0
            outer = neighbors[t, k]
            link(neighbors, new, k, outer >> 2, outer & 3)
            made[4 * t + k] = new
        for f in range(facets):
            t, k = rim[f] >> 2, rim[f] & 3
            new = made[4 * t + k]
            for j in range(4):
                if neighbors[new, j] != UNKNOWN:
                    continue  # the outer one, or found from its other side
                # Turn about the edge that facets j and k of t share, through the cavity, to its boundary.
                # The star tetrahedron there has the edge and the site too; its fourth vertex is `turning`.
                turning = vertices[t, k]
                last, leave = t, j
                step = neighbors[t, j]
                while marks[step >> 2] == stamp:
                    last = step >> 2
                    leave = 0
                    while vertices[last, leave] != turning:
                        leave += 1
                    turning = vertices[last, step & 3]
                    step = neighbors[last, leave]
                other = made[4 * last + leave]
                for i in range(4):
                    if vertices[other, i] == turning:
                        link(neighbors, new, j, other, i)
        for i in range(size):
            vertices[cavity[i], 0] = DEAD
            free[state[FREE]] = cavity[i]
            state[FREE] += 1
        state[LAST] = made[rim[0]]
        state[CREATED] += facets
        state[NEXT] += 1
    return DONE


@numba.njit(cache=True)
def compact(vertices, neighbors, slots):
    """Finite tetrahedra without gaps: simplices and neighbors, int32 (m, 4), -1 beyond the hull."""
    number = np.full(slots, -1, np.int32)
    m = 0
    for t in range(slots):
        v = vertices[t]
        if v[0] != DEAD and v[0] != INFINITE and v[1] != INFINITE and v[2] != INFINITE and v[3] != INFINITE:
            number[t] = m
            m += 1
    simplices = np.empty((m, 4), np.int32)
    adjacent = np.empty((m, 4), np.int32)
    for t in range(slots):
        s = number[t]
        if s >= 0:
            for k in range(4):
                simplices[s, k] = vertices[t, k]
                adjacent[s, k] = number[neighbors[t, k] >> 2]
    return simplices, adjacent
