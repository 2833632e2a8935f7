"""The sequential correction of swaps that were given up (Kohout et al. 2004, section 3.4).

Any triangulation becomes the Delaunay triangulation when illegal edges are flipped until there are none (C.
L. Lawson: Transforming triangulations, Discrete Mathematics 3, 1972). This is done in place: the history is
not needed any more.
"""

from __future__ import annotations

import numba

from ..predicates.borrowed import borrowed
from .cavity import in_conflict
from .store import CHILD, INFINITE, NEIGHBOR


@numba.njit(cache=True)
def _illegal(points, nodes, t, k, w):
    """Whether edge k of t is: the far vertex of one side in conflict with the triangle on the other."""
    edge = nodes[t, NEIGHBOR + k]
    if nodes[t, k] != INFINITE:
        return in_conflict(points, nodes, edge >> 2, nodes[t, k], w)
    far = nodes[edge >> 2, edge & 3]
    return far != INFINITE and in_conflict(points, nodes, t, far, w)


@numba.njit(cache=True)
def _set(nodes, t, k, edge):
    nodes[t, NEIGHBOR + k] = edge
    nodes[edge >> 2, NEIGHBOR + (edge & 3)] = 4 * t + k


@numba.njit(cache=True)
def _flip(nodes, t, k):
    """Flip edge k of t: t and its neighbour u become the two triangles on both sides of the new edge."""
    edge = nodes[t, NEIGHBOR + k]
    u, j = edge >> 2, edge & 3
    k1, k2, j1, j2 = (k + 1) % 3, (k + 2) % 3, (j + 1) % 3, (j + 2) % 3
    p, a, b, d = nodes[t, k], nodes[t, k1], nodes[t, k2], nodes[u, j]
    beyond_bp, beyond_pa = nodes[t, NEIGHBOR + k1], nodes[t, NEIGHBOR + k2]
    beyond_ad, beyond_db = nodes[u, NEIGHBOR + j1], nodes[u, NEIGHBOR + j2]
    nodes[t, 0], nodes[t, 1], nodes[t, 2] = p, a, d
    nodes[u, 0], nodes[u, 1], nodes[u, 2] = p, d, b
    _set(nodes, t, 0, beyond_ad)
    _set(nodes, t, 2, beyond_pa)
    _set(nodes, u, 0, beyond_db)
    _set(nodes, u, 1, beyond_bp)
    _set(nodes, t, 1, 4 * u + 2)


@numba.njit(nogil=True, cache=True)
def correct(points, nodes, used, w):
    """Flip until no edge is illegal; how many flips."""
    points, nodes, w = borrowed(points), borrowed(nodes), borrowed(w)
    flips, changed = 0, True
    while changed:
        changed = False
        for t in range(used):
            if nodes[t, CHILD] >= 0:
                continue
            k = 0
            while k < 3:
                # an edge is illegal from both sides or from none
                if nodes[t, NEIGHBOR + k] >> 2 < t and _illegal(points, nodes, t, k, w):
                    _flip(nodes, t, k)
                    flips += 1
                    changed = True
                    k = 0
                else:
                    k += 1
    return flips
