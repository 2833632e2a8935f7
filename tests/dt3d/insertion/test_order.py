"""The curve, equal sites on it, and the rounds of insertion."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from dt3d._input import first_copies
from dt3d.insertion import order

from ..families import grid


def at_once(work, n):
    work(0, n)


def in_threes(work, n):
    for begin in range(0, n, 3):
        work(begin, min(begin + 3, n))


@pytest.mark.parametrize("k", [2, 4, 16])
def test_the_curve_goes_from_each_cell_to_one_beside_it(k):
    sites = (grid(k) + 0.5) / k
    along = order.along_curve(sites[np.random.default_rng(k).permutation(k**3)], at_once)
    assert sorted(along.tolist()) == list(range(k**3))
    shuffled = sites[np.random.default_rng(k).permutation(k**3)]
    steps = np.abs(np.diff(shuffled[order.along_curve(shuffled, in_threes)], axis=0)).sum(axis=1)
    # the box of the sites is not that of the cells, so a few steps are longer
    assert np.median(steps) * k == pytest.approx(1)
    assert steps.mean() * k < 1.5


def copied(seed, distinct, n, scale):
    rng = np.random.default_rng(seed)
    return (rng.random((distinct, 3)) * scale)[rng.integers(distinct, size=n)]


@pytest.mark.parametrize("scale", [1.0, 2.0**-600, 2.0**-1060])
@pytest.mark.parametrize(("distinct", "n"), [(1, 300), (5, 1000), (500, 1000), (2000, 2000)])
def test_equal_sites_are_found_and_the_first_is_kept(distinct, n, scale):
    sites = copied(n, distinct, n, scale)
    along = order.along_curve(sites, at_once)
    assert sorted(along.tolist()) == list(range(n))
    used, pairs = order.separate_copies(sites, along)
    want, copies = first_copies(sites)
    np.testing.assert_array_equal(np.sort(along[:used]), np.sort(want))
    np.testing.assert_array_equal(pairs, copies)


def test_clusters_within_clusters_have_curves_of_their_own():
    rng = np.random.default_rng(0)
    sites = np.concatenate([rng.random((1000, 3)) * 2.0 ** (-30 * k) for k in range(8)])
    along = order.along_curve(sites, at_once)
    assert sorted(along.tolist()) == list(range(len(sites)))
    level = along // 1000
    assert (np.diff(level) != 0).sum() < 40  # each cluster is one stretch, but for its corner at the next
    for k in range(8):
        inside = sites[along[level == k]]
        steps = np.linalg.norm(np.diff(inside, axis=0), axis=1) / 2.0 ** (-30 * k)
        assert steps.mean() < 0.2  # in no order 0.66


@given(st.integers(5, 3000), st.integers(0, 2**31), st.sets(st.integers(0, 4), min_size=4, max_size=4))
def test_rounds_have_all_sites_once_in_ascending_order(n, seed, left_out):
    sequence, ends = order.insertion_rounds(n, seed, np.array(sorted(left_out), np.int32))
    assert sorted([*sequence.tolist(), *left_out]) == list(range(n))
    assert ends[-1] == len(sequence)
    for begin, end in zip([0, *ends], ends, strict=False):
        assert (np.diff(sequence[begin:end].astype(int)) > 0).all()


def test_rounds_grow_fourfold():
    n = 200_000
    _, ends = order.insertion_rounds(n, 0, np.arange(4, dtype=np.int32))
    assert order.SMALLEST_ROUND < ends[0] < 5 * order.SMALLEST_ROUND
    want = n / 4.0 ** np.arange(len(ends))[::-1]
    assert (np.abs(ends - want) < 6 * np.sqrt(want)).all()
