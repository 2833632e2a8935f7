"""First tetrahedra: a facet at each of a few sites, wrapped in floating point and proved by its expansions.

Teng et al. 1993, section 3, begin at every site; all tetrahedra can be found from one.
"""

from __future__ import annotations

import numpy as np

from .windows import Windows

SITES_PER_SEED = 200
MOST_SEEDS = 1024


def chosen_sites(n: int) -> np.ndarray:
    """Which of n sites the triangulation begins at, at random."""
    count = min(MOST_SEEDS, max(1, n // SITES_PER_SEED))
    chosen: np.ndarray = np.random.default_rng(0).choice(n, count, replace=False)
    return chosen


def wrapped_facets(sites: np.ndarray, windows: Windows, chosen: np.ndarray) -> np.ndarray:
    """Facets (a, b, c) at the chosen sites a: b nearest, c of least circumradius, among a window's sites."""
    centred = _windows_about(sites[chosen], windows)
    starts, members = np.asarray(windows.starts), np.asarray(windows.members)
    first, last = starts[centred], starts[centred + 1]
    index = first[:, None] + np.arange((last - first).max())
    member = members[np.minimum(index, last[:, None] - 1)]
    with np.errstate(all="ignore"):
        offset = sites[member] - sites[chosen][:, None]
        squared = (offset**2).sum(axis=2)
        squared[member == chosen[:, None]] = np.inf
        rows = np.arange(len(chosen))
        nearest = squared.argmin(axis=1)
        b = member[rows, nearest]
        edge = offset[rows, nearest][:, None]
        area = (np.cross(edge, offset) ** 2).sum(axis=2)
        radius = squared * ((offset - edge) ** 2).sum(axis=2) / area
        radius[(member == chosen[:, None]) | (member == b[:, None]) | ~(area > 0)] = np.inf
        c = member[rows, radius.argmin(axis=1)]
        proper = np.isfinite(radius.min(axis=1)) & np.isfinite(squared.min(axis=1))
    facets: np.ndarray = np.stack([chosen, b, c], axis=1)[proper].astype(np.int32)
    return facets


def _windows_about(places: np.ndarray, windows: Windows) -> np.ndarray:
    """The window that has each place (m, 3) most in its middle."""
    shape = np.array([windows.nx, windows.ny, windows.nz])
    cell = np.floor((places - np.array(windows.grid.origin)) / windows.grid.side).astype(np.int64) - 1
    i, j, k = np.clip(cell, 0, shape - 1).T
    numbers: np.ndarray = i + shape[0] * (j + shape[1] * k)
    return numbers


def without_common_vertices(tetrahedra: np.ndarray, n: int) -> np.ndarray:
    """Those tetrahedra (m, 4) that share no vertex with an earlier one."""
    first = np.full(n, len(tetrahedra))
    row = np.repeat(np.arange(len(tetrahedra)), 4)
    np.minimum.at(first, tetrahedra.ravel(), row)
    alone: np.ndarray = (first[tetrahedra] == np.arange(len(tetrahedra))[:, None]).all(axis=1)
    kept: np.ndarray = tetrahedra[alone]
    return kept
