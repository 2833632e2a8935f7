"""Insertion of sites one by one: walk, cavity, star (A. Bowyer 1981, D. F. Watson 1981).

The triangulation always covers space: beyond each hull facet lies a ghost tetrahedron, whose fourth vertex
is the vertex at infinity. Sites that are cospherical are decided by the symbolic perturbation of their
heights |p|^2 + e_p (O. Devillers, M. Teillaud: Perturbations and vertex removal in a 3D Delaunay
triangulation, SODA 2003), so the result does not depend on the order of insertion, and no tetrahedron is
flat.

The parts of `insert` are inlined into one function, and its arrays have no owner: a call between compiled
functions counts references to every array that it passes, which took a fifth of the time.
"""

from __future__ import annotations

import numba

from .._numba.kernel_cache import cached_njit
from .._numba.unowned import unowned
from .cavity import NO_ROOM, search, unmark_cavity
from .mesh import INFINITE, site_at_hand, start_for, vertex
from .ownership import Part
from .spheres import flat, round_spheres
from .star import link, make_tetrahedra, note_tetrahedra, number_vertices
from .walk import nearby_start, walk
from .worker import FreeSlots, State

# what `insert` returns when it could not go on
DONE, NEEDS_SLOTS, NEEDS_SCRATCH, ENDLESS_WALK, OCCUPIED, TORN_CAVITY, FLAT_STAR = range(7)
# those of them that no right run has, and that end it
FAULTS = {
    ENDLESS_WALK: "a walk to a site visits more tetrahedra than there are",
    OCCUPIED: "a site is where another one is already",
    TORN_CAVITY: "the facets around a cavity do not close to a sphere",
    FLAT_STAR: "a site makes a tetrahedron that is flat or turned",
}


@cached_njit(nogil=True, error_model="numpy")
def insert(mesh, todo, state, scratch, scale, w):
    """Insert the sites of ``todo`` from `State.NEXT` to before `State.STOP`, as far as ownership allows.

    The others go to the front of ``todo``, `State.DEFERRED` of them. Returns `DONE`, or what is missing; then
    no site is half inserted: supply it and call again. Or one of `FAULTS`, when the tetrahedra are of no more
    use.
    """
    mesh, todo, state = unowned(mesh), unowned(todo), unowned(state)
    scratch, w = unowned(scratch), unowned(w)
    part = Part(state[State.FIRST], state[State.LENGTH], state[State.SITES])
    free = FreeSlots(state[State.FREE], state[State.FREE_COUNT], state[State.FRESH], state[State.FRESH_END])
    following, stop, deferred = state[State.NEXT], state[State.STOP], state[State.DEFERRED]
    last = state[State.LAST]
    walked = tested = created = 0
    result = DONE
    while following < stop:
        site = site_at_hand(mesh, numba.int64(todo[following]))
        start = start_for(mesh, site.v, last)
        for attempt in range(2):  # one call, which is inlined once
            last, found, steps = walk(mesh, start, site, part, scale.slack, w)
            walked += steps
            if found or steps < 0 or attempt:
                break
            # the next walk would begin where this one stopped, and stop there, too
            start = nearby_start(mesh, site.v, part)
            if start < 0:
                break
        if steps < 0:
            result = ENDLESS_WALK
            break
        size, facets = 0, -1
        if found:
            if _occupied(mesh, last, site):
                result = OCCUPIED
                break
            size, facets, tests = search(mesh, last, site, part, scratch, w)
            tested += tests
        if facets == NO_ROOM:
            result = NEEDS_SCRATCH
        elif facets > size + free.listed + (free.fresh_end - free.fresh):
            result = NEEDS_SLOTS
        if facets < 0 or result != DONE:
            unmark_cavity(mesh, scratch.cavity, size)
            if result != DONE:
                break
            todo[deferred] = site.v
            deferred += 1
            following += 1
            continue
        count = number_vertices(mesh, site, scratch, facets)
        # Euler's relation of a triangulated sphere; number 0 is the infinite vertex's, used or not
        if facets != 2 * count - 4 and facets != 2 * count - 6:
            result = TORN_CAVITY
            break
        free = make_tetrahedra(mesh, site.v, scratch, size, facets, free)
        note_tetrahedra(mesh, site.v, scratch, count)
        if not link(mesh, scratch, facets, count, w):
            result = TORN_CAVITY
            break
        if round_spheres(mesh, site, scratch, facets, scale.reach) > 0 and flat(
            mesh, site.v, scratch, facets, w
        ):
            result = FLAT_STAR
            break
        last = numba.int64(scratch.slots[0])
        created += facets
        following += 1
    state[State.FREE], state[State.FREE_COUNT], state[State.FRESH] = free.first, free.listed, free.fresh
    state[State.NEXT], state[State.DEFERRED], state[State.LAST] = following, deferred, last
    state[State.WALKED] += walked
    state[State.TESTED] += tested
    state[State.CREATED] += created
    return result


@cached_njit(inline="always", error_model="numpy")
def _occupied(mesh, t, site):
    """Whether a site is where a vertex is; which would be one of the four of t, which contains it."""
    occupied = False
    for k in range(4):
        v = vertex(mesh, t, k)
        if v != INFINITE:
            other = site_at_hand(mesh, v)
            if other.x == site.x and other.y == site.y and other.z == site.z:
                occupied = True
    return occupied
