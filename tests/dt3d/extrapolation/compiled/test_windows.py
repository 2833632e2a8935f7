"""Windows, against the cells of all sites."""

import numpy as np

from dt3d.extrapolation.compiled.windows import cells_of, grid_of, windows_of

from .steps import random_set


def test_windows_hold_the_sites_of_their_cells():
    sites = random_set(500) * [1, 2, 0.1]
    cells = grid_of(sites, 1.5)
    windows = windows_of(sites, cells, 512)
    number = cells_of(sites, cells)
    i, j, k = number % cells.nx, number // cells.nx % cells.ny, number // (cells.nx * cells.ny)
    for z, y, x in np.ndindex(windows.nz, windows.ny, windows.nx):
        w = x + windows.nx * (y + windows.ny * z)
        members = windows.members[windows.starts[w] : windows.starts[w + 1]]
        inside = (abs(i - x - 1) <= 1) & (abs(j - y - 1) <= 1) & (abs(k - z - 1) <= 1)
        np.testing.assert_array_equal(np.sort(members), np.flatnonzero(inside))
