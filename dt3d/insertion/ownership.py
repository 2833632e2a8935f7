"""Who may change what: each thread owns the sites of one piece of the curve.

A thread changes a tetrahedron only if it owns all its finite vertices; a site whose cavity has others is
deferred to a later pass with other pieces. Between two joins of the threads, then,

* tetrahedra with vertices of several owners are changed by nobody, but for the slot of the neighbour
  beyond a facet whose finite vertices one thread owns, which only that thread changes;
* a tetrahedron with at least one vertex that a thread owns is either its own or changed by nobody, and so
  is what lies beyond a facet with such a vertex. The walk and the search of the cavity go through no
  others.

So no word is written by one thread and touched by another, and no lock or atomic operation is needed.
The triangulation is unique, so what is deferred changes the result as little as the order of insertion
does.
"""

from __future__ import annotations

from typing import NamedTuple

from .mesh import INFINITE, accessor, vertex


class Part(NamedTuple):
    """The sites that a thread owns: ``length`` from ``first`` on, in the cyclic order of all ``sites``."""

    first: int
    length: int
    sites: int


@accessor
def owns(part, v):
    """Whether site v is in a part."""
    place = v - part.first
    if place < 0:
        place += part.sites
    return place < part.length


@accessor
def owns_all(mesh, t, part):
    """Whether all finite vertices of tetrahedron t are in a part."""
    all_owned = True
    for k in range(4):
        v = vertex(mesh, t, k)
        if v != INFINITE and not owns(part, v):
            all_owned = False
    return all_owned


@accessor
def owns_some(mesh, t, part):
    """Whether some finite vertex of tetrahedron t is in a part."""
    some_owned = False
    for k in range(4):
        v = vertex(mesh, t, k)
        if v != INFINITE and owns(part, v):
            some_owned = True
    return some_owned
