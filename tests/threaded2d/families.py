"""Sets of points in the plane, and triangles in an order that can be compared."""

import numpy as np

from dt3d import threaded2d


def canonical(triangles):
    """Triangles turned until the least vertex is first, in lexicographic order."""
    least = np.argmin(triangles, axis=1)[:, None]
    turned = np.take_along_axis(np.asarray(triangles), (least + np.arange(3)) % 3, axis=1)
    return turned[np.lexsort(turned.T[::-1])]


def grid(n):
    side = int(np.ceil(np.sqrt(n)))
    return np.stack(np.meshgrid(np.arange(side), np.arange(side)), -1).reshape(-1, 2)[:n].astype(float)


def uniform(n):
    return np.random.default_rng(1).random((n, 2))


def gauss(n):
    return np.random.default_rng(2).normal(0.5, 0.1, (n, 2))


def cluster(n):
    rng = np.random.default_rng(3)
    return rng.random((8, 2))[rng.integers(0, 8, n)] + rng.normal(0, 0.01, (n, 2))


def arc(n):
    angle = np.sort(np.random.default_rng(4).random(n)) * np.pi / 2
    return np.column_stack([np.cos(angle), np.sin(angle)])


DISTRIBUTIONS = {f.__name__: f for f in (grid, uniform, gauss, cluster, arc)}


def lattice_with_copies(n):
    return np.random.default_rng(5).integers(0, 12, (n, 2)).astype(float)


def line_and_apex(n):
    return np.vstack([np.column_stack([np.arange(n - 1.0), np.zeros(n - 1)]), [[n / 3, 7.0]]])


def circle_of_integers(n):
    """All integer points of the circle of radius 1105, up to n of them."""
    x, y = (z.ravel() for z in np.meshgrid(np.arange(-1105, 1106), np.arange(-1105, 1106)))
    on = x * x + y * y == 1105**2
    return np.column_stack([x[on], y[on]]).astype(float)[:n]


DEGENERATE = {f.__name__: f for f in (lattice_with_copies, line_and_apex, circle_of_integers)}
EVERY_SET = DISTRIBUTIONS | DEGENERATE


def assert_methods_agree(points, want):
    """Every method, with as many threads as usual, finds the triangles ``want``, in canonical order."""
    for method, threads in (
        ("batch", 4),
        ("circumcircle", 2),
        ("optimistic", 3),
        ("pessimistic", 2),
        ("auto", 2),
    ):
        tri = threaded2d.Delaunay(points, method=method, threads=threads)
        np.testing.assert_array_equal(canonical(tri.triangles), want)
