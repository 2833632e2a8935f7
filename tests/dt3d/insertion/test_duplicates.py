"""Equal sites are found by their coordinates alone, whatever the scale of the cells that they lie in.

A difference of coordinates that rounds makes different sites look equal; if that decides the order, a copy is
no longer beside the site that it copies, and is inserted a second time.
"""

from pathlib import Path

import numpy as np
import pytest

import dt3d
from dt3d._input import first_copies
from dt3d.insertion import driver
from dt3d.ordering import along_curve
from dt3d.ordering.along_curve import along_curve_in_space
from dt3d.ordering.duplicates import separate_copies

from ..exact import validate
from ..families import tetrahedra

CASES = Path(__file__).parents[3].parent / "shared" / "cases"


def crowded_cell(n, exponent):
    """A tetrahedron of about 1, n sites of a small lattice times 2^exponent, and near ones.

    In one cell of the lattice lie two sites that are 2^-70 times as near each other, and a copy of one.
    """
    rng = np.random.default_rng(0)
    cell = np.unique(np.ldexp(rng.integers(-8, 9, (n, 3)).astype(float), exponent), axis=0)
    a, b = [np.ldexp(1.0, exponent - 70), 0, 0], [np.ldexp(1.0, exponent - 71), 0, 0]
    return np.concatenate([np.eye(3), [[-1, -1, -1]], [a, b, a], cell])


def subnormal_cell(n):
    """Multiples of the least float64, with copies, beside a tetrahedron of about 1."""
    cell = np.random.default_rng(n).integers(-3, 4, (n, 3)) * 2.0**-1074
    return np.concatenate([np.eye(3), [[-1, -1, -1]], cell])


def signed_zeros(n):
    """Sites on the planes between the octants, whose zeros have either sign."""
    rng = np.random.default_rng(n)
    sites = rng.integers(-2, 3, (n, 3)).astype(float)
    sites[sites == 0] *= rng.choice([-1, 1], (sites == 0).sum())
    return np.concatenate([np.eye(3), sites])


def cells_within_cells(levels, n=150):
    """In each cell n sites, copies among them, and a cell 2^-60 times as large."""
    rng = np.random.default_rng(levels)
    cells = [np.ldexp(rng.integers(-8, 9, (n, 3)).astype(float), -60 * k) for k in range(levels)]
    return rng.permutation(np.concatenate(cells))


def huge_and_tiny(n):
    """Sites of all magnitudes that float64 has, of either sign, with copies."""
    rng = np.random.default_rng(n)
    exponents = rng.integers(-1074, 1022, (n, 3))
    sites = np.ldexp(rng.choice([-1.0, 1.0], (n, 3)), exponents)
    return rng.permutation(np.concatenate([sites, sites[::2]]))


def all_of_float64():
    """A box whose extent overflows, and in it a crowd of the least magnitude, with copies."""
    corners = np.concatenate([np.eye(3), -np.eye(3)]) * np.finfo(float).max
    return np.concatenate([corners, subnormal_cell(400)])


SETS = {
    "crowded cell 2^-910": crowded_cell(300, -910),
    "crowded cell 2^-960": crowded_cell(300, -960),
    "crowded cell 2^-1000": crowded_cell(1000, -1000),
    "subnormal cell": subnormal_cell(1000),
    "signed zeros": signed_zeros(1000),
    "cells within cells": cells_within_cells(17),
    "huge and tiny": huge_and_tiny(400),
    "all of float64": all_of_float64(),
}


def sets(*names):
    return pytest.mark.parametrize("name", names or SETS)


def at_once(work, n):
    work(0, n)


@sets()
@pytest.mark.parametrize("seed", range(4))
def test_equal_sites_are_together_on_the_curve(name, seed):
    sites = np.random.default_rng(seed).permutation(SETS[name])
    along = along_curve_in_space(sites, at_once)
    assert sorted(along.tolist()) == list(range(len(sites)))
    used, pairs = separate_copies(sites, along)
    want, copies = first_copies(sites)
    np.testing.assert_array_equal(np.sort(along[:used]), np.sort(want))
    np.testing.assert_array_equal(pairs, copies)
    assert len(pairs) > 0


@sets("crowded cell 2^-910", "crowded cell 2^-960", "subnormal cell", "signed zeros")
@pytest.mark.parametrize("threads", [1, 2])
def test_copies_in_a_crowded_cell_are_not_inserted(name, threads, monkeypatch):
    monkeypatch.setattr(driver, "available_cores", lambda: 2)
    monkeypatch.setattr("dt3d.insertion.team.LEAST_SITES_PER_THREAD", 20)
    points = SETS[name]
    tri = dt3d.Delaunay(points, threads=threads)
    assert tri.stats.threads == threads
    np.testing.assert_array_equal(tri.duplicates, first_copies(points)[1])
    validate(tri)
    shuffled = dt3d.Delaunay(np.random.default_rng(1).permutation(points), threads=threads)
    np.testing.assert_array_equal(tetrahedra(shuffled), tetrahedra(tri))


def test_the_levels_of_cells_are_bounded():
    """Every level leaves a small part of the extent, so the smallest float64 is reached before the bound."""
    sites = np.ldexp(1.0, np.repeat(np.arange(1023, -1075, -1), 15))[:, None] * [1, -1, 0.5]
    along = along_curve_in_space(sites, at_once)
    assert sorted(along.tolist()) == list(range(len(sites)))


def test_levels_beyond_the_bound_are_an_internal_error(monkeypatch):
    monkeypatch.setattr(along_curve, "MOST_LEVELS", 3)
    with pytest.raises(dt3d.InternalError, match="share a cell after 4 subdivisions.*please report"):
        along_curve_in_space(cells_within_cells(17), at_once)


@pytest.mark.parametrize("name", ["s13399", "s13399min"])
def test_sets_that_lost_copies(name):
    file = CASES / f"{name}.npy"
    if not file.exists():
        pytest.skip(f"{file} is not here")
    points = np.load(file)
    tri = dt3d.Delaunay(points)
    np.testing.assert_array_equal(tri.duplicates, first_copies(points)[1])
    validate(tri)
