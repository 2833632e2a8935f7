"""Location in the history: from a root to the leaf that contains a site (Kohout et al. 2004, section 3.1).

Nothing is locked. A node's vertices never change, and its children are written before the word that names
them. A node is visited once, since the history has no circles; so a location that has visited more nodes than
there are is in a structure that is broken.
"""

from __future__ import annotations

from .._errors import InternalError
from .._numba.atomics import load_acquire
from .._numba.kernel_cache import cached_njit
from . import columns as c
from .columns import first_child, is_subdivided
from .geometry import root_of, side_of_line


@cached_njit(forceinline=True)
def child_of(mesh, t, children, q):
    """The child of t that contains q; ``children`` is the word of t that names them."""
    nodes, first = mesh.nodes, first_child(children)
    p = nodes[first, 0]
    if not is_subdivided(children):
        # flipped: the new edge leads from p to the third vertex of the first child
        return first + 1 if side_of_line(mesh, p, nodes[first, 2], q) > 0 else first
    # subdivided: three sectors about p, of half a turn at most
    if side_of_line(mesh, p, nodes[t, 0], q) >= 0:
        return first if side_of_line(mesh, p, nodes[t, 1], q) <= 0 else first + 1
    return first + 2 if side_of_line(mesh, p, nodes[t, 2], q) >= 0 else first + 1


@cached_njit(forceinline=True)
def descend(mesh, t, q):
    """The leaf below t that contains q, and how many nodes were visited."""
    visited = 0
    while True:
        children = load_acquire(mesh.nodes, (t, c.CHILD))
        if children < 0:
            return t, visited
        t = child_of(mesh, t, children, q)
        visited += 1
        if visited > len(mesh.nodes):
            msg = "the history of a 2D triangulation goes round in circles"
            raise InternalError(msg)


@cached_njit(forceinline=True)
def locate(mesh, q):
    """The leaf that contains q, and how many nodes were visited on the way from its root."""
    return descend(mesh, root_of(mesh, q), q)
