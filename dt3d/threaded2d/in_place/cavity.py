"""The triangles in conflict with a site, with exclusive access to them and to those around them.

The conflicts of a Delaunay triangulation with one more site are connected and have no vertex inside, so that
a walk through them, always leaving by the next edge counter-clockwise, meets each once and finds the edges
around them in order (A. Bowyer 1981, D. F. Watson 1981).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..._errors import InternalError
from ..._numba.atomics import compare_and_swap, load, rows_apart, store_release
from ..._numba.kernel_cache import cached_njit
from .. import columns as c
from ..columns import edge, side, triangle
from ..geometry import in_conflict

BUSY = -1


class Scratch(NamedTuple):
    """Where a thread notes a cavity; with room for more triangles and edges than there are.

    Attributes
    ----------
    locked : int32 (threads, 4 n + 64 or a few more)
        Triangles that it has locked.
    cavity : int32 (threads, 4 n + 64 or a few more)
        Triangles in conflict, and from the end on edges to be crossed.
    rim : int32 (threads, 12 n + 192 or a few more)
        Triples: the name of the edge beyond, and the vertices from and to which it leads counter-clockwise.
    """

    locked: np.ndarray
    cavity: np.ndarray
    rim: np.ndarray


def empty_scratch(n: int, threads: int) -> Scratch:
    """For n sites; only what is used gets memory."""
    longest = 4 * n + 64
    return Scratch(*(rows_apart(threads, k * longest, np.int32) for k in (1, 1, 3)))


@cached_njit(forceinline=True)
def _own(nodes, t, lock, locked, count):
    """Lock t unless it is ours; how many are locked then, or `BUSY`."""
    if load(nodes, (t, c.LOCK)) == lock:
        return count
    if not compare_and_swap(nodes, (t, c.LOCK), 0, lock):
        return BUSY
    locked[count] = t
    return count + 1


@cached_njit(forceinline=True)
def unlock(nodes, locked, count):
    """Unlock the first ``count`` triangles of ``locked``."""
    for i in range(count):
        store_release(nodes, (locked[i], c.LOCK), 0)


@cached_njit(forceinline=True)
def lock_cavity(mesh, me, t, q, lock, scratch):
    """Find the conflicts with q from t on, and the edges around them, into the scratch of thread ``me``.

    With a ``lock`` other than 0 all triangles met are locked with it.

    Returns
    -------
    size of the cavity, edges of the rim, how many are locked; the size is `BUSY` where another thread has one
    of them, or t is not in conflict any more.

    Raises
    ------
    InternalError
        Where the walk meets more than len(cavity) / 2 triangles, of which there is room for the walk: k
        conflicts leave no more than k + 2 edges to be crossed and k + 2 around them. ``cavity`` and
        ``locked`` have four words and more per site, ``rim`` twelve; there are less than two triangles per
        site.
    """
    nodes = mesh.nodes
    locked, cavity, rim = scratch.locked[me], scratch.cavity[me], scratch.rim[me]
    count = 0
    if lock != 0:
        if not compare_and_swap(nodes, (t, c.LOCK), 0, lock):
            return BUSY, 0, 0
        locked[0] = t
        count = 1
        if nodes[t, c.CHILD] >= 0 or not in_conflict(mesh, t, q):
            return BUSY, 0, count
    cavity[0] = t
    size, edges = 1, 0
    # edges to be crossed lie at the end of `cavity`
    top = len(cavity)
    for k in range(3):
        top -= 1
        cavity[top] = edge(t, 2 - k)
    while top < len(cavity):
        t, k = triangle(cavity[top]), side(cavity[top])
        top += 1
        beyond = nodes[t, c.NEIGHBOR + k]
        u, j = triangle(beyond), side(beyond)
        if lock != 0:
            got = _own(nodes, u, lock, locked, count)
            if got == BUSY:
                return BUSY, 0, count
            count = got
        following = j + 1 if j < 2 else 0
        previous = j - 1 if j > 0 else 2
        if in_conflict(mesh, u, q):
            cavity[size] = u
            size += 1
            if 2 * size + 6 > len(cavity):
                msg = "the conflicts of a site in a 2D triangulation have no end"
                raise InternalError(msg)
            top -= 2
            cavity[top] = edge(u, following)
            cavity[top + 1] = edge(u, previous)
        else:
            rim[3 * edges], rim[3 * edges + 1], rim[3 * edges + 2] = (
                beyond,
                nodes[u, previous],
                nodes[u, following],
            )
            edges += 1
    return size, edges, count
