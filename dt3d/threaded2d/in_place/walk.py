"""Location by a visibility walk from a nearby triangle, which Kohout et al. 2004 name as an alternative.

Walks read what other threads may be changing. What they end in may therefore be out of date, and is looked at
again by whoever has exclusive access to it.
"""

from __future__ import annotations

import numpy as np

from ..._numba.atomics import load_acquire
from ..._numba.kernel_cache import cached_njit
from ...predicates.filtered2d import orient2d
from ..dag import locate
from ..geometry import side
from ..mesh import CHILD, INFINITE, NEIGHBOR


@cached_njit(forceinline=True)
def walk(points, nodes, t, q, w):
    """In place: the triangle that contains site q, or a ghost whose edge it is beyond; and the steps from t
    on.

    Without other threads no triangle is met twice, as the power of q, ties perturbed, decreases from one to
    the next (H. Edelsbrunner: An acyclicity theorem for cell complexes in d dimensions, Combinatorica 10,
    1990). So more steps than len(nodes) say that the structure is broken, or that other threads have changed
    it on the way or are amid a change; the triangle then is any.
    """
    steps, came = 0, -1
    while steps <= len(nodes):
        a, b, c = load_acquire(nodes, (t, 0)), load_acquire(nodes, (t, 1)), load_acquire(nodes, (t, 2))
        ghost = min(a, b, c) == INFINITE
        if ghost:
            if came >= 0:
                return t, steps
            # a walk that starts in a ghost goes inside first
            k = 0 if a == INFINITE else (1 if b == INFINITE else 2)
        elif came != 2 and orient2d(points, a, b, q, w) < 0:
            k = 2
        elif came != 0 and orient2d(points, b, c, q, w) < 0:
            k = 0
        elif came != 1 and orient2d(points, c, a, q, w) < 0:
            k = 1
        else:
            return t, steps
        edge = load_acquire(nodes, (t, NEIGHBOR + k))
        t = edge >> 2
        came = -1 if ghost else edge & 3
        steps += 1
    return t, steps


@cached_njit(forceinline=True)
def _right_of(points, nodes, a, b, q, w):
    """Whether q lies to the right of the edge ab, one of whose ends may be infinite: of a ray from the
    centre."""
    if a == INFINITE:
        return side(points, nodes, b, a, q, w) > 0
    return side(points, nodes, a, b, q, w) < 0


@cached_njit(forceinline=True)
def walk_history(points, nodes, t, q, w):
    """With a history: the leaf that contains q, and the steps from t on.

    Ghosts are bounded by rays from the centre, as in the history, so that the answer is right even where
    swaps are pending and the hull is not convex. There a walk might go round in circles; so another edge
    comes first in each step, as if at random (O. Devillers, S. Pion, M. Teillaud: Walking in a triangulation,
    International Journal of Foundations of Computer Science 13, 2002). That ends with probability 1 but has
    no bound, and a walk of more than len(nodes) steps goes on in the history instead. One that meets a
    triangle that is no more goes on in its children.
    """
    steps = down = 0
    while steps + down <= len(nodes):
        child = load_acquire(nodes, (t, CHILD))
        while child >= 0 and down <= len(nodes):
            t = child >> 1
            down += 1
            child = load_acquire(nodes, (t, CHILD))
        if child >= 0:
            break
        moved = False
        turn = np.int64(np.uint64(steps) * np.uint64(0x9E3779B97F4A7C15) >> np.uint64(33))
        for i in range(3):
            k = (i + turn) % 3
            a, b = nodes[t, (k + 1) % 3], nodes[t, (k + 2) % 3]
            if _right_of(points, nodes, a, b, q, w):
                t = load_acquire(nodes, (t, NEIGHBOR + k)) >> 2
                steps += 1
                moved = True
                break
        if not moved:
            return t, steps
    t, visited = locate(points, nodes, q, w)
    return t, steps + visited
