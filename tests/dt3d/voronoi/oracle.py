"""Voronoi diagrams of a few sites in rational numbers, by trying every simplex."""

from __future__ import annotations

from collections import defaultdict
from fractions import Fraction
from itertools import combinations


def rank(rows):
    """The rank of a matrix of Fractions."""
    rows, found = [list(row) for row in rows], 0
    for column in range(len(rows[0]) if rows else 0):
        pivot = next((i for i in range(found, len(rows)) if rows[i][column]), None)
        if pivot is None:
            continue
        rows[found], rows[pivot] = rows[pivot], rows[found]
        for i in range(found + 1, len(rows)):
            factor = rows[i][column] / rows[found][column]
            rows[i] = [x - factor * y for x, y in zip(rows[i], rows[found], strict=True)]
        found += 1
    return found


def solve(rows, right):
    """The solution of a square system of Fractions, or None if there is not one."""
    n = len(rows)
    rows = [[*row, r] for row, r in zip(rows, right, strict=True)]
    for k in range(n):
        pivot = next((i for i in range(k, n) if rows[i][k]), None)
        if pivot is None:
            return None
        rows[k], rows[pivot] = rows[pivot], rows[k]
        rows[k] = [x / rows[k][k] for x in rows[k]]
        for i in range(n):
            if i != k and rows[i][k]:
                rows[i] = [x - rows[i][k] * y for x, y in zip(rows[i], rows[k], strict=True)]
    return tuple(row[n] for row in rows)


def minus(p, q):
    return tuple(x - y for x, y in zip(p, q, strict=True))


def dot(p, q):
    return sum(x * y for x, y in zip(p, q, strict=True))


def cross(p, q):
    return (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])


class Oracle:
    """All vertices, and what makes regions and ridges, of distinct sites.

    Attributes
    ----------
    sites : list of tuples of Fraction
    vertices : dict
        For each vertex, a tuple of Fraction, the sites on its empty sphere.
    outward : list
        Outward normals of facets of the hull, each with all sites on its plane.
    """

    def __init__(self, points):
        self.sites = [tuple(map(Fraction, p)) for p in points]
        self.d = len(self.sites[0])
        self.vertices = self._vertices()
        self.outward = self._outward()

    def _vertices(self):
        found, done = {}, set()
        for chosen in combinations(range(len(self.sites)), self.d + 1):
            if any(set(chosen) <= sites for sites in done):
                continue
            first = self.sites[chosen[0]]
            edges = [minus(self.sites[i], first) for i in chosen[1:]]
            centre = solve(edges, [dot(e, e) / 2 for e in edges])
            if centre is None:
                continue
            squares = [dot(x, x) for x in (minus(minus(s, first), centre) for s in self.sites)]
            least = dot(centre, centre)
            if min(squares) == least:
                on = frozenset(i for i, square in enumerate(squares) if square == least)
                done.add(on)
                found[tuple(x + y for x, y in zip(first, centre, strict=True))] = on
        return found

    def _outward(self):
        found = {}
        for chosen in combinations(range(len(self.sites)), self.d):
            first = self.sites[chosen[0]]
            edges = [minus(self.sites[i], first) for i in chosen[1:]]
            normal = (-edges[0][1], edges[0][0]) if self.d == 2 else cross(*edges)
            heights = [dot(normal, minus(s, first)) for s in self.sites]
            if not any(normal) or min(heights) < 0 < max(heights):
                continue
            if max(heights) > 0:
                normal = tuple(-x for x in normal)
            on = frozenset(i for i, height in enumerate(heights) if height == 0)
            found[on] = normal
        return [(normal, on) for on, normal in found.items()]

    def region(self, *sites):
        """The vertices and the directions to infinity that the regions of some sites share."""
        chosen = set(sites)
        ends = [v for v, on in self.vertices.items() if chosen <= on]
        rays = [normal for normal, on in self.outward if chosen <= on]
        return ends, rays

    def ridges(self):
        """For each pair of sites whose regions share a facet, its vertices and whether it is unbounded."""
        found = {}
        pairs = defaultdict(set)
        for on in self.vertices.values():
            for p, q in combinations(sorted(on), 2):
                pairs[p, q].add(on)
        for p, q in pairs:
            ends, rays = self.region(p, q)
            directions = [minus(e, ends[0]) for e in ends[1:]] + rays
            if rank(directions) == self.d - 1:
                found[p, q] = set(ends), bool(rays)
        return found
