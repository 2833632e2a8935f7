"""Sorting by several threads."""

import numpy as np
import pytest

from dt3d.ordering import sorting
from dt3d.ordering.along_curve import along_curve_in_plane


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
    want = along_curve_in_plane(points)
    monkeypatch.setattr(sorting, "WORTH_A_THREAD", 1)
    for threads in (2, 3, 7):
        for found, expected in zip(along_curve_in_plane(points, threads), want, strict=True):
            np.testing.assert_array_equal(found, expected)
