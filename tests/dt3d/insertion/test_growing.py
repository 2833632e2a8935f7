"""A store that goes on: rows, numbers of sites, equal ones, memory."""

import numpy as np

from dt3d.insertion import driver, store
from dt3d.insertion.growing import Growing

RNG = np.random.default_rng(11)


def in_order(simplices):
    rows = np.sort(simplices, axis=1)
    return rows[np.lexsort(rows.T[::-1])]


def assert_as_from_scratch(growing, sites):
    simplices, neighbors = growing.result()
    scratch = driver.triangulate(sites)
    np.testing.assert_array_equal(in_order(simplices), in_order(scratch.simplices))
    np.testing.assert_array_equal(growing.duplicates, scratch.duplicates)
    across = simplices[neighbors]  # -1 is any, and is not looked at
    for k in range(4):
        there = neighbors[:, k] >= 0
        facet = np.delete(simplices, k, axis=1)[there]
        shared = (across[there, k, :, None] == facet[:, None, :]).any(axis=2).sum(axis=1)
        assert (shared == 3).all()


def test_of_equal_sites_the_first_is_used_whatever_was_inserted_first():
    sites = RNG.random((400, 3))
    growing = Growing(sites[:100])
    more = sites[RNG.integers(50, 400, 900)]  # of old ones and of each other
    growing.add(more)
    assert_as_from_scratch(growing, np.vstack([sites[:100], more]))
    assert len(growing.duplicates) > 500


def test_memory_grows(monkeypatch):
    monkeypatch.setattr(driver, "SLOTS_PER_SITE", 1)
    monkeypatch.setattr(store, "SLOTS_PER_CHECK", 64)
    sites = RNG.random((3000, 3))
    growing = Growing(sites[:20])
    for begin, end in [(20, 25), (25, 300), (300, 3000)]:
        growing.add(sites[begin:end])
    assert_as_from_scratch(growing, sites)


def test_results_do_not_change_afterwards():
    sites = RNG.random((200, 3))
    growing = Growing(sites[:100])
    simplices, neighbors = growing.result()
    kept = simplices.copy(), neighbors.copy()
    growing.add(sites[100:])
    np.testing.assert_array_equal(simplices, kept[0])
    np.testing.assert_array_equal(neighbors, kept[1])


def test_coordinates_without_bounds_are_not_taken():
    growing = Growing(RNG.random((100, 3)))
    assert growing.takes(np.empty((0, 3)))
    assert growing.takes(np.array([[1.0, -1.0, 0.0]]))
    assert not growing.takes(np.array([[0.5, -1.5, 0.0]]))
    assert not growing.takes(np.array([[0.5, 0.0, np.nextafter(1, 2)]]))
    assert not Growing(RNG.random((100, 3)) * 8).takes(np.zeros((1, 3)))
