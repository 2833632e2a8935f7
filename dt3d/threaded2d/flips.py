r"""Subdivision and legalisation (Kohout et al. 2004, section 3.1), on the structure with its history.

A site p is inserted into the triangle abc; then edges opposite p are flipped as long as one is illegal::

          c                    c                  b                  b
         / \                  /|\                /|\                / \
        /   \                / | \              / | \              /   \
       /     \      ->      /  p  \            p f|u d     ->     p-----d
      /   p   \            / /   \ \            \ | /              \   /
     a---------b          a---------b            \|/                \ /
                                                  a                  a
"""

from __future__ import annotations

from .._errors import InternalError
from .._numba.atomics import store_release
from .._numba.kernel_cache import cached_njit
from . import columns as c
from .columns import edge, side, triangle
from .geometry import in_conflict
from .mesh import unused_nodes


@cached_njit(forceinline=True)
def _write(nodes, t, vertices, edges, me, lock):
    """Triangle t of thread ``me``: its vertices, and the edges beyond its own."""
    nodes[t, 0], nodes[t, 1], nodes[t, 2] = vertices
    nodes[t, c.NEIGHBOR], nodes[t, c.NEIGHBOR + 1], nodes[t, c.NEIGHBOR + 2] = edges
    nodes[t, c.CHILD] = -1 - me
    nodes[t, c.LOCK] = lock


@cached_njit(forceinline=True)
def _point_back(nodes, beyond, t, k):
    """Make the triangle with the edge ``beyond`` know that edge k of t is now on the other side."""
    store_release(nodes, (triangle(beyond), c.NEIGHBOR + side(beyond)), edge(t, k))


@cached_njit(forceinline=True)
def subdivide(mesh, me, t, p, lock):
    """Three triangles about p in the place of leaf t; the first of them."""
    nodes = mesh.nodes
    first = unused_nodes(mesh, me, 3)
    v0, v1, v2 = nodes[t, 0], nodes[t, 1], nodes[t, 2]
    beyond0, beyond1, beyond2 = nodes[t, c.NEIGHBOR], nodes[t, c.NEIGHBOR + 1], nodes[t, c.NEIGHBOR + 2]
    _write(nodes, first, (p, v0, v1), (beyond2, edge(first + 1, 2), edge(first + 2, 1)), me, lock)
    _write(nodes, first + 1, (p, v1, v2), (beyond0, edge(first + 2, 2), edge(first, 1)), me, lock)
    _write(nodes, first + 2, (p, v2, v0), (beyond1, edge(first, 2), edge(first + 1, 1)), me, lock)
    _point_back(nodes, beyond2, first, 0)
    _point_back(nodes, beyond0, first + 1, 0)
    _point_back(nodes, beyond1, first + 2, 0)
    store_release(nodes, (t, c.CHILD), 2 * first + 1)
    return first


@cached_njit(forceinline=True)
def flip(mesh, me, f, k, lock):
    """Flip the edge of f opposite its k-th vertex, which is finite.

    Returns the first of the two new triangles, which have that vertex first.
    """
    nodes = mesh.nodes
    first = unused_nodes(mesh, me, 2)
    beyond = nodes[f, c.NEIGHBOR + k]
    u, j = triangle(beyond), side(beyond)
    k1, j1 = k + 1 if k < 2 else 0, j + 1 if j < 2 else 0
    k2, j2 = 3 - k - k1, 3 - j - j1
    p, a, b, d = nodes[f, k], nodes[f, k1], nodes[f, k2], nodes[u, j]
    following, previous = nodes[f, c.NEIGHBOR + k1], nodes[f, c.NEIGHBOR + k2]
    beyond_ad, beyond_db = nodes[u, c.NEIGHBOR + j1], nodes[u, c.NEIGHBOR + j2]
    _write(nodes, first, (p, a, d), (beyond_ad, edge(first + 1, 2), previous), me, lock)
    _write(nodes, first + 1, (p, d, b), (beyond_db, following, edge(first, 1)), me, lock)
    _point_back(nodes, beyond_ad, first, 0)
    _point_back(nodes, beyond_db, first + 1, 0)
    _point_back(nodes, previous, first, 2)
    _point_back(nodes, following, first + 1, 1)
    store_release(nodes, (f, c.CHILD), 2 * first)
    store_release(nodes, (u, c.CHILD), 2 * first)
    mesh.state[me, c.FLIPS] += 1
    return first


@cached_njit(forceinline=True)
def illegal(mesh, f):
    """Whether the edge of star triangle f opposite its first vertex has to be flipped."""
    return in_conflict(mesh, triangle(mesh.nodes[f, c.NEIGHBOR]), mesh.nodes[f, 0])


@cached_njit(forceinline=True)
def insert(mesh, me, t, p, lock):
    """Subdivide leaf t, which contains p, and legalise: once about the star of p.

    Returns one of the star's triangles. All that is changed must be this thread's own for as long as it
    takes.

    Each turn adds a neighbour to p or goes on to the next one. There are no more of them than sites, with the
    vertex at infinity in place of p. The store's reserve has room for as many flips.
    """
    f = subdivide(mesh, me, t, p, lock)
    last = mesh.nodes[f, 1]  # the edge from p to this vertex is never flipped
    for _ in range(2 * len(mesh.points) + 8):
        if illegal(mesh, f):
            f = flip(mesh, me, f, 0, lock)
        elif mesh.nodes[f, 2] == last:
            return f
        else:
            f = triangle(mesh.nodes[f, c.NEIGHBOR + 1])
    msg = "the legalisation of a site in a 2D triangulation does not end"
    raise InternalError(msg)
