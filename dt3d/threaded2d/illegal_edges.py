"""Where illegal edges may be left: "we know where the collision problem occurred" (Kohout et al. 2004, 3.4).

Deadlocks leave stars behind that are not as an insertion by itself would have left them: that of a site whose
remaining swaps were given up, and that of the site whose thread went on over the other's unfinished star.
Their triangles are marked as soon as they are there. Every illegal edge, then and later, has a marked
triangle on one side of it, or one that descends from one in the history.

For let an insertion meet triangles that do not descend from marked ones. Where no edge between them is
illegal, they are the constrained Delaunay triangulation of what they cover; the site is in conflict with all
that it removes of them; so the star that takes their place is the constrained Delaunay triangulation of the
same with the site, and no edge between its triangles is illegal. The edges around the star are tested.
"""

from __future__ import annotations

import numpy as np

from .._errors import InternalError
from .._numba.atomics import load_acquire
from .._numba.atomics import store as atomic_store
from .._numba.kernel_cache import cached_njit
from . import columns as c
from .columns import first_child, is_subdivided, triangle
from .mesh import ROOTS, Store

MOST_MARKED = 4096  # triangles of a thread: those of some 600 stars


def no_marks(threads: int) -> np.ndarray:
    """The triangles that threads have marked, int32 (threads, MOST_MARKED); `columns.MARKED` counts them."""
    return np.empty((threads, MOST_MARKED), np.int32)


@cached_njit(forceinline=True)
def _place_of(nodes, t, q):
    """Which vertex of t site q is; 3 where it is none."""
    for k in range(3):
        if nodes[t, k] == q:
            return k
    return 3


@cached_njit
def mark_star(mesh, me, marks, t, q):
    """Mark the triangles around site q of thread ``me``, of which t is one or was one.

    No other thread may be about to change them.
    """
    nodes, state = mesh.nodes, mesh.state
    children, down = load_acquire(nodes, (t, c.CHILD)), 0
    while children >= 0:
        t = first_child(children)
        # one of two or three children has it as a vertex, and a node is visited once
        for _ in range(1 + is_subdivided(children)):
            t += _place_of(nodes, t, q) == 3
        down += 1
        if down > len(nodes) or _place_of(nodes, t, q) == 3:
            msg = "the history of a 2D triangulation has lost a site"
            raise InternalError(msg)
        children = load_acquire(nodes, (t, c.CHILD))
    first = t
    for _ in range(len(nodes)):
        if state[me, c.MARKED] < marks.shape[1]:
            marks[me, state[me, c.MARKED]] = t
        state[me, c.MARKED] += 1
        t = triangle(load_acquire(nodes, (t, c.NEIGHBOR + (_place_of(nodes, t, q) + 1) % 3)))
        if t == first:
            atomic_store(mesh.shared, (c.SWAPS_LEFT, 0), 1)
            return
    msg = "a star of a 2D triangulation does not close"
    raise InternalError(msg)


def marked(store: Store, marks: np.ndarray) -> np.ndarray:
    """The triangles marked by all threads, int32 (k,); the roots where a thread had no room for more."""
    counts = store.state[:, c.MARKED]
    if (counts > marks.shape[1]).any():
        return np.arange(ROOTS, dtype=np.int32)
    return np.concatenate([row[:count] for row, count in zip(marks, counts, strict=True)])


@cached_njit(nogil=True)
def leaves_below(nodes, origins, seen, stack, leaves):
    """Enter the leaves that descend from ``origins``, each once, into ``leaves``; how many there are.

    ``seen``, all false, and ``stack`` have room for every node.
    """
    top = count = 0
    for t in origins:
        if not seen[t]:
            seen[t] = True
            stack[top] = t
            top += 1
    while top > 0:
        top -= 1
        t = stack[top]
        children = nodes[t, c.CHILD]
        if children < 0:
            leaves[count] = t
            count += 1
            continue
        first = first_child(children)
        for child in range(first, first + 2 + is_subdivided(children)):
            if not seen[child]:
                seen[child] = True
                stack[top] = child
                top += 1
    return count
