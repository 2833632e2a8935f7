"""Subdivision and legalisation (Kohout et al. 2004, section 3.1), on the structure with its history."""

from __future__ import annotations

from .._errors import InternalError
from .._numba.atomics import store_release
from .._numba.kernel_cache import cached_njit
from .geometry import conflicts
from .mesh import CHILD, FLIPS, LOCK, NEIGHBOR, fresh


@cached_njit(forceinline=True)
def _write(nodes, t, p, a, b, outer, following, previous, maker, lock):
    """The star triangle pab: across ab lies the edge ``outer``, beside it the star's next and previous
    ones."""
    nodes[t, 0], nodes[t, 1], nodes[t, 2] = p, a, b
    nodes[t, NEIGHBOR], nodes[t, NEIGHBOR + 1], nodes[t, NEIGHBOR + 2] = outer, following, previous
    nodes[t, CHILD] = -1 - maker
    nodes[t, LOCK] = lock


@cached_njit(forceinline=True)
def _point_back(nodes, edge, t, k):
    """Make the triangle beyond ``edge`` know that t, with its k-th edge, is now its neighbour."""
    store_release(nodes, (edge >> 2, NEIGHBOR + (edge & 3)), 4 * t + k)


@cached_njit(forceinline=True)
def subdivide(nodes, shared, state, me, t, p, lock):
    """Three triangles about p in the place of leaf t; the first of them."""
    first = fresh(state, me, shared, 3)
    a, b, c = nodes[t, 0], nodes[t, 1], nodes[t, 2]
    beyond_a, beyond_b, beyond_c = nodes[t, NEIGHBOR], nodes[t, NEIGHBOR + 1], nodes[t, NEIGHBOR + 2]
    _write(nodes, first, p, a, b, beyond_c, 4 * (first + 1) + 2, 4 * (first + 2) + 1, me, lock)
    _write(nodes, first + 1, p, b, c, beyond_a, 4 * (first + 2) + 2, 4 * first + 1, me, lock)
    _write(nodes, first + 2, p, c, a, beyond_b, 4 * first + 2, 4 * (first + 1) + 1, me, lock)
    _point_back(nodes, beyond_c, first, 0)
    _point_back(nodes, beyond_a, first + 1, 0)
    _point_back(nodes, beyond_b, first + 2, 0)
    store_release(nodes, (t, CHILD), 2 * first + 1)
    return first


@cached_njit(forceinline=True)
def flip(nodes, shared, state, me, f, k, lock):
    """Flip the edge of f opposite its k-th vertex, which is finite; the first of the two new triangles, which
    have that vertex first."""
    first = fresh(state, me, shared, 2)
    edge = nodes[f, NEIGHBOR + k]
    u, j = edge >> 2, edge & 3
    k1, j1 = k + 1 if k < 2 else 0, j + 1 if j < 2 else 0
    k2, j2 = 3 - k - k1, 3 - j - j1
    p, a, b, d = nodes[f, k], nodes[f, k1], nodes[f, k2], nodes[u, j]
    following, previous = nodes[f, NEIGHBOR + k1], nodes[f, NEIGHBOR + k2]
    beyond_ad, beyond_db = nodes[u, NEIGHBOR + j1], nodes[u, NEIGHBOR + j2]
    _write(nodes, first, p, a, d, beyond_ad, 4 * (first + 1) + 2, previous, me, lock)
    _write(nodes, first + 1, p, d, b, beyond_db, following, 4 * first + 1, me, lock)
    _point_back(nodes, beyond_ad, first, 0)
    _point_back(nodes, beyond_db, first + 1, 0)
    _point_back(nodes, previous, first, 2)
    _point_back(nodes, following, first + 1, 1)
    store_release(nodes, (f, CHILD), 2 * first)
    store_release(nodes, (u, CHILD), 2 * first)
    state[me, FLIPS] += 1
    return first


@cached_njit(forceinline=True)
def illegal(points, nodes, f, w):
    """Whether the edge of star triangle f opposite its first vertex has to be flipped."""
    u = nodes[f, NEIGHBOR] >> 2
    return conflicts(points, nodes[u, 0], nodes[u, 1], nodes[u, 2], nodes[f, 0], w)


@cached_njit(forceinline=True)
def insert(points, nodes, shared, state, me, t, p, lock, w):
    """Subdivide leaf t, which contains p, and legalise: once about the star of p.

    Returns one of the star's triangles. All that is changed must be this thread's own for as long as it
    takes.

    Each turn adds a neighbour to p or goes on to the next one. There are no more of them than sites, with the
    vertex at infinity in place of p. The store's reserve has room for as many flips.
    """
    f = subdivide(nodes, shared, state, me, t, p, lock)
    last = nodes[f, 1]  # the edge from p to this vertex is never flipped
    for _ in range(2 * len(points) + 8):
        if illegal(points, nodes, f, w):
            f = flip(nodes, shared, state, me, f, 0, lock)
        elif nodes[f, 2] == last:
            return f
        else:
            f = nodes[f, NEIGHBOR + 1] >> 2
    msg = "the legalisation of a site in a 2D triangulation does not end"
    raise InternalError(msg)
