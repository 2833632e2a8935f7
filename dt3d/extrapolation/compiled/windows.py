"""Windows: for every block of cells the list of its sites, made once, so that a search is one loop over it.

There are uniform cells, and a window for each 3 x 3 x 3 of them. A face looks into the window about the place
where its fourth vertex is expected. A site is in up to 27 windows, 108 bytes.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array

from .. import buckets
from ..boxes import Box, Grid, HostGrid
from ..buckets import cubic_grid
from ..exact.filtered_distance import Frame
from ..points import add, norm, scale
from ..search_options import SITES_PER_CELL

CELLS = 3  # of a window along an axis
SITES_PER_FINE_CELL = 1.33  # so 36 a window
# Where a window is centred: so many sides of a fine cell above the face.
AHEAD = 0.5


class Windows(NamedTuple):
    """All windows; that of the cells from (i, j, k) on is i + nx (j + ny k). In NumPy, then in JAX."""

    grid: Grid[Array]
    nx: Array  # windows along the axes
    ny: Array
    nz: Array
    starts: Array  # int32 (windows + 1, or more): where each one's sites begin in the list
    members: Array  # int32 (entries, or more): indices of sites


def cells_of(sites: np.ndarray, grid: HostGrid) -> np.ndarray:
    """The number of each site's cell, int64 (n,), x running fastest."""
    counts = np.array([grid.nx, grid.ny, grid.nz])
    place = (sites - np.array(grid.origin)) / grid.side
    i, j, k = np.clip(place.astype(np.int64), 0, counts - 1).T
    numbers: np.ndarray = i + counts[0] * (j + counts[1] * k)
    return numbers


def grid_of(sites: np.ndarray, sites_per_cell: float) -> HostGrid:
    """Cubic cells over the box of sites (n, 3)."""
    low, high = sites.min(axis=0).tolist(), sites.max(axis=0).tolist()
    return cubic_grid(low, high, len(sites) / sites_per_cell, np.float64)


def are_even(sites: np.ndarray) -> bool:
    """Whether sites (n, 3) leave few cells empty, by the measure of `buckets.bucket`."""
    cell = cells_of(sites, grid_of(sites, SITES_PER_CELL))
    occupied = int(np.count_nonzero(np.bincount(cell)))
    return len(sites) <= buckets.EVENNESS * SITES_PER_CELL * occupied


def windows_of(sites: np.ndarray, grid: HostGrid, capacity: int) -> Windows:
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
    return Windows(grid, nx, ny, nz, starts, members)  # type: ignore[arg-type]  # in NumPy at first


def window_ahead(query: Frame, ahead: Array | float, windows: Windows) -> tuple[Array, Box[Array]]:
    """The window about the place where a face's fourth vertex is expected, and its cells.

    ``ahead`` is a length, `AHEAD` cells.
    """
    grid = windows.grid
    place = add(add(query.origin, query.centre), scale(ahead / norm(query.normal), query.normal))
    corner = []
    shape = (windows.nx, windows.ny, windows.nz)
    for x, low, high, n in zip(place, grid.origin, grid.high, shape, strict=True):
        first = jnp.round((jnp.clip(x, low, high) - low) / grid.side - CELLS / 2)
        corner.append(jnp.where(jnp.isnan(first), 0, jnp.clip(first, 0, n - 1)).astype(jnp.int32))
    i, j, k = corner
    last = [
        jnp.minimum(c + CELLS, cells) - 1
        for c, cells in zip(corner, (grid.nx, grid.ny, grid.nz), strict=True)
    ]
    return i + windows.nx * (j + windows.ny * k), Box(i, last[0], j, last[1], k, last[2])


def window_around(cap: Box[Array], windows: Windows) -> tuple[Array, Box[Array]]:
    """The window with a box of cells in its middle, and its cells."""
    grid = windows.grid
    i, last_i = _middle(cap.x0, cap.x1, windows.nx, grid.nx)
    j, last_j = _middle(cap.y0, cap.y1, windows.ny, grid.ny)
    k, last_k = _middle(cap.z0, cap.z1, windows.nz, grid.nz)
    return i + windows.nx * (j + windows.ny * k), Box(i, last_i, j, last_j, k, last_k)


def _middle(first: Array, last: Array, places: Array, cells: Array) -> tuple[Array, Array]:
    """The first and last cell along an axis of the window about the cells from ``first`` to ``last``."""
    start = jnp.clip((first + last) // 2 - (CELLS - 1) // 2, 0, places - 1)
    return start, jnp.minimum(start + CELLS, cells) - 1
