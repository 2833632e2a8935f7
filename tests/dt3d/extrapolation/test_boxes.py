"""Boxes against sets of cells."""

import itertools

import hypothesis.strategies as st
import jax.numpy as jnp
import pytest
from hypothesis import given

from dt3d.extrapolation.boxes import Box, Grid, cell_of, contains, difference_cell, extend, volume
from dt3d.extrapolation.points import Point


@st.composite
def boxes(draw, within=None):
    bounds = []
    for low, high in within or [(0, 5)] * 3:
        a, b = sorted(draw(st.tuples(st.integers(low, high), st.integers(low, high))))
        bounds.append((a, b))
    return bounds


def box(bounds):
    return Box(*(jnp.int32(x) for pair in bounds for x in pair))


def cells(b):
    ranges = (
        range(int(b.x0), int(b.x1) + 1),
        range(int(b.y0), int(b.y1) + 1),
        range(int(b.z0), int(b.z1) + 1),
    )
    return set(itertools.product(*ranges))


NOTHING = Box(*(jnp.int32(x) for x in (0, -1, 0, -1, 0, -1)))


@pytest.mark.slow
@given(st.data())
def test_every_cell_of_the_difference_is_named_once(data):
    outer = data.draw(boxes())
    new = box(outer)
    dead = box(data.draw(boxes(outer))) if data.draw(st.booleans()) else NOTHING
    count = int(volume(new)) - int(volume(dead))
    k = jnp.arange(count, dtype=jnp.int32)
    named = list(
        zip(*(x.tolist() for x in jnp.broadcast_arrays(*difference_cell(new, dead, k))), strict=True)
    )
    assert len(set(named)) == count
    assert set(named) == cells(new) - cells(dead)


@given(boxes(), boxes())
def test_contains_and_volume(a, b):
    assert bool(contains(box(a), box(b))) == (cells(box(b)) <= cells(box(a)))
    assert int(volume(box(a))) == len(cells(box(a)))
    assert bool(contains(box(a), NOTHING))
    assert int(volume(NOTHING)) == 0


@given(boxes(), boxes(), st.integers(1, 8))
def test_extend_grows_towards_the_target_and_no_further(dead, target, steps):
    grown = extend(box(dead), box(target), steps)
    assert cells(box(dead)) <= cells(grown)
    hull = [(min(a, c), max(b, d)) for (a, b), (c, d) in zip(dead, target, strict=True)]
    assert cells(grown) <= cells(box(hull))
    for (a, b), (c, d) in zip(dead, [grown[0:2], grown[2:4], grown[4:6]], strict=True):
        assert a - steps <= c
        assert d <= b + steps
    if steps == 8:
        assert bool(contains(grown, box(target)))


def test_cells_far_away_are_clipped_to_the_grid():
    grid = Grid(Point(0.0, 0.0, 0.0), Point(1.0, 1.5, 2.0), 0.5, 1e-6, 2, 3, 4)
    for x, want in ((-1e30, 0), (0.0, 0), (0.75, 1), (1e30, 1), (jnp.inf, 1), (jnp.nan, 0)):
        assert int(cell_of(Point(x, 0.0, 0.0), grid)) == want
    assert int(cell_of(Point(9.0, 9.0, 9.0), grid)) == 2 * 3 * 4 - 1
