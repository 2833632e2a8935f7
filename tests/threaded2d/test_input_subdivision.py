"""Parts of equal sizes by each rule, and orders of insertion in which every site comes once."""

import warnings
from itertools import pairwise

import numpy as np
import pytest

from dt3d import threaded2d
from dt3d.ordering.brio import brio
from dt3d.threaded2d.configuration import Options
from dt3d.threaded2d.input_subdivision import SUBDIVISIONS, insertion_order, parts_of

from .families import EVERY_SET, uniform


@pytest.mark.parametrize("subdivision", SUBDIVISIONS)
@pytest.mark.parametrize("parts", [1, 2, 7])
def test_parts_have_equal_sizes_up_to_one(subdivision, parts):
    for n in (7, 100, 701):
        sizes = np.bincount(parts_of(uniform(n), subdivision, parts, 3), minlength=parts)
        assert len(sizes) == parts
        assert max(sizes) - min(sizes) <= 1


@pytest.mark.parametrize("name", EVERY_SET)
def test_parts_ascend_with_what_they_are_by(name):
    points = EVERY_SET[name](200)
    by_x = parts_of(points, "x-slabs", 5, 0)
    by_distance = parts_of(points, "distance", 5, 0)
    squared = (points**2).sum(axis=1)
    for k in range(4):
        assert points[by_x <= k, 0].max() <= points[by_x > k, 0].min()
        assert squared[by_distance <= k].max() <= squared[by_distance > k].min() * (1 + 1e-15)
    assert (np.diff(parts_of(points, "curve", 5, 0)) >= 0).all()


def test_random_parts_depend_on_the_seed_alone():
    points = uniform(500)
    drawn = [parts_of(points, "random", 4, seed) for seed in range(40)]
    assert len({part.tobytes() for part in drawn}) == 40
    np.testing.assert_array_equal(parts_of(points[::-1], "random", 4, 7), drawn[7])
    # each site comes into each part
    assert all(set(row) == {0, 1, 2, 3} for row in np.array(drawn).T[::25].tolist())


@pytest.mark.parametrize("subdivision", SUBDIVISIONS)
@pytest.mark.parametrize("method", ["sequential", "batch", "optimistic"])
@pytest.mark.parametrize("order", ["brio", "random"])
def test_an_order_has_every_site_once_and_part_by_part(subdivision, method, order):
    points, threads = uniform(700), 1 if method == "sequential" else 4
    options = Options(method=method, threads=threads, order=order, subdivision=subdivision, seed=5)
    sites, bounds = insertion_order(points, options)
    np.testing.assert_array_equal(np.sort(sites), np.arange(len(points)))
    parts = {"sequential": 1, "batch": 3, "optimistic": 4}[method]
    part = parts_of(points, subdivision, parts, 5)
    assert bounds.tolist() == [0, *np.cumsum(np.bincount(part)).tolist()]
    assert (np.diff(part[sites]) >= 0).all()


def test_threads_among_each_other_begin_their_rounds_at_different_places():
    points = uniform(700)
    options = Options(method="optimistic", threads=4)
    rotated, _ = insertion_order(points, options)
    order, starts = brio(parts_of(points, "random", 4, 0), 4, 0)
    for k, ends in enumerate(starts.tolist()):
        for begin, end in pairwise(ends):
            want = np.roll(order[begin:end], -((end - begin) * k // 4))
            np.testing.assert_array_equal(rotated[begin:end], want)
    assert (rotated != order).any()
    for unmoved in (
        Options(method="optimistic", threads=4, subdivision="curve"),
        Options(method="batch", threads=5),
    ):
        part = parts_of(points, unmoved.subdivision, 4, 0)
        np.testing.assert_array_equal(insertion_order(points, unmoved)[0], brio(part, 4, 0)[0])


def test_slabs_are_inserted_by_their_threads():
    points = uniform(2000)
    slabs = threaded2d.Delaunay(points, method="optimistic", threads=4, subdivision="x-slabs")
    by_x = slabs.inserted_by[np.argsort(points[:, 0])]
    # but for the first triangle, which is the first thread's, the threads have slabs of 500
    assert (by_x != np.arange(2000) // 500).sum() <= 3


@pytest.mark.parametrize("subdivision", SUBDIVISIONS)
def test_subdivisions_of_sets_whose_squares_overflow(subdivision):
    points = np.vstack([np.random.default_rng(0).random((200, 2)) * 1.7e308, [[5e-324, 0]]])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        tri = threaded2d.Delaunay(points, method="optimistic", threads=2, subdivision=subdivision)
    assert tri.verify(), tri.verify()


def test_rings_about_the_origin_at_all_magnitudes():
    distance = np.concatenate([np.ldexp(1.0, np.arange(-1070, 1024, 7)), [1.5e308]])
    angle = np.random.default_rng(0).random(len(distance))
    points = np.column_stack([np.cos(angle), np.sin(angle)]) * distance[:, None]
    part = parts_of(points, "distance", 3, 0)
    assert (np.diff(part) >= 0).all()
