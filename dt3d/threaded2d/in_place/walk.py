"""Location in place: a visibility walk from the triangle of the last insertion.

Walks read what other threads may be changing. So the thread that has exclusive access looks again whether
what they end in is out of date.
"""

from __future__ import annotations

from ..._numba.atomics import load_acquire
from ..._numba.kernel_cache import cached_njit
from ...predicates.filtered2d import orient2d
from .. import columns as c
from ..columns import side, triangle


@cached_njit(forceinline=True)
def walk(mesh, t, q):
    """The triangle that contains site q, or a ghost whose edge it is beyond; and the steps from t on.

    Without other threads no triangle is met twice, as the power of q, ties perturbed, decreases from one to
    the next (H. Edelsbrunner: An acyclicity theorem for cell complexes in d dimensions, Combinatorica 10,
    1990). So more steps than len(nodes) say that the structure is broken, or that other threads have changed
    it on the way or are amid a change; the triangle then is any.
    """
    points, nodes, w = mesh.points, mesh.nodes, mesh.workspace
    steps, entered = 0, -1
    while steps <= len(nodes):
        v0, v1, v2 = load_acquire(nodes, (t, 0)), load_acquire(nodes, (t, 1)), load_acquire(nodes, (t, 2))
        ghost = min(v0, v1, v2) == c.INFINITE
        if ghost:
            if entered >= 0:
                return t, steps
            # a walk that starts in a ghost goes inside first
            k = 0 if v0 == c.INFINITE else (1 if v1 == c.INFINITE else 2)
        elif entered != 2 and orient2d(points, v0, v1, q, w) < 0:
            k = 2
        elif entered != 0 and orient2d(points, v1, v2, q, w) < 0:
            k = 0
        elif entered != 1 and orient2d(points, v2, v0, q, w) < 0:
            k = 1
        else:
            return t, steps
        edge = load_acquire(nodes, (t, c.NEIGHBOR + k))
        t = triangle(edge)
        entered = -1 if ghost else side(edge)
        steps += 1
    return t, steps
