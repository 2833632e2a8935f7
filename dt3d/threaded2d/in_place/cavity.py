"""The triangles in conflict with a site, with exclusive access to them and to those around them.

The conflicts of a Delaunay triangulation with one more site are connected and have no vertex inside, so that
a walk through them, always leaving by the next edge counter-clockwise, meets each once and finds the edges
around them in order (A. Bowyer 1981, D. F. Watson 1981).
"""

from __future__ import annotations

from ..._errors import InternalError
from ..._numba.atomics import compare_and_swap, load, store_release
from ..._numba.kernel_cache import cached_njit
from ..geometry import conflicts
from ..mesh import CHILD, LOCK, NEIGHBOR

BUSY = -1


@cached_njit(forceinline=True)
def _own(nodes, t, lock, held, count):
    """Lock t unless it is ours; how many are held then, or `BUSY`."""
    if load(nodes, (t, LOCK)) == lock:
        return count
    if not compare_and_swap(nodes, (t, LOCK), 0, lock):
        return BUSY
    held[count] = t
    return count + 1


@cached_njit(forceinline=True)
def give_back(nodes, held, count):
    """Unlock what is held."""
    for i in range(count):
        store_release(nodes, (held[i], LOCK), 0)


@cached_njit(forceinline=True)
def in_conflict(points, nodes, t, q, w):
    """Whether site q is in conflict with triangle t."""
    return conflicts(points, nodes[t, 0], nodes[t, 1], nodes[t, 2], q, w)


@cached_njit(forceinline=True)
def claim(points, nodes, t, q, lock, held, cavity, rim, w):
    """Find the conflicts with q from t on, into ``cavity``, and the edges around them, into ``rim``.

    ``rim`` gets triples: the edge beyond as 4 u + j, and the vertices from and to which it leads
    counter-clockwise. With a ``lock`` other than 0 all triangles met are locked with it and entered into
    ``held``.

    Returns
    -------
    size of the cavity, edges of the rim, how many are held; the size is `BUSY` where another thread has one
    of them, or t is not in conflict any more.

    Raises
    ------
    InternalError
        Where the walk meets more than len(cavity) / 2 triangles, of which there is room for the walk: k
        conflicts leave no more than k + 2 edges to be crossed and k + 2 around them. ``cavity`` and ``held``
        have four words and more a site, ``rim`` twelve; there are less than two triangles a site.
    """
    count = 0
    if lock != 0:
        if not compare_and_swap(nodes, (t, LOCK), 0, lock):
            return BUSY, 0, 0
        held[0] = t
        count = 1
        if nodes[t, CHILD] >= 0 or not in_conflict(points, nodes, t, q, w):
            return BUSY, 0, count
    cavity[0] = t
    size, edges = 1, 0
    # edges to be crossed lie as 4 t + k at the end of `cavity`
    top = len(cavity)
    for k in range(3):
        top -= 1
        cavity[top] = 4 * t + 2 - k
    while top < len(cavity):
        t, k = cavity[top] >> 2, cavity[top] & 3
        top += 1
        edge = nodes[t, NEIGHBOR + k]
        u, j = edge >> 2, edge & 3
        if lock != 0:
            got = _own(nodes, u, lock, held, count)
            if got == BUSY:
                return BUSY, 0, count
            count = got
        following = j + 1 if j < 2 else 0
        previous = j - 1 if j > 0 else 2
        if in_conflict(points, nodes, u, q, w):
            cavity[size] = u
            size += 1
            if 2 * size + 6 > len(cavity):
                msg = "the conflicts of a site in a 2D triangulation have no end"
                raise InternalError(msg)
            top -= 2
            cavity[top] = 4 * u + following
            cavity[top + 1] = 4 * u + previous
        else:
            rim[3 * edges], rim[3 * edges + 1], rim[3 * edges + 2] = (
                edge,
                nodes[u, previous],
                nodes[u, following],
            )
            edges += 1
    return size, edges, count
