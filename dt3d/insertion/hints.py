"""Where a walk to a single site begins: at the last site that is known in its cell of a coarse grid.

Along the curve each walk begins where the one before ended. A site that comes alone may be anywhere.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .mesh import known_tetrahedron
from .store import Store

SITES_PER_CELL = 4  # of uniform sets
MOST_CELLS_PER_AXIS = 64  # whose table has a megabyte
LARGEST_PART = 4  # the table is made again when there are so many times as many sites


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
        if len(self._store.sites) > 4 * LARGEST_PART * self.made_for:
            self._make()
        side, (a, b, c), (p, q, r) = self._side, self._low, self._scale
        i, j, k = int((x - a) * p), int((y - b) * q), int((z - c) * r)
        last = side - 1
        i = 0 if i < 0 else min(i, last)
        j = 0 if j < 0 else min(j, last)
        k = 0 if k < 0 else min(k, last)
        return (i * side + j) * side + k

    def near(self, cell: int) -> int:
        """A tetrahedron near a cell, -1 where none is known."""
        row = int(self._table[cell])
        return known_tetrahedron(self._store.mesh, row) if row >= 0 else -1

    def note(self, cell: int, row: int) -> None:
        """Note the row of a site."""
        self._table[cell] = row

    def _make(self) -> None:
        rows = self._store.sites.reshape(-1, 4)[:, :3]
        self.made_for = len(rows)
        self._side = int(min(MOST_CELLS_PER_AXIS, max(1, (len(rows) / SITES_PER_CELL) ** (1 / 3))))
        low, high = rows.min(axis=0), rows.max(axis=0)
        self._low = low.tolist()
        with np.errstate(over="ignore"):
            # flat boxes have one layer of cells; none of them is flat in all directions
            self._scale = np.where(high > low, self._side / (high - low), 0.0).tolist()
        if not np.isfinite(self._scale).all():
            self._scale = [0.0] * 3
        cells = np.zeros(len(rows), np.int64)
        for k in range(3):
            place = ((rows[:, k] - self._low[k]) * self._scale[k]).astype(np.int64)
            cells = cells * self._side + np.clip(place, 0, self._side - 1)
        self._table: npt.NDArray[np.int32] = np.full(self._side**3, -1, np.int32)
        self._table[cells] = np.arange(len(rows), dtype=np.int32)
