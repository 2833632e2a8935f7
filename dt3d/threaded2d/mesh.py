"""The shared structure: triangles as rows of one array, with vertices at infinity and a history.

Node 0 is the first triangle and nodes 1 to 3 are the ghosts around it: the roots of the directed acyclic
graph that the children make (Kohout, Kolingerova, Zara 2004, section 3.1; L. Guibas, D. Knuth, M. Sharir:
Randomized incremental construction of Delaunay and Voronoi diagrams, Algorithmica 7, 1992). In every triangle
made by an insertion, the inserted site is the first vertex. `columns` says what a row holds.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._memory import require
from .._numba.atomics import add, give_way, padded, rows_apart
from .._numba.kernel_cache import cached_njit
from ..predicates import work_array
from . import columns as c
from .columns import edge

ROOTS = 4

MOST_LOOKS = 2048  # of a thread that waits, see `patience`

BLOCK = 512  # nodes that a thread takes at a time

# Nodes for which there is room before the first growth. Random insertion makes about 9 per site.
NODES_PER_SITE = 12


class Mesh(NamedTuple):
    """The arrays of a run, as one thread sees them: all share them but for the workspace.

    Attributes
    ----------
    points : float64 (n, 2)
    nodes : int32 (capacity, 8)
    shared : int64 (9, 16)
        Words that all write to.
    state : int64 (threads, 48)
        Each thread writes to its own row.
    workspace : float64 (k,)
        Of the exact predicates of this thread.
    """

    points: np.ndarray
    nodes: np.ndarray
    shared: np.ndarray
    state: np.ndarray
    workspace: np.ndarray


@cached_njit
def write_roots(nodes, v0, v1, v2):
    """Begin with the positive triangle of these vertices and the ghosts beyond its edges."""
    nodes[:ROOTS] = 0
    nodes[0, 0], nodes[0, 1], nodes[0, 2] = v0, v1, v2
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        nodes[1 + i, 0], nodes[1 + i, 1], nodes[1 + i, 2] = c.INFINITE, nodes[0, k], nodes[0, j]
        nodes[0, c.NEIGHBOR + i] = edge(1 + i, 0)
        nodes[1 + i, c.NEIGHBOR] = edge(0, i)
        # across the edge (infinity, v_k), opposite the ghost's third vertex, lies ghost j
        nodes[1 + i, c.NEIGHBOR + 2] = edge(1 + j, 1)
        nodes[1 + i, c.NEIGHBOR + 1] = edge(1 + k, 2)
        nodes[1 + i, c.CHILD] = -1
    nodes[0, c.CHILD] = -1


@cached_njit(forceinline=True)
def unused_nodes(mesh, me, count):
    """The first of ``count`` consecutive unused nodes."""
    state = mesh.state
    at = state[me, c.BLOCK_AT]
    if at + count > state[me, c.BLOCK_END]:
        at = add(mesh.shared, (c.USED, 0), BLOCK)
        state[me, c.BLOCK_END] = at + BLOCK
    state[me, c.BLOCK_AT] = at + count
    return at


@cached_njit
def _yield_at_random(state, me, every):
    x = state[me, c.RANDOM]
    x ^= (x << 13) & 0x7FFFFFFFFFFFFFFF
    x ^= x >> 7
    x ^= (x << 17) & 0x7FFFFFFFFFFFFFFF
    state[me, c.RANDOM] = x
    if x % every == 0:
        give_way()


@cached_njit(forceinline=True)
def inject_yield(mesh, me):
    """Give way at random, once in shared[YIELD_EVERY] calls; never where that is 0.

    Fault injection, for tests under contention.
    """
    every = mesh.shared[c.YIELD_EVERY, 0]
    if every != 0:
        _yield_at_random(mesh.state, me, every)


class Store:
    """Makes the arrays of one run, and makes them longer; see `Mesh`.

    Parameters
    ----------
    points : float64 (n, 2)
    first : int64 (3,)
        The vertices of the first triangle.
    threads : int
    capacity : int, optional
        Of the nodes, where it is known; with a history it is not, and grows.
    """

    def __init__(
        self, points: np.ndarray, first: np.ndarray, threads: int, capacity: int | None = None
    ) -> None:
        self.points = points
        self.reserve = 4 * len(points) + 4 * BLOCK * threads + 64
        soft = NODES_PER_SITE * len(points) + 4 * BLOCK * threads
        # words that are zero are of no triangle: they have children
        self.nodes = np.zeros((soft + self.reserve if capacity is None else capacity, c.NODE_WORDS), np.int32)
        write_roots(self.nodes, *(int(v) for v in first))
        self.state = rows_apart(threads, c.STATE_COLUMNS)
        self.state[:, c.PART] = np.arange(threads)
        self.state[:, c.RANDOM] = np.arange(1, threads + 1) * 0x9E3779B9
        self.shared = padded(c.SHARED_ROWS)
        self.shared[c.USED, 0] = ROOTS
        self.shared[c.SOFT_LIMIT, 0] = soft
        self.shared[c.MOST_LOOKS, 0] = MOST_LOOKS
        self.growths = 0
        self._workspaces = [work_array(points) for _ in range(threads)]

    def mesh(self, me: int = 0) -> Mesh:
        """What thread ``me`` sees, until the structure grows."""
        return Mesh(self.points, self.nodes, self.shared, self.state, self._workspaces[me])

    @property
    def used(self) -> int:
        """How many nodes there are, unused ones of threads' blocks included."""
        return int(self.shared[c.USED, 0])

    def stop(self) -> None:
        """Let all threads return as soon as they can."""
        self.shared[c.STOP, 0] = 1

    def grow(self) -> None:
        """Half as many nodes again. No thread may be running.

        One insertion flips fewer edges than there are, and insertions at the same time flip different ones;
        so `reserve` is what those that began below the limit may need beyond it.

        Raises
        ------
        MemoryError
            If the system does not have the memory.
        ValueError
            If the nodes could not be named.
        """
        soft = int(self.shared[c.SOFT_LIMIT, 0] * 3 // 2)
        if 4 * (soft + self.reserve) > 2**31 - 1:
            msg = (
                f"the history of {len(self.points)} sites has more triangles than 32-bit numbers can name; "
                f"use method='auto', which keeps none"
            )
            raise ValueError(msg)
        used = self.used
        node = self.nodes.itemsize * c.NODE_WORDS
        what = f"a history of more than {used} triangles"
        require(what, node * max(used, soft - used), node * (soft + self.reserve))
        longer = np.zeros((soft + self.reserve, c.NODE_WORDS), np.int32)
        longer[:used] = self.nodes[:used]
        self.nodes = longer
        self.shared[c.SOFT_LIMIT, 0] = soft
        self.growths += 1
