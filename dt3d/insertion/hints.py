"""Where the walk to a site that is added begins: at the last site that is known in its cell of a coarse grid.

From scratch each walk begins where the one before ended, near by along the curve. Added sites are far from
each other, and one that comes alone may be anywhere.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .mesh import inserted_rows
from .store import Store

SITES_PER_CELL = 4  # of uniform sets
MOST_CELLS_PER_AXIS = 32  # a finer grid would save some steps, and take longer to make than they do
SAMPLE = 2  # sites per cell that the table is made from; the others are near
MOST_GROWTH = 4  # the table is made again when there are so many times as many sites


class Hints:
    """A row of the store for each cell of a grid over the box of its sites, -1 where none is known.

    Parameters
    ----------
    store : Store
    """

    def __init__(self, store: Store) -> None:
        self._store = store
        self.made_for = 0

    def cell(self, x: float, y: float, z: float) -> int:
        """The cell of a place, or the nearest one."""
        self._keep_up()
        side, (a, b, c), (p, q, r) = self._side, self._low, self._scale
        last = side - 1
        # places far outside a thin box are beyond all integers
        i = int(min(max((x - a) * p, 0.0), last))
        j = int(min(max((y - b) * q, 0.0), last))
        k = int(min(max((z - c) * r, 0.0), last))
        return (i * side + j) * side + k

    def cells(self, sites: npt.NDArray[np.float64]) -> npt.NDArray[np.int64]:
        """The cells of sites, float64 (k, 3)."""
        self._keep_up()
        return self._cells(sites)

    def near(self, cells: npt.NDArray[np.int64]) -> npt.NDArray[np.int32]:
        """A row of a vertex in each of these cells, -1 where none is known."""
        return self._table[cells]

    def near_one(self, cell: int) -> int:
        """The same for one cell."""
        return int(self._table[cell])

    def note(self, cells: npt.NDArray[np.int64] | int, rows: npt.NDArray[np.int64] | int) -> None:
        """Note the rows of new vertices."""
        self._table[cells] = rows

    def _keep_up(self) -> None:
        """Make the table, at first and when there are many more sites."""
        if len(self._store.sites) <= 4 * MOST_GROWTH * self.made_for:
            return
        self.made_for = len(self._store.sites) // 4
        rows = inserted_rows(self._store.sites, max(1, self.made_for // (SAMPLE * MOST_CELLS_PER_AXIS**3)))
        places = self._store.sites.reshape(-1, 4)[rows, :3]
        self._side = int(min(MOST_CELLS_PER_AXIS, max(1, (self.made_for / SITES_PER_CELL) ** (1 / 3))))
        low, high = places.min(axis=0, initial=1.0), places.max(axis=0, initial=-1.0)
        with np.errstate(over="ignore"):
            # flat boxes have one layer of cells
            scale = np.where(high > low, self._side / np.where(high > low, high - low, 1.0), 0.0)
        self._low, self._scale = low.tolist(), np.where(np.isfinite(scale), scale, 0.0).tolist()
        self._table: npt.NDArray[np.int32] = np.full(self._side**3, -1, np.int32)
        self._table[self._cells(places)] = rows

    def _cells(self, sites: npt.NDArray[np.float64]) -> npt.NDArray[np.int64]:
        cells = np.zeros(len(sites), np.int64)
        for k in range(3):
            with np.errstate(over="ignore"):
                place = (sites[:, k] - self._low[k]) * self._scale[k]
            cells = cells * self._side + np.clip(place, 0, self._side - 1).astype(np.int64)
        return cells
