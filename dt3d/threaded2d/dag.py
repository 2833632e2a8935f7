"""Location in the history: from a root to the leaf that contains a site (Kohout et al. 2004, section 3.1).

Nothing is locked. A node's vertices never change, and its children are written before the word that names
them. A node is visited once, since the history has no circles; so a location that has visited more nodes than
there are is in a structure that is broken.
"""

from __future__ import annotations

from .._errors import InternalError
from .._numba.atomics import load_acquire
from .._numba.kernel_cache import cached_njit
from .geometry import root_of, side
from .mesh import CHILD


@cached_njit(forceinline=True)
def child_of(points, nodes, t, child, q, w):
    """The child of t that contains q; ``child`` is the word of t that names them."""
    first = child >> 1
    p = nodes[first, 0]
    if child & 1 == 0:
        # flipped: the new edge leads from p to the third vertex of the first child
        return first + 1 if side(points, nodes, p, nodes[first, 2], q, w) > 0 else first
    # subdivided: three sectors about p, of half a turn at most
    if side(points, nodes, p, nodes[t, 0], q, w) >= 0:
        return first if side(points, nodes, p, nodes[t, 1], q, w) <= 0 else first + 1
    return first + 2 if side(points, nodes, p, nodes[t, 2], q, w) >= 0 else first + 1


@cached_njit(forceinline=True)
def descend(points, nodes, t, q, w):
    """The leaf below t that contains q, and how many nodes were visited."""
    visited = 0
    while True:
        child = load_acquire(nodes, (t, CHILD))
        if child < 0:
            return t, visited
        t = child_of(points, nodes, t, child, q, w)
        visited += 1
        if visited > len(nodes):
            msg = "the history of a 2D triangulation goes round in circles"
            raise InternalError(msg)


@cached_njit(forceinline=True)
def locate(points, nodes, q, w):
    """The leaf that contains q, and how many nodes were visited on the way from its root."""
    return descend(points, nodes, root_of(points, nodes, q, w), q, w)
