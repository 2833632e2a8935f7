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

import numba

from .._numba.kernel_cache import cached_njit
from .layout import INFINITE


@cached_njit(inline="always")
def owns(v, low, length, n):
    """Whether site v is among the ``length`` sites from ``low`` on, in the cyclic order of n sites."""
    place = numba.int64(v) - low
    if place < 0:
        place += n
    return place < length


@cached_njit(inline="always")
def owns_all(mesh, t, low, length, n):
    """Whether all finite vertices of tetrahedron t are among those sites."""
    all_owned = True
    for k in range(4):
        v = mesh[8 * t + k]
        if v != INFINITE and not owns(v, low, length, n):
            all_owned = False
    return all_owned


@cached_njit(inline="always")
def owns_one(mesh, t, low, length, n):
    """Whether some finite vertex of tetrahedron t is among those sites."""
    one_owned = False
    for k in range(4):
        v = mesh[8 * t + k]
        if v != INFINITE and owns(v, low, length, n):
            one_owned = True
    return one_owned
