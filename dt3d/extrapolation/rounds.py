"""The paper's rounds of a finished triangulation, for compiled steps that find it in another order.

Teng et al. 1993, section 3: the first round expands a facet of every site, that with its nearest site and of
least circumcircle, and every other round the faces that the one before has opened. So a tetrahedron of a
first facet is found in round 1, and any other one a round after the first of its neighbors. An exact
triangulation does not depend on the order in which it was found, and therefore tells its rounds.
"""

from __future__ import annotations

import numpy as np

from .._numba.kernel_cache import cached_njit
from .._topology import OUTSIDE


@cached_njit
def _squared(sites, a, b):
    x, y, z = sites[a, 0] - sites[b, 0], sites[a, 1] - sites[b, 1], sites[a, 2] - sites[b, 2]
    return x * x + y * y + z * z


@cached_njit(nogil=True)
def _nearest(sites, simplices):
    """The nearest site of each along an edge, the first of several: int32 (n,)."""
    nearest = np.full(len(sites), -1, np.int32)
    least = np.full(len(sites), np.inf)
    for t in range(len(simplices)):
        for i in range(3):
            a = simplices[t, i]
            for j in range(i + 1, 4):
                b = simplices[t, j]
                d = _squared(sites, a, b)
                if d < least[a] or (d == least[a] and b < nearest[a]):
                    least[a], nearest[a] = d, b
                if d < least[b] or (d == least[b] and a < nearest[b]):
                    least[b], nearest[b] = d, a
    return nearest


@cached_njit(nogil=True)
def _least_circle(sites, a, b, c):
    """Four times the squared circumradius; infinity for flat triangles."""
    ux, uy, uz = sites[b, 0] - sites[a, 0], sites[b, 1] - sites[a, 1], sites[b, 2] - sites[a, 2]
    vx, vy, vz = sites[c, 0] - sites[a, 0], sites[c, 1] - sites[a, 1], sites[c, 2] - sites[a, 2]
    x, y, z = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    area = x * x + y * y + z * z
    if area <= 0:
        return np.inf
    return (ux * ux + uy * uy + uz * uz) * (vx * vx + vy * vy + vz * vz) * _squared(sites, b, c) / area


@cached_njit(nogil=True)
def _first_facets(sites, simplices, nearest):
    """Of each site the first facet, as 4 t + k, opposite the k-th vertex of t: int64 (n,)."""
    first = np.full(len(sites), -1, np.int64)
    least = np.full(len(sites), np.inf)
    third = np.full(len(sites), -1, np.int32)
    for t in range(len(simplices)):
        for i in range(4):
            a = simplices[t, i]
            b = nearest[a]
            for j in range(4):
                if simplices[t, j] != b:
                    continue
                # the two facets about the edge from a to b
                for k in range(4):
                    if k in (i, j):
                        continue
                    c = simplices[t, 6 - i - j - k]
                    radius = _least_circle(sites, a, b, c)
                    if radius < least[a] or (radius == least[a] and c < third[a]):
                        least[a], third[a], first[a] = radius, c, 4 * t + k
    return first


@cached_njit(nogil=True)
def _by_breadth(neighbors, first, found):
    """Enter the round of each tetrahedron in ``found``, zeros; the last round, which may find nothing."""
    queue = np.empty(len(neighbors), np.int32)
    opened_outside = np.zeros((len(neighbors), 4), np.bool_)
    tail = 0
    for facet in first:
        if facet < 0:
            continue
        t, k = facet >> 2, facet & 3
        u = neighbors[t, k]
        # its other side is expanded in the first round, too
        if u < 0:
            opened_outside[t, k] = True
        for s in (t, np.int64(u)):
            if s >= 0 and found[s] == 0:
                found[s] = 1
                queue[tail] = s
                tail += 1
    head, last = 0, 1
    while head < tail:
        t = queue[head]
        head += 1
        last = max(last, found[t])
        for k in range(4):
            u = neighbors[t, k]
            if u < 0:
                if not opened_outside[t, k]:
                    last = max(last, found[t] + 1)
            elif found[u] == 0:
                found[u] = found[t] + 1
                queue[tail] = u
                tail += 1
    return last


def rounds_of(
    sites: np.ndarray, simplices: np.ndarray, neighbors: np.ndarray
) -> tuple[np.ndarray, list[int]]:
    """The round of the paper that finds each tetrahedron, and how many each round finds.

    Where several sites are equally near the first of them counts, and of several least circles that of the
    first site.

    Parameters
    ----------
    sites : float64 (n, 3)
        Distinct, in lexicographic order.
    simplices, neighbors : int32 (m, 4)
        Of their exact triangulation.

    Returns
    -------
    rounds : int32 (m,)
        From 1.
    per_round : list of int
        The last round may find facets of the hull only: 0.
    """
    assert OUTSIDE < 0
    rounds = np.zeros(len(simplices), np.int32)
    first = _first_facets(sites, simplices, _nearest(sites, simplices))
    last = _by_breadth(neighbors, first, rounds)
    return rounds, np.bincount(rounds, minlength=last + 1)[1:].tolist()
