"""The order of sites: Hilbert's curve and the rounds along it."""

import numpy as np
import pytest

from dt3d.threaded2d import sorting
from dt3d.threaded2d.order import along_curve, brio, rounds_of


@pytest.mark.parametrize("side", [2, 16, 64])
def test_the_curve_goes_from_each_cell_to_one_beside_it(side):
    y, x = np.divmod(np.arange(side * side), side)
    points = np.column_stack([x, y]).astype(float)
    shuffle = np.random.default_rng(0).permutation(len(points))
    site, pairs = along_curve(points[shuffle])
    assert len(pairs) == 0
    path = points[shuffle][site]
    assert len(np.unique(path, axis=0)) == side * side
    assert (np.abs(np.diff(path, axis=0)).sum(axis=1) == 1).all()


def test_copies_are_found_on_the_curve():
    points = np.random.default_rng(1).integers(0, 6, (60, 2)) / 7
    site, pairs = along_curve(points)
    _, first = np.unique(points, axis=0, return_index=True)
    assert sorted(site) == sorted(first)
    assert sorted(np.append(site, pairs[:, 0])) == list(range(60))
    np.testing.assert_array_equal(points[pairs[:, 0]], points[pairs[:, 1]])


def test_rounds_double_and_go_along_the_rows():
    n, parts = 40_000, 3
    part = (np.arange(n) * parts // n).astype(np.int32)
    order, starts = brio(part, parts, 0)
    assert sorted(order) == list(range(n))
    sizes = np.diff(starts, axis=1)
    assert sizes.shape == (parts, rounds_of(n))
    for k in range(parts):
        for r in range(rounds_of(n)):
            sites = order[starts[k, r] : starts[k, r + 1]]
            assert (part[sites] == k).all()
            assert (np.diff(sites) > 0).all()
    total = sizes.sum(axis=0)
    assert np.all(np.abs(total[-3:] / n - [1 / 8, 1 / 4, 1 / 2]) < 0.01)


@pytest.mark.parametrize("n", [1, 2, 7, 100, 1001])
@pytest.mark.parametrize("threads", [1, 2, 3, 5, 8])
@pytest.mark.parametrize("most", [3, 2**64])
def test_sorting_by_several_threads(monkeypatch, n, threads, most):
    monkeypatch.setattr(sorting, "WORTH_A_THREAD", 1)
    words = np.random.default_rng(n).integers(0, most, n, np.uint64)

    def fill(out, begin):
        out[:] = words[begin : begin + len(out)]

    np.testing.assert_array_equal(sorting.sort_runs(threads, n, fill), np.sort(words))


def test_several_threads_find_the_same_curve(monkeypatch):
    points = np.random.default_rng(3).integers(0, 300, (5000, 2)) / 7
    want = along_curve(points)
    monkeypatch.setattr(sorting, "WORTH_A_THREAD", 1)
    for threads in (2, 3, 7):
        for found, expected in zip(along_curve(points, threads), want, strict=True):
            np.testing.assert_array_equal(found, expected)
