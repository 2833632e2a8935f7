"""For tests that go step by step: a method with its tools, and what is true of a structure, found without it.

The oracles are for sites in general position.
"""

from fractions import Fraction

import numpy as np
from scipy.spatial import Delaunay as SciPyDelaunay

from dt3d.threaded2d import columns as c
from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.driver import METHODS
from dt3d.threaded2d.virtual_time.costs import prepared


def begun(points, method, threads, location="dag"):
    """The store of a run of which no step is done, and the method's tools."""
    options = Options(method=method, threads=threads, order="random", location=location)
    store, schedule = prepared(points, options)
    return store, METHODS[method].tools(store, schedule, options)


def leaves(store):
    """The triangles and ghosts of the present triangulation."""
    return np.flatnonzero(store.nodes[: store.used, c.CHILD] < 0)


def assert_delaunay(store):
    """The finite leaves are what SciPy finds of their vertices."""
    triangles = store.nodes[leaves(store), :3]
    triangles = triangles[(triangles >= 0).all(axis=1)]
    used = np.unique(triangles)
    assert _sorted(triangles) == _sorted(used[SciPyDelaunay(store.points[used]).simplices])


def _sorted(triangles):
    return sorted(sorted(row) for row in triangles.tolist())


def leaf_pairs(store):
    """The leaves at each edge, which is the set of its vertices."""
    found = {}
    for t in leaves(store).tolist():
        row = store.nodes[t, :3].tolist()
        for k in range(3):
            found.setdefault(frozenset(row[:k] + row[k + 1 :]), []).append(t)
    assert all(len(sides) == 2 for sides in found.values())
    return found


def across(store, t, k, pairs):
    """The leaf on the other side of the edge of t opposite its k-th vertex."""
    row = store.nodes[t, :3].tolist()
    (other,) = set(pairs[frozenset(row[:k] + row[k + 1 :])]) - {t}
    return other


def _exact(points, v):
    return tuple(Fraction(x) for x in points[v].tolist())


def orientation(points, a, b, v):
    """Twice the area of three sites, in rational numbers."""
    (ax, ay), (bx, by), (x, y) = (_exact(points, u) for u in (a, b, v))
    return (bx - ax) * (y - ay) - (by - ay) * (x - ax)


def conflicts(store, t, q):
    """Whether site q lies in the circle of triangle t, or beyond the edge of a ghost."""
    row, points = store.nodes[t, :3].tolist(), store.points
    if min(row) < 0:
        k = row.index(c.INFINITE)
        return orientation(points, row[(k + 1) % 3], row[(k + 2) % 3], q) > 0
    x, y = _exact(points, q)
    rows = [(u - x, v - y) for u, v in (_exact(points, v) for v in row)]
    (a, b), (d, e), (g, h) = rows
    lifts = [u * u + v * v for u, v in rows]
    return lifts[0] * (d * h - e * g) - lifts[1] * (a * h - b * g) + lifts[2] * (a * e - b * d) > 0
