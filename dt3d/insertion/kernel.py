"""Insertion of sites one by one: walk, cavity, star (A. Bowyer 1981, D. F. Watson 1981).

The triangulation always covers space: beyond each hull facet lies a ghost tetrahedron, whose fourth vertex
is the vertex at infinity. Sites that are cospherical are decided by the symbolic perturbation of their
heights |p|^2 + e_p (O. Devillers, M. Teillaud: Perturbations and vertex removal in a 3D Delaunay
triangulation, SODA 2003), so the result does not depend on the order of insertion, and no tetrahedron is
flat.

The parts of `insert` are inlined into one function: a call between compiled functions counts references to
every array that it passes, which took a fifth of the time.
"""

from __future__ import annotations

import numba
import numpy as np

from .._numba.kernel_cache import cached_njit
from .._numba.prefetch import prefetch
from .conflict import conflicts
from .layout import DEAD, INFINITE
from .ownership import owns, owns_all
from .spheres import flat, round_spheres
from .star import NARROW, link_narrow, link_wide, number_vertices
from .walk import walk

# what `insert` returns when it could not go on
DONE, NEEDS_SLOTS, NEEDS_SCRATCH, ENDLESS_WALK, OCCUPIED, TORN_CAVITY, FLAT_STAR = range(7)
# those of them that no right run has, and that end it
FAULTS = {
    ENDLESS_WALK: "a walk to a site visits more tetrahedra than there are",
    OCCUPIED: "a site is where another one is already",
    TORN_CAVITY: "the facets around a cavity do not close to a sphere",
    FLAT_STAR: "a site makes a tetrahedron that is flat or turned",
}

# places of `state`, one for each thread
(NEXT, STOP, DEFERRED) = range(3)  # in `todo`
(LAST, FREE, FREE_COUNT, FRESH, FRESH_END) = range(3, 8)  # tetrahedra
(LOW, LENGTH, SITES) = range(8, 11)  # what the thread owns
(WALKED, TESTED, CREATED) = range(11, 14)
STATE = 14

BESIDE = 16  # sites on either side on the curve, from one of which a walk that stopped is begun again


@cached_njit(inline="always", error_model="numpy")
def _search(points, mesh, spheres, radii, t, site, x, y, z, low, length, n, cavity, rim, outer, w):
    """The tetrahedra in conflict with a site, from t on, and the facets around them; the numbers of both.

    Those in ``cavity`` are marked. The number of facets is -1 where the cavity has tetrahedra that the
    thread does not own, -2 where there is no room for more. Also returns how many were tested.
    """
    whole = length == n
    room = min(len(cavity), len(outer)) - 4
    cavity[0] = t
    radii[8 * t + 7] = -radii[8 * t + 7]
    size, facets, seen, tested = 1, 0, 0, 0
    if not whole and not owns_all(mesh, t, low, length, n):
        facets = -1
    while seen < size and facets >= 0:
        t = numba.int64(cavity[seen])
        seen += 1
        if size > room or facets > room:
            facets = -2
            break
        if seen < size:
            soon = 8 * numba.int64(cavity[seen])
            for k in range(4):
                prefetch(radii, numba.int64(mesh[soon + 4 + k] & np.uint32(0xFFFFFFFC)) << 1)
        for k in range(4):
            step = numba.int64(mesh[8 * t + 4 + k])
            u = step >> 2
            high = radii[8 * u + 7]
            if high >= 0:  # not in the cavity yet
                tested += 1
                dx, dy, dz = spheres[4 * u] - x, spheres[4 * u + 1] - y, spheres[4 * u + 2] - z
                squared = dx * dx + dy * dy + dz * dz
                if squared > high or not (squared < radii[8 * u + 6] or conflicts(points, mesh, u, site, w)):
                    rim[0, facets] = mesh[8 * t | k ^ 1]
                    rim[1, facets] = mesh[8 * t | k ^ 2]
                    rim[2, facets] = mesh[8 * t | k ^ 3]
                    outer[facets] = step
                    facets += 1
                elif whole or owns_all(mesh, u, low, length, n):
                    radii[8 * u + 7] = -high
                    cavity[size] = u
                    prefetch(mesh, 8 * u)
                    size += 1
                else:
                    facets = -1
                    break
    return size, facets, tested


@cached_njit(inline="always", error_model="numpy")
def _occupied(rows, mesh, t, x, y, z):
    """Whether a place in tetrahedron t is that of a vertex; which would be one of the four of t."""
    occupied = False
    for k in range(4):
        v = numba.int64(mesh[8 * t + k])
        if v != INFINITE and rows[4 * v] == x and rows[4 * v + 1] == y and rows[4 * v + 2] == z:
            occupied = True
    return occupied


@cached_njit(nogil=True, error_model="numpy")
def insert(points, rows, labels, mesh, spheres, radii, todo, state, scratch, slack, reach, w):
    """Insert the sites todo[state[NEXT]], ... before state[STOP] that the thread can; see `ownership`.

    Those that it cannot go to the front of ``todo``, state[DEFERRED] of them. Returns `DONE`, or what is
    short; then nothing is half done: supply it and call again. Or one of `FAULTS`, when the tetrahedra are of
    no more use. ``points``, ``rows`` and ``labels`` are views of one array, so are ``spheres`` and ``radii``;
    see `layout`.
    """
    cavity, rim, outer, near, at, rel, edges, keys, values = scratch
    p, q, r, slots = rim[0], rim[1], rim[2], rim[3]
    xs, ys, zs, lengths = rel[0], rel[1], rel[2], rel[3]
    n, low, length = state[SITES], state[LOW], state[LENGTH]
    free, free_count, fresh, fresh_end = state[FREE], state[FREE_COUNT], state[FRESH], state[FRESH_END]
    following, stop, deferred, last = state[NEXT], state[STOP], state[DEFERRED], state[LAST]
    walked = tested = created = 0
    result = DONE
    while following < stop:
        site = numba.int64(todo[following])
        x, y, z = rows[4 * site], rows[4 * site + 1], rows[4 * site + 2]
        last, found, steps = walk(points, rows, mesh, last, site, low, length, n, slack, w)
        walked += steps
        if not found:
            # the next walk would begin where this one stopped, and stop there, too
            for i in range(2, 2 * BESIDE + 2 if steps >= 0 else 0):
                beside = site + (i >> 1 if i & 1 else -(i >> 1))
                if 0 <= beside < n and owns(beside, low, length, n) and labels[8 * beside + 7] != 0:
                    last = numba.int64(labels[8 * beside + 7]) - 1
                    last, found, steps = walk(points, rows, mesh, last, site, low, length, n, slack, w)
                    walked += steps
                    break
            if steps < 0:
                result = ENDLESS_WALK
                break
        size, facets = 0, -1
        if found:
            if _occupied(rows, mesh, last, x, y, z):
                result = OCCUPIED
                break
            size, facets, tests = _search(
                points, mesh, spheres, radii, last, site, x, y, z, low, length, n, cavity, rim, outer, w
            )
            tested += tests
        if facets == -2:
            result = NEEDS_SCRATCH
        elif facets > size + free_count + (fresh_end - fresh):
            result = NEEDS_SLOTS
        if facets < 0 or result != DONE:
            for i in range(size):
                c = numba.int64(cavity[i])
                radii[8 * c + 7] = abs(radii[8 * c + 7])
            if result != DONE:
                break
            todo[deferred] = site
            deferred += 1
            following += 1
            continue

        count = number_vertices(rows, labels, x, y, z, rim, facets, near, rel, at)
        # Euler's relation of a triangulated sphere; number 0 is the infinite vertex's, used or not
        if facets != 2 * count - 4 and facets != 2 * count - 6:
            result = TORN_CAVITY
            break
        for f in range(facets):
            # the slots of the cavity first, which are in the cache
            if f < size:
                new = numba.int64(cavity[f])
            elif free_count > 0:
                new = free
                free = numba.int64(mesh[8 * new + 4])
                free_count -= 1
            else:
                new = fresh
                fresh += 1
            slots[f] = new
            mesh[8 * new] = site
            mesh[8 * new + 1] = near[numba.int64(p[f])]
            mesh[8 * new + 2] = near[numba.int64(q[f])]
            mesh[8 * new + 3] = near[numba.int64(r[f])]
            out = numba.int64(outer[f])
            mesh[8 * new + 4] = out
            mesh[8 * (out >> 2) + 4 + (out & 3)] = new << 2
        labels[8 * site + 7] = slots[0] + 1
        for i in range(1, count):
            labels[8 * numba.int64(near[i]) + 7] = slots[numba.int64(at[i])] + 1
        for f in range(facets, size):
            c = numba.int64(cavity[f])
            mesh[8 * c] = DEAD
            mesh[8 * c + 4] = free
            free = c
            free_count += 1
        if count <= 1 << NARROW:
            linked = link_narrow(mesh, p, q, r, slots, facets, edges)
        else:
            linked = link_wide(mesh, p, q, r, slots, facets, keys, values)
        if not linked:
            result = TORN_CAVITY
            break
        unproved = round_spheres(xs, ys, zs, lengths, p, q, r, slots, facets, x, y, z, reach, spheres, radii)
        if unproved > 0 and flat(points, radii, site, p, q, r, near, slots, facets, w):
            result = FLAT_STAR
            break
        last = numba.int64(slots[0])
        created += facets
        following += 1
    state[FREE], state[FREE_COUNT], state[FRESH] = free, free_count, fresh
    state[NEXT], state[DEFERRED], state[LAST] = following, deferred, last
    state[WALKED] += walked
    state[TESTED] += tested
    state[CREATED] += created
    return result
