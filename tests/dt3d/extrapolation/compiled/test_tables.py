"""Which sets the compiled steps serve, and the order of their sites."""

import jax
import numpy as np

from dt3d.extrapolation.compiled import tables
from dt3d.extrapolation.compiled.windows import cells_of

from .steps import random_set


def test_many_even_sites_are_served():
    many = random_set(tables.FEWEST_SITES)
    assert tables.serves(many)
    assert not tables.serves(many[:-1])
    assert not tables.serves(many**8)


def test_sites_of_a_cell_follow_each_other():
    sites = np.unique(random_set(700), axis=0)
    with jax.enable_x64(True):
        cells = tables.in_cells(sites)
    np.testing.assert_array_equal(cells.sites, sites[cells.order])
    number = cells_of(cells.sites, cells.windows.grid)
    assert (np.diff(number) >= 0).all()
    starts = np.asarray(cells.tables.rows.starts)
    for cell in np.unique(number):
        assert (number[starts[cell] : starts[cell + 1]] == cell).all()
    assert not cells.tables.lattice
