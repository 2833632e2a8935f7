"""The shared structure: triangles as rows of one array, with vertices at infinity and a history.

``nodes[t]`` is eight int32 words, half a cache line:

* three vertices, counter-clockwise, rows of the points or `INFINITE`. Beyond each edge of the hull lies a
  ghost, a triangle with the vertex at infinity, so that the triangulation covers the plane;
* three neighbours, the k-th across the edge opposite the k-th vertex, as 4 u + j where that edge is opposite
  the j-th vertex of u;
* the children. Of a triangle that is no more: 2 c + 1 where it was subdivided, into c, c+1, c+2; and 2 c
  where an edge of it was flipped, into c, c+1. Of a leaf, a triangle of the present triangulation, -1 - m,
  where m is the thread that made it;
* a lock: 0, or the thread that has exclusive access.

Node 0 is the first triangle and nodes 1 to 3 are the ghosts around it: the roots of the directed acyclic
graph that the children make (Kohout, Kolingerova, Zara 2004, section 3.1; L. Guibas, D. Knuth, M. Sharir:
Randomized incremental construction of Delaunay and Voronoi diagrams, Algorithmica 7, 1992). In every triangle
made by an insertion, the inserted site is the first vertex.
"""

from __future__ import annotations

import numpy as np

from .._memory import require
from .._numba.atomics import add, give_way, padded
from .._numba.kernel_cache import cached_njit

INFINITE = -1
ROOTS = 4

# columns of `nodes`: vertices 0 to 2, then
NEIGHBOR = 3
CHILD = 6
LOCK = 7

# rows of `shared`, one word each
USED, STOP, SOFT_LIMIT, CRITICAL, HEAD, TAIL, STUMBLE, OPEN, MOST_LOOKS = range(9)
SHARED_ROWS = 9

PATIENCE = 2048  # looks of a thread that waits, see `patience`

BLOCK = 512  # nodes that a thread takes at a time

# Nodes for which there is room before the first growth. Random insertion makes about 9 a site.
NODES_PER_SITE = 12

# columns of `state`, a row for each thread. First what goes on, then what is counted.
(
    NEXT, END, PART, BLOCK_AT, BLOCK_END, HINT, RANDOM,
    PHASE, SITE, NODE, LAST, AT, IN_HAND, HELPED,
    INSERTED, VISITED, FLIPS, TESTS, ACCESSES, WAITS, GIVEN_UP, EXCEPTIONS, RETRIES,
    LOCATION_CYCLES, CHANGE_CYCLES, WAIT_CYCLES, QUEUE_FILL, HELD,
    SUSPECT, NOTED, SEEN, LOOKED,
) = range(32)  # fmt: skip
STATE_COLUMNS = 32


@cached_njit
def write_roots(nodes, a, b, c):
    """Begin with the positive triangle abc and the ghosts beyond its edges."""
    nodes[:ROOTS] = 0
    nodes[0, 0], nodes[0, 1], nodes[0, 2] = a, b, c
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        nodes[1 + i, 0], nodes[1 + i, 1], nodes[1 + i, 2] = INFINITE, nodes[0, k], nodes[0, j]
        nodes[0, NEIGHBOR + i] = 4 * (1 + i)
        nodes[1 + i, NEIGHBOR] = i
        # across the edge (infinity, v_k), opposite the ghost's third vertex, lies ghost j
        nodes[1 + i, NEIGHBOR + 2] = 4 * (1 + j) + 1
        nodes[1 + i, NEIGHBOR + 1] = 4 * (1 + k) + 2
        nodes[1 + i, CHILD] = -1
    nodes[0, CHILD] = -1


@cached_njit(forceinline=True)
def fresh(state, me, shared, count):
    """The first of ``count`` consecutive unused nodes."""
    at = state[me, BLOCK_AT]
    if at + count > state[me, BLOCK_END]:
        at = add(shared, (USED, 0), BLOCK)
        state[me, BLOCK_END] = at + BLOCK
    state[me, BLOCK_AT] = at + count
    return at


@cached_njit
def stumble(shared, state, me):
    """Give way at random, once in shared[STUMBLE] calls; never where that is 0. For tests under
    contention."""
    if shared[STUMBLE, 0] != 0:
        x = state[me, RANDOM]
        x ^= (x << 13) & 0x7FFFFFFFFFFFFFFF
        x ^= x >> 7
        x ^= (x << 17) & 0x7FFFFFFFFFFFFFFF
        state[me, RANDOM] = x
        if x % shared[STUMBLE, 0] == 0:
            give_way()


class Store:
    """The arrays of one run.

    Attributes
    ----------
    points : float64 (n, 2)
    nodes : int32 (capacity, 8)
    state : int64 (threads, 32)
        Each thread writes to its own row.
    shared : int64 (9, 16)
        Words that all write to.
    capacity : int, optional
        Of `nodes`, where it is known; with a history it is not, and grows.
    """

    def __init__(
        self, points: np.ndarray, first: np.ndarray, threads: int, capacity: int | None = None
    ) -> None:
        self.points = points
        self.reserve = 4 * len(points) + 4 * BLOCK * threads + 64
        soft = NODES_PER_SITE * len(points) + 4 * BLOCK * threads
        # words that are zero are of no triangle: they have children
        self.nodes = np.zeros((soft + self.reserve if capacity is None else capacity, 8), np.int32)
        write_roots(self.nodes, *(int(v) for v in first))
        self.state = np.zeros((threads, STATE_COLUMNS), np.int64)
        self.state[:, PART] = np.arange(threads)
        self.state[:, RANDOM] = np.arange(1, threads + 1) * 0x9E3779B9
        self.shared = padded(SHARED_ROWS)
        self.shared[USED, 0] = ROOTS
        self.shared[SOFT_LIMIT, 0] = soft
        self.shared[MOST_LOOKS, 0] = PATIENCE
        self.growths = 0

    def grow(self) -> None:
        """Half as many nodes again. No thread may be running.

        MemoryError if the system does not have the memory, ValueError if the nodes could not be named.

        One insertion flips fewer edges than there are, and insertions at the same time flip different ones;
        so `reserve` is what those that began below the limit may need beyond it.
        """
        soft = int(self.shared[SOFT_LIMIT, 0] * 3 // 2)
        if 4 * (soft + self.reserve) > 2**31 - 1:
            msg = (
                f"the history of {len(self.points)} sites has more triangles than 32-bit numbers can name; "
                f"use method='auto', which keeps none"
            )
            raise ValueError(msg)
        used = int(self.shared[USED, 0])
        node = self.nodes.itemsize * self.nodes.shape[1]
        what = f"a history of more than {used} triangles"
        require(what, node * max(used, soft - used), node * (soft + self.reserve))
        longer = np.zeros((soft + self.reserve, 8), np.int32)
        longer[:used] = self.nodes[:used]
        self.nodes = longer
        self.shared[SOFT_LIMIT, 0] = soft
        self.growths += 1
