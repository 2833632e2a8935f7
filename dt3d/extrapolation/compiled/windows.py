"""Windows: for every block of cells the list of its sites, made once, so that a search is one loop over it.

There are uniform cells, and a window for each 3 x 3 x 3 of them. A face looks into the window about the place
where its fourth vertex is expected. A site is in up to 27 windows, 108 bytes.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .. import buckets
from ..boxes import Grid
from ..buckets import _grid as make_grid

CELLS = 3  # of a window along an axis
SITES_PER_CELL = 1.33  # so 36 a window


class Windows(NamedTuple):
    """All windows; that of the cells from (i, j, k) on is i + nx (j + ny k)."""

    grid: Grid
    nx: Any  # windows along the axes
    ny: Any
    nz: Any
    starts: Any  # int32 (windows + 1, or more): where each one's sites begin in the list
    members: Any  # int32 (entries, or more): indices of sites


def cells_of(sites: np.ndarray, grid: Grid) -> np.ndarray:
    """The number of each site's cell, int64 (n,), x running fastest."""
    counts = np.array([grid.nx, grid.ny, grid.nz])
    place = (sites - np.array(grid.origin)) / grid.side
    i, j, k = np.clip(place.astype(np.int64), 0, counts - 1).T
    return i + counts[0] * (j + counts[1] * k)


def grid_of(sites: np.ndarray, sites_per_cell: float) -> Grid:
    """Cubic cells over the box of sites (n, 3)."""
    low, high = sites.min(axis=0).tolist(), sites.max(axis=0).tolist()
    return make_grid(low, high, len(sites) / sites_per_cell, np.float64)


def even(sites: np.ndarray) -> bool:
    """Whether sites (n, 3) leave few cells empty, by the measure of `buckets.bucket`."""
    cell = cells_of(sites, grid_of(sites, buckets.SITES_PER_CELL))
    occupied = int(np.count_nonzero(np.bincount(cell)))
    return len(sites) <= buckets.EVEN * buckets.SITES_PER_CELL * occupied


def windows_of(sites: np.ndarray, grid: Grid, capacity: int) -> Windows:
    """The windows of a grid over sites (n, 3), in arrays for ``capacity`` sites."""
    counts = np.array([grid.nx, grid.ny, grid.nz])
    cell = cells_of(sites, grid)
    order = np.argsort(cell, kind="stable").astype(np.int32)
    first = np.zeros(np.prod(counts) + 1, np.int64)
    np.cumsum(np.bincount(cell, minlength=np.prod(counts)), out=first[1:])
    shape = np.maximum(counts - CELLS + 1, 1)
    across = np.minimum(counts, CELLS)
    x, y, z = (np.arange(s) for s in shape)
    corner = (x + counts[0] * (y[:, None] + counts[1] * z[:, None, None])).ravel()
    row = counts[0] * (np.arange(across[1]) + counts[1] * np.arange(across[2])[:, None]).ravel()
    # the cells of a row of a window follow each other, and so do their sites
    begin = corner[:, None] + row
    run, end = first[begin], first[begin + across[0]]
    length = end - run
    before = np.cumsum(length) - length.ravel()
    entries = int(length.sum())
    members = np.zeros(CELLS**3 * capacity, np.int32)
    places = np.repeat(run.ravel() - before, length.ravel()) + np.arange(entries)
    members[:entries] = order[places]
    starts = np.full(max(2 * capacity, len(corner)) + 1, entries, np.int32)
    starts[: len(corner)] = before[:: len(row)]
    nx, ny, nz = shape.astype(np.int32)
    return Windows(grid, nx, ny, nz, starts, members)
