"""Searches through cells and through the tree, against brute force."""

import numpy as np
import pytest

from .searching import SETS, in_order, nearest


@pytest.mark.parametrize("name", SETS)
def test_nearest_site(name, load):
    buckets = load(SETS[name])
    sites = in_order(buckets)
    answer = nearest(buckets)
    squared = ((sites[:, None] - sites) ** 2).sum(axis=2)
    np.fill_diagonal(squared, np.inf)
    np.testing.assert_array_equal(answer.best.site.to_numpy(), squared.argmin(axis=1))
    np.testing.assert_allclose(answer.best.high.to_numpy(), squared.min(axis=1), rtol=1e-14)
    assert len(sites) <= answer.sites_searched <= (len(sites) + 8) ** 2
