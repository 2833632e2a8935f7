"""Buckets: the sites, reordered so that each cell holds consecutive ones.

Teng et al. 1993, section 4.2.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

import scanvec as sv

from .boxes import Grid, cell_of
from .points import Point

SITES_PER_CELL = 8  # the paper's average (section 7)
MOST_CELLS_PER_SITE = 4  # how far cells are refined for sites that leave most cells empty


class Buckets(NamedTuple):
    """Sites in the order of their cells, and where each cell's sites are."""

    sites: Point  # vectors of length n
    origin: sv.Vector  # int32 (n,): the index of each site in the order it came
    starts: sv.Vector  # int32 (cells,)
    counts: sv.Vector  # int32 (cells,)
    grid: Grid


def bucket(sites: Point) -> Buckets:
    """Sort sites into cubic cells with about eight sites in each cell that has any.

    Where sites lie on a surface or in clusters, most cells of a grid with eight sites a cell on average are
    empty and the others crowded; the cells are then made smaller, up to four a site.
    """
    machine, n = sites.x.machine, len(sites.x)
    low = [float(sv.reduce(v, sv.MIN)) for v in sites]
    high = [float(sv.reduce(v, sv.MAX)) for v in sites]
    dtype = sites.x.dtype.type
    wanted = n / SITES_PER_CELL
    while True:
        grid = _grid(low, high, wanted, dtype)
        cells = int(grid.nx) * int(grid.ny) * int(grid.nz)
        cell = machine.map(cell_of, sites, grid)
        ones, none = machine.full(n, 1, np.int32), machine.full(cells, 0, np.int32)
        counts = sv.send(ones, cell, sv.ADD, none)
        occupied = int(sv.reduce(counts > 0, sv.ADD))
        crowding = n / occupied / SITES_PER_CELL
        if crowding < 1.5 or wanted * 2 > MOST_CELLS_PER_SITE * n:
            break
        wanted *= 2
    _, (ordered, origin) = sv.sort(cell, (sites, machine.iota(n)))
    return Buckets(ordered, origin, sv.scan(counts, sv.ADD), counts, grid)


def _grid(low: list[float], high: list[float], wanted: float, dtype: Any) -> Grid:
    """Cubic cells over the box from low to high, about ``wanted`` of them."""
    extents = np.maximum(np.subtract(high, low), 0)
    # bisect for the side: the number of cells falls with it
    small, large = extents.max() / 2**20, max(extents.max(), np.finfo(np.float32).tiny)
    for _ in range(60):
        side = np.sqrt(small * large)
        if np.prod(np.maximum(np.ceil(extents / side), 1)) > wanted:
            small = side
        else:
            large = side
    counts = [np.int32(max(1, np.ceil(e / large))) for e in extents]
    return Grid(Point(*(dtype(v) for v in low)), dtype(large), *counts)
