"""The tree of boxes, against brute force."""

import numpy as np
import pytest

import scanvec as sv
from dt3d.extrapolation.gift_wrapping import squared_distance_to_box
from dt3d.extrapolation.points import Point
from dt3d.extrapolation.tree import boxes as tree

from ..searching import MACHINE, RNG


@pytest.mark.parametrize("n", [1, 8, 9, 64, 65, 600])
def test_the_tree_holds_every_site_once_on_every_level(n):
    points = RNG.random((n, 3))
    built = tree.build(Point(*(MACHINE.vector(c.copy()) for c in points.T)))
    low, high = (np.stack([v.to_numpy() for v in p], axis=1) for p in (built.low, built.high))
    for level, (first, size) in enumerate(zip(built.first, built.sizes, strict=True)):
        for node in range(size):
            own = points[node * 8 ** (level + 1) : (node + 1) * 8 ** (level + 1)]
            np.testing.assert_array_equal(low[first + node], own.min(axis=0))
            np.testing.assert_array_equal(high[first + node], own.max(axis=0))
    assert built.sizes[-1] <= 8


def test_a_descent_finds_every_leaf_that_admits(monkeypatch):
    points = RNG.random((600, 3))
    sites = Point(*(MACHINE.vector(c.copy()) for c in points.T))
    built = tree.build(sites)
    radius = MACHINE.vector(np.linspace(0.01, 0.5, 50))
    centre = sv.get(sites, MACHINE.iota(50))
    test = tree.entry_test(_ball_meets)
    for most in (tree.MOST_NODE_REQUESTS, 40):
        monkeypatch.setattr(tree, "MOST_NODE_REQUESTS", most)
        batches = list(tree.descend(built, (centre, radius), test))
        query = np.concatenate([b.query.to_numpy() for b in batches])
        leaf = np.concatenate([b.node.to_numpy() for b in batches])
        assert (np.diff(query) >= 0).all()
        low, high = (
            np.stack([v.to_numpy() for v in p], axis=1)[: built.sizes[0]] for p in (built.low, built.high)
        )
        for q in range(50):
            gap = np.maximum(np.maximum(low - points[q], points[q] - high), 0)
            want = np.flatnonzero((gap**2).sum(axis=1) <= radius.to_numpy()[q] ** 2)
            assert sorted(leaf[query == q].tolist()) == want.tolist()


def _ball_meets(ball, low, high):
    centre, radius = ball
    return squared_distance_to_box(centre, low, high) <= radius * radius
