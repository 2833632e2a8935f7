"""The order of coordinates is that of tuples."""

import itertools

import numpy as np
import pytest

from dt3d.ordering.lexicographic import before, equal


@pytest.mark.parametrize("d", [2, 3])
def test_rows_compare_like_tuples(d):
    points = np.array(list(itertools.product([-1.0, -0.0, 0.0], repeat=d)))
    rows = [tuple(p) for p in points.tolist()]
    for i, j in itertools.product(range(len(rows)), repeat=2):
        assert before(points, i, j) == (rows[i] < rows[j])
        assert equal(points, i, j) == (rows[i] == rows[j])
