"""Location by a visibility walk from a nearby triangle, which Kohout et al. 2004 name as an alternative.

Walks read what other threads may be changing. What they end in may therefore be out of date, and is looked at
again by whoever has exclusive access to it. On the structure with a history a walk that meets a triangle that is
no more goes on in its children.
"""

from __future__ import annotations

import numba

from ..predicates.filtered2d import orient2d
from .atomics import load_acquire
from .store import CHILD, INFINITE, NEIGHBOR


@numba.njit(cache=True, forceinline=True)
def _leaf_below(nodes, t):
    """A triangle of the present triangulation where t was."""
    child = load_acquire(nodes, (t, CHILD))
    while child >= 0:
        t = child >> 1
        child = load_acquire(nodes, (t, CHILD))
    return t


@numba.njit(cache=True, forceinline=True)
def walk(points, nodes, t, q, w):
    """The triangle that contains site q, or a ghost whose edge it is beyond; and the steps, from t on."""
    steps, came = 0, -1
    while True:
        if load_acquire(nodes, (t, CHILD)) >= 0:
            t, came = _leaf_below(nodes, t), -1
        a, b, c = load_acquire(nodes, (t, 0)), load_acquire(nodes, (t, 1)), load_acquire(nodes, (t, 2))
        if min(a, b, c) == INFINITE:
            if came >= 0:
                return t, steps
            # a walk that starts in a ghost begins beyond its edge
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
        t, came = edge >> 2, edge & 3
        if a == INFINITE or b == INFINITE or c == INFINITE:
            came = -1
        steps += 1
