"""Seeds: integers of any size, which give one result each; small ones give what they always gave."""

import numpy as np
import pytest

import dt3d
from dt3d import threaded2d
from dt3d._input import check_seed, word_of

POINTS = np.random.default_rng(0).random((60, 3))
GREAT = [2**31, 2**32, 2**63 - 1, 2**63, 2**64 - 1, 2**64, 2**200 + 1]


@pytest.mark.parametrize("seed", GREAT, ids=lambda seed: f"{seed.bit_length()} bits")
def test_a_seed_of_any_size(seed):
    tri = dt3d.Delaunay(POINTS, seed=seed)
    np.testing.assert_array_equal(np.unique(np.sort(tri.simplices, axis=1), axis=0), sorted_simplices())
    for method, order in (("auto", "brio"), ("sequential", "random"), ("optimistic", "brio")):
        plane = threaded2d.Delaunay(POINTS[:, :2], seed=seed, method=method, order=order, threads=1)
        assert plane.verify()


def sorted_simplices():
    return np.unique(np.sort(dt3d.Delaunay(POINTS).simplices, axis=1), axis=0)


def test_great_seeds_differ_and_small_ones_stay():
    words = [word_of(seed) for seed in GREAT]
    assert len(set(words)) == len(words)
    assert words == [word_of(seed) for seed in GREAT]
    assert all(0 <= word < 2**63 for word in words)
    assert [word_of(seed) for seed in (0, 1, 12345, 2**63 - 1)] == [0, 1, 12345, 2**63 - 1]


@pytest.mark.parametrize("seed", [np.int8(7), np.uint64(2**64 - 1), np.int64(3), np.uint32(5)])
def test_seeds_of_numpy_are_the_same_as_of_python(seed):
    a, b = (dt3d.Delaunay(POINTS, seed=s) for s in (seed, int(seed)))
    np.testing.assert_array_equal(a.simplices, b.simplices)
    assert type(check_seed(seed)) is int


@pytest.mark.parametrize("seed", [True, False, np.True_, -1, np.int64(-5), 1.0, "3", None, -(2**70)])
@pytest.mark.parametrize("make", [dt3d.Delaunay, lambda p, seed: threaded2d.Delaunay(p[:, :2], seed=seed)])
def test_what_is_no_seed(make, seed):
    with pytest.raises(ValueError, match="seed must be an integer that is not negative, of any size, got "):
        make(POINTS, seed=seed)


def test_a_great_seed_of_the_random_perturbation():
    tri = dt3d.Delaunay(POINTS, robustness="perturb", seed=2**200)
    np.testing.assert_array_equal(np.unique(np.sort(tri.simplices, axis=1), axis=0), sorted_simplices())
