"""The input contract of meshes that others made: indices are checked before anything is looked up by them."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def check_simplices(
    simplices: npt.ArrayLike, sites: int, corners: int, name: str = "simplices"
) -> np.ndarray:
    """Simplices as int32 (m, corners), each entry the row of one of the sites.

    Raises
    ------
    ValueError
        If they are not integers, have another shape, or name sites that there are not.
    """
    return _check(simplices, corners, name, "sites", 0, sites, f"there are {sites} points")


def check_neighbors(neighbors: npt.ArrayLike, simplices: int, corners: int) -> np.ndarray:
    """Neighbours as int32 (simplices, corners), each entry the row of a simplex or -1 for none.

    Raises
    ------
    ValueError
        As `check_simplices`, and if there are more or fewer rows than simplices.
    """
    known = f"there are {simplices}, and -1 for none"
    checked = _check(neighbors, corners, "neighbors", "simplices", -1, simplices, known)
    if len(checked) != simplices:
        msg = f"neighbors must have one row per simplex, shape ({simplices}, {corners}), got {checked.shape}"
        raise ValueError(msg)
    return checked


def check_duplicates(duplicates: npt.ArrayLike, sites: int) -> np.ndarray:
    """Duplicates as int32 (k, 2): rows of a site and of the equal one that stands for it.

    Raises
    ------
    ValueError
        As `check_simplices`.
    """
    return _check(duplicates, 2, "duplicates", "sites", 0, sites, f"there are {sites} points")


def _check(
    indices: npt.ArrayLike, columns: int, name: str, of_what: str, least: int, end: int, known: str
) -> np.ndarray:
    shape = f"shape ({'k' if name == 'duplicates' else 'm'}, {columns})"
    if np.ma.is_masked(indices):
        msg = f"{name} have masked entries; drop those rows first"
        raise ValueError(msg)
    try:
        given = np.asarray(indices)
    except ValueError as error:
        msg = f"{name} must be integers of {shape}; the rows that came do not have one length ({error})"
        raise ValueError(msg) from None
    if given.shape == (0,):  # an empty list
        return np.empty((0, columns), np.int32)
    if given.dtype.kind not in "iu":
        msg = f"{name} must be integers of {shape}, got dtype {given.dtype}"
        raise ValueError(msg)
    if given.ndim != 2 or given.shape[1] != columns:
        msg = f"{name} must have {shape}, got {given.shape}"
        raise ValueError(msg)
    # as Python integers, which compare rightly with any dtype and do not wrap
    if given.size and not least <= int(given.min()) <= int(given.max()) < end:
        msg = f"{name} name {of_what} {given.min()} to {given.max()}, but {known}"
        raise ValueError(msg)
    return given.astype(np.int32, order="C")  # there are less than 2^31 of anything
