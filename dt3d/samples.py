"""Real point sets that come with the package; their sources and licences are in data/README.md."""

from __future__ import annotations

from importlib.resources import files

import numpy as np


def mtor() -> np.ndarray:
    """Atoms of two mTOR-mLST8 complexes, a kinase that controls cell growth (Protein Data Bank entry 4JSV).

    Returns
    -------
    float64 (22194, 3)
        Coordinates in ångström, all distinct. Dense globules with clefts and a wide gap between the copies:
        nothing like a uniform set.
    """
    with (files(__package__) / "data" / "mtor.npz").open("rb") as stream:
        points: np.ndarray = np.load(stream)["points"]
    return points


def crater_lake() -> np.ndarray:
    """The terrain of Crater Lake, USA: column, row and height in metres of 459 x 336 grid points.

    Returns
    -------
    float64 (154224, 3)
        Whole numbers. Seen from above a grid, in which all ties have to be decided.
    """
    with (files(__package__) / "data" / "crater_lake.npz").open("rb") as stream:
        heights = np.load(stream)["heights"]
    row, column = np.indices(heights.shape)
    return np.column_stack([column.ravel(), row.ravel(), heights.ravel()]).astype(float)
