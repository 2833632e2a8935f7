"""Sets with all magnitudes of float64: no rounded difference decides order, or whether sites are equal."""

import numpy as np
import pytest

from dt3d import threaded2d
from dt3d.ordering.along_curve import along_curve_in_plane

from .families import canonical
from .test_delaunay import brute_force

RUNS = [
    (method, threads)
    for method in ("auto", "sequential", "batch", "circumcircle", "pessimistic", "optimistic")
    for threads in (1, 2, 4)
    if (method, threads) not in (("sequential", 2), ("sequential", 4), ("batch", 1))
]


def crowded(exponent, drawn):
    """Three far sites, and so many draws of a lattice that is 2^exponent wide.

    In its cell of the curve lie also sites that a rounded difference does not tell apart: A, B, A.
    """
    rng = np.random.default_rng(drawn)
    lattice = np.ldexp(rng.integers(-8, 9, (drawn, 2)).astype(float), exponent)
    tiny = [[2.0**-980, 0], [2.0**-981, 0], [2.0**-980, 0]]
    return np.vstack([np.eye(2), [[-1, -1]], tiny, lattice, tiny[::-1]])


def subnormal(n):
    """Multiples of the least float64, with copies."""
    return np.random.default_rng(n).integers(-3, 3, (n, 2)) * 5e-324


def exponents(n):
    """Huge and tiny coordinates in one set, with copies."""
    rng = np.random.default_rng(n)
    values = np.ldexp(
        rng.integers(-2, 3, (n, 2)).astype(float), rng.choice([-1074, -980, -910, 0, 1021], (n, 2))
    )
    return values[rng.integers(0, n, 2 * n)]


def widest(n):
    """Differences overflow, and the least coordinates are subnormal."""
    most = np.finfo(float).max
    return np.vstack([[[most, -most], [-most, most], [most, most], [-5e-324, 0.0]], exponents(n)])


def signed_zeros(n):
    """The sites of a small lattice, with zeros of both signs."""
    rng = np.random.default_rng(n)
    values = rng.integers(-2, 3, (n, 2)).astype(float)
    return np.where((values == 0) & (rng.random((n, 2)) < 0.5), -0.0, values)


SETS = {
    "crowded": crowded(-910, 10),
    "crowded subnormals": crowded(-1074, 10),
    "subnormal": subnormal(20),
    "exponents": exponents(14),
    "widest": widest(12),
    "signed zeros": signed_zeros(40),
}


def copies_of(points):
    """(later, first) for equal rows, by Python's floats."""
    first = {}
    pairs = [[i, first.setdefault(tuple(p), i)] for i, p in enumerate(points.tolist())]
    return [pair for pair in pairs if pair[0] != pair[1]]


@pytest.mark.parametrize("name", SETS)
def test_all_magnitudes_by_all_methods(name):
    points = SETS[name]
    want, copies = brute_force(points), copies_of(points)
    assert copies
    assert len(want)
    for seed in range(2):
        rows = np.random.default_rng(seed).permutation(len(points))
        shuffled = points[rows]
        expected = copies_of(shuffled)
        # copies of a site may come first in other orders; the first of each is the one that is used
        used = {tuple(p): i for i, p in reversed(list(enumerate(shuffled.tolist())))}
        number = np.array([used[tuple(p)] for p in points.tolist()])
        for method, threads in RUNS:
            tri = threaded2d.Delaunay(shuffled, method=method, threads=threads, seed=seed)
            assert tri.duplicates.tolist() == expected
            np.testing.assert_array_equal(canonical(tri.triangles), canonical(number[want]))


@pytest.mark.parametrize("exponent", [-905, -960, -1074])
def test_a_crowded_cell_is_triangulated_by_all_methods(exponent):
    points = crowded(exponent, 400)
    copies = copies_of(points)
    want = None
    for method, threads in RUNS:
        tri = threaded2d.Delaunay(points, method=method, threads=threads)
        assert tri.duplicates.tolist() == copies
        found = canonical(tri.triangles)
        if want is None:
            assert tri.verify(), tri.verify()
            want = found
        np.testing.assert_array_equal(found, want)


@pytest.mark.parametrize("name", SETS)
def test_copies_on_the_curve_are_equal_sites(name):
    points = SETS[name]
    site, pairs = along_curve_in_plane(points)
    assert pairs.tolist() == copies_of(points)
    assert sorted([*site, *pairs[:, 0]]) == list(range(len(points)))


def test_the_curve_has_cells_where_differences_overflow():
    rng = np.random.default_rng(0)
    points = (2 * rng.random((500, 2)) - 1) * np.finfo(float).max
    np.testing.assert_array_equal(
        along_curve_in_plane(points)[0], along_curve_in_plane(points * 2.0**-1000)[0]
    )
