"""The columns of the arrays that all threads share, by name: `nodes`, `shared` and `state` of `mesh.Mesh`.

``nodes[t]`` is eight int32 words, half a cache line:

* three vertices, counter-clockwise, rows of the points or `INFINITE`. Beyond each edge of the hull lies a
  ghost, a triangle with the vertex at infinity, so that the triangulation covers the plane;
* three neighbours, the k-th across the edge opposite the k-th vertex, as the name of that edge there;
* the children. Of a triangle that is no more: 2 c + 1 where it was subdivided, into c, c+1, c+2; and 2 c
  where an edge of it was flipped, into c, c+1. Of a leaf, a triangle of the present triangulation, -1 - m,
  where m is the thread that made it;
* a lock: 0, or 1 + the thread that has exclusive access.

An edge is named 4 t + k where it is opposite the k-th vertex of t; see `edge`, `triangle` and `side`.
"""

from __future__ import annotations

import numpy as np

from .._numba.kernel_cache import cached_njit

INFINITE = -1  # the vertex at infinity

# columns of `nodes`: vertices 0 to 2, then
NEIGHBOR = 3
CHILD = 6
LOCK = 7
NODE_WORDS = 8

# rows of `shared`, of which one word each is used: nodes used; whether all threads have to stop; nodes used
# from which on the structure has to grow; the thread in the critical section; the ends of the queue; once in
# how many chances threads give way; whether illegal edges may be left; looks before a waiting thread gives up
USED, STOP, SOFT_LIMIT, CRITICAL, HEAD, TAIL, YIELD_EVERY, SWAPS_LEFT, MOST_LOOKS = range(9)
SHARED_ROWS = 9

# columns of `state`, a row for each thread
(
    # of the order of insertion: the next site, the end of the chunk, the part that it is of
    NEXT, CHUNK_END, PART,
    # unused nodes of this thread; the triangle of its last insertion; a random number
    BLOCK_AT, BLOCK_END, HINT, RANDOM,
    # what it is at: see the phases below; its site; a triangle; the last vertex about the star
    PHASE, SITE, NODE, LAST,
    # sites located ahead: the first and the end of those left; whether it finished one of others
    LOCATED_AT, LOCATED_END, HELPED,
    # counts: `Statistics` says what they are
    INSERTED, VISITED, FLIPS, TESTS, ACCESSES, WAITS, GIVEN_UP, EXCEPTIONS, RETRIES,
    LOCATION_CYCLES, CHANGE_CYCLES, WAIT_CYCLES, QUEUE_FILL,
    # triangles locked; whether its star may keep illegal edges; triangles marked for that reason
    LOCKED, STAR_MARKED, MARKED,
    # of `patience`: effort since the last look; what the threads had done then; looks in vain since
    EFFORT, SEEN, LOOKED,
) = range(33)  # fmt: skip
STATE_COLUMNS = 40

# Phases of a thread: between two insertions, in `HEAD_START` before its first one; with a located site, about
# to lock the cavity or to subdivide; in legalisation. In `CHANGE` it holds locks, or has to go on.
BEGIN, HEAD_START, LOCK_CAVITY, SUBDIVIDE, LEGALISE, CHANGE = range(6)


@cached_njit(forceinline=True)
def edge(t, k):
    """The name of the edge of t opposite its k-th vertex."""
    return 4 * t + k


@cached_njit(forceinline=True)
def triangle(edge):
    """The triangle that an edge's name is of."""
    return edge >> 2


@cached_njit(forceinline=True)
def side(edge):
    """Which edge of its triangle it is, 0 to 2."""
    return edge & 3


@cached_njit(forceinline=True)
def first_child(children):
    """The first of the two or three consecutive nodes that a word of `CHILD` names."""
    return children >> 1


@cached_njit(forceinline=True)
def is_subdivided(children):
    """Whether a word of `CHILD` is of a node that was subdivided; otherwise an edge of it was flipped."""
    return children & 1 != 0


def edges_of(triangles: np.ndarray) -> np.ndarray:
    """The names of all edges of triangles, int64 (3 k,)."""
    return np.add.outer(4 * triangles.astype(np.int64), np.arange(3)).ravel()
