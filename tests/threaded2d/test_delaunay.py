"""Every method, number of threads and subdivision: one triangulation, proved, and found by brute force."""

from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import Delaunay as SciPyDelaunay

from dt3d import threaded2d
from dt3d.threaded2d.configuration import configured
from dt3d.threaded2d.driver import triangulate

from .families import DISTRIBUTIONS, EVERY_SET, assert_methods_agree, canonical

PARALLEL = ("batch", "circumcircle", "pessimistic", "optimistic")
SUBDIVISIONS = ("random", "x-slabs", "distance", "curve")


def brute_force(points):
    """Triangles with no perturbed site inside, in rational arithmetic.

    Heights are |p|^2 + e_p, with infinitesimals in the lexicographic order of coordinates: the first
    dominates.
    """
    exact = [tuple(Fraction(x) for x in p) for p in points.tolist()]
    rank = {p: i for i, p in enumerate(sorted(set(exact)))}
    first = {p: i for i, p in reversed(list(enumerate(exact)))}
    sites = sorted(first.values())

    def orient(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    found = []
    for i, j, k in combinations(sites, 3):
        a, b, c = exact[i], exact[j], exact[k]
        turn = orient(a, b, c)
        if turn == 0:
            continue
        if turn < 0:
            b, c, j, k = c, b, k, j
        area = abs(turn)
        for d in (exact[s] for s in sites if s not in (i, j, k)):
            weights = {a: orient(d, b, c) / area, b: orient(a, d, c) / area, c: orient(a, b, d) / area}
            height = sum(x * x for x in d) - sum(weights[v] * sum(x * x for x in v) for v in (a, b, c))
            if height == 0:
                for v in sorted((a, b, c, d), key=rank.__getitem__):
                    height = 1 if v == d else -weights[v]
                    if height:
                        break
            if height < 0:
                break
        else:
            found.append((i, j, k))
    return canonical(np.array(found, np.int64).reshape(-1, 3))


@pytest.mark.parametrize("name", EVERY_SET)
def test_all_methods_agree_and_are_proved(name):
    points = EVERY_SET[name](400)
    reference = threaded2d.Delaunay(points, method="sequential")
    assert reference.verify(), reference.verify()
    want = canonical(reference.triangles)
    rng = np.random.default_rng(0)
    for method in PARALLEL:
        for threads in range(1 + (method == "batch"), 9):
            for order, location in (("brio", "dag"), ("random", "dag"), ("brio", "walk"), ("random", "walk")):
                subdivision = str(rng.choice(SUBDIVISIONS[: 4 if order == "brio" else 3]))
                tri = threaded2d.Delaunay(
                    points,
                    method=method,
                    threads=threads,
                    order=order,
                    location=location,
                    subdivision=subdivision,
                )
                np.testing.assert_array_equal(canonical(tri.triangles), want)
                assert sum(tri.stats.inserted) == len(points) - len(tri.duplicates) - 3
        assert tri.verify(), tri.verify()
    for threads in (1, 2, 8):
        tri = threaded2d.Delaunay(points, threads=threads)
        np.testing.assert_array_equal(canonical(tri.triangles), want)
        assert tri.verify(), tri.verify()


@pytest.mark.parametrize("name", EVERY_SET)
@pytest.mark.parametrize("method", PARALLEL)
def test_runs_under_contention_with_random_yields(name, method):
    points = EVERY_SET[name](150)
    want = canonical(threaded2d.Delaunay(points, method="sequential").triangles)
    rng = np.random.default_rng(0)
    for seed in range(25):  # 8 sets: 200 runs of each method
        order, location = str(rng.choice(["brio", "random"])), str(rng.choice(["dag", "walk"]))
        subdivision, length = str(rng.choice(SUBDIVISIONS[:3])), int(rng.choice([2, 3, 64]))
        options = configured(
            len(points),
            method=method,
            threads=int(rng.integers(2, 9)),
            order=order,
            location=location,
            queue_length=length,
            subdivision=subdivision,
            seed=seed,
            preset="kohout2004" if seed % 3 == 0 else None,
        )
        outcome = triangulate(points, options.contended(2, helping=bool(seed % 2)))
        np.testing.assert_array_equal(canonical(outcome.triangles), want)
        assert (outcome.inserted_by[np.unique(outcome.triangles)] >= 0).all()


@pytest.mark.slow
@pytest.mark.parametrize("n", [10**5, 10**6])
@pytest.mark.parametrize("name", DISTRIBUTIONS)
def test_large_sets(name, n):
    points = DISTRIBUTIONS[name](n)
    reference = threaded2d.Delaunay(points, method="sequential")
    assert reference.verify(), reference.verify()
    want = canonical(reference.triangles)
    assert_methods_agree(points, want)


@pytest.mark.parametrize("name", ["uniform", "gauss", "cluster"])
def test_scipy_finds_the_same(name):
    points = EVERY_SET[name](3000)
    tri = threaded2d.Delaunay(points)
    scipy = SciPyDelaunay(points)
    np.testing.assert_array_equal(
        canonical(np.sort(tri.triangles, axis=1)), canonical(np.sort(scipy.simplices, axis=1))
    )


@given(st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4)), min_size=3, max_size=14), st.integers(0, 3))
def test_brute_force_finds_the_same(sites, seed):
    points = np.array(sites, float)
    want = brute_force(points)
    for options in (
        {"method": "sequential"},
        {"method": "auto", "threads": 2},
        {"method": "circumcircle", "threads": 3, "order": "random"},
    ):
        try:
            tri = threaded2d.Delaunay(points, seed=seed, **options)
        except threaded2d.DegenerateInputError:
            assert not len(want)
        else:
            np.testing.assert_array_equal(canonical(tri.triangles), want)
            assert tri.verify(), tri.verify()


def test_the_triangulation_does_not_depend_on_the_order_of_rows_or_on_a_power_of_two():
    points = EVERY_SET["grid"](400)
    want = canonical(threaded2d.Delaunay(points).triangles)
    shuffle = np.random.default_rng(0).permutation(len(points))
    back = shuffle[threaded2d.Delaunay(points[shuffle]).triangles]
    np.testing.assert_array_equal(canonical(back), want)
    for exponent in (-500, 500):
        tri = threaded2d.Delaunay(np.ldexp(points, exponent))
        np.testing.assert_array_equal(canonical(tri.triangles), want)


def test_growth_of_the_history(monkeypatch):
    monkeypatch.setattr("dt3d.threaded2d.mesh.NODES_PER_SITE", 1)
    monkeypatch.setattr("dt3d.threaded2d.mesh.BLOCK", 16)
    points = EVERY_SET["uniform"](3000)
    want = canonical(threaded2d.Delaunay(points, method="auto").triangles)
    for method, threads in (
        ("sequential", 1),
        ("batch", 3),
        ("circumcircle", 3),
        ("optimistic", 3),
        ("pessimistic", 3),
    ):
        tri = threaded2d.Delaunay(points, method=method, threads=threads)
        assert tri.stats.growths >= 1
        np.testing.assert_array_equal(canonical(tri.triangles), want)
        assert tri.verify(), tri.verify()
