"""Location in the history by a visibility walk, which the paper names as an alternative (section 3.1).

Walks read what other threads may be changing. So the thread that has exclusive access looks again whether
what they end in is out of date.
"""

from __future__ import annotations

import numpy as np

from .._numba.atomics import load_acquire
from .._numba.kernel_cache import cached_njit
from . import columns as c
from .columns import first_child, triangle
from .dag import descend, locate
from .geometry import side_of_line


@cached_njit(forceinline=True)
def _right_of(mesh, a, b, q):
    """Whether q lies to the right of the edge ab; an infinite end makes a ray from the centre of it."""
    if a == c.INFINITE:
        return side_of_line(mesh, b, a, q) > 0
    return side_of_line(mesh, a, b, q) < 0


@cached_njit(forceinline=True)
def walk_history(mesh, t, q):
    """The leaf that contains q, and the steps from t on.

    Ghosts are bounded by rays from the centre, as in the history, so that the answer is right even where
    swaps are pending and the hull is not convex. There a walk might go round in circles; so another edge
    comes first in each step, as if at random (O. Devillers, S. Pion, M. Teillaud: Walking in a triangulation,
    International Journal of Foundations of Computer Science 13, 2002). That ends with probability 1 but has
    no bound, and a walk of more than len(nodes) steps goes on in the history instead. One that meets a
    triangle that is no more goes on in its children.
    """
    nodes = mesh.nodes
    steps = down = 0
    while steps + down <= len(nodes):
        children = load_acquire(nodes, (t, c.CHILD))
        while children >= 0 and down <= len(nodes):
            t = first_child(children)
            down += 1
            children = load_acquire(nodes, (t, c.CHILD))
        if children >= 0:
            break
        moved = False
        turn = np.int64(np.uint64(steps) * np.uint64(0x9E3779B97F4A7C15) >> np.uint64(33))
        for i in range(3):
            k = (i + turn) % 3
            if _right_of(mesh, nodes[t, (k + 1) % 3], nodes[t, (k + 2) % 3], q):
                t = triangle(load_acquire(nodes, (t, c.NEIGHBOR + k)))
                steps += 1
                moved = True
                break
        if not moved:
            return t, steps
    t, visited = locate(mesh, q)
    return t, steps + visited


DAG, WALK = range(2)


@cached_njit(forceinline=True)
def find(mesh, me, q, location):
    """The leaf that contains q, from a root or by walking from the last one, and how many were visited."""
    if location == WALK:
        return walk_history(mesh, mesh.state[me, c.HINT], q)
    return locate(mesh, q)


@cached_njit(forceinline=True)
def find_again(mesh, t, q, location):
    """The leaf that contains q, which was t before, and how many nodes were visited."""
    return walk_history(mesh, t, q) if location == WALK else descend(mesh, t, q)
