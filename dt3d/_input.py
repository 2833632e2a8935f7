"""The input contract: what is accepted as sites, and what the errors say."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._errors import DegenerateInputError
from ._exact_conversion import to_float64 as to_float64

# Indices of faces (four a tetrahedron, some seven tetrahedra a site) are int32.
MOST_SITES = 2**25


def check_points(points: Any, dimension: int = 3) -> np.ndarray:
    """The points as a float64 array of shape (n, dimension).

    Raises
    ------
    ValueError
        If they are not numbers, not of shape (n, dimension), empty, masked, not finite, too many, or integers
        that float64 cannot hold.
    """
    if np.ma.isMaskedArray(points):
        msg = "points are a masked array; drop the masked rows first, for example points.compressed()"
        raise ValueError(msg)
    try:
        given = np.asarray(points)
    except ValueError as error:
        msg = (
            f"points must be an array of shape (n, {dimension}); the rows that came do not have one length "
            f"({error})"
        )
        raise ValueError(msg) from None
    if given.dtype.kind not in "iuf":
        msg = f"points must be real numbers of shape (n, {dimension}), got dtype {given.dtype}"
        raise ValueError(msg)
    if given.ndim != 2 or given.shape[1] != dimension:
        msg = f"points must have shape (n, {dimension}), got {given.shape}"
        raise ValueError(msg)
    if not len(given):
        least = {2: "three", 3: "four"}[dimension]
        msg = f"points are empty; a triangulation needs at least {least} sites"
        raise ValueError(msg)
    if len(given) > MOST_SITES:
        msg = f"at most 2^25 = {MOST_SITES} sites can be numbered, got {len(given)}"
        raise ValueError(msg)
    with np.errstate(over="ignore"):
        # in C order, since every other order is another type to numba and would be compiled again
        array = given.astype(np.float64, order="C")
    if given.dtype.kind in "iu" and (np.abs(array) > 2.0**53).any():
        msg = (
            "points have integers beyond 2^53, which float64 does not hold exactly; subtract an offset first"
        )
        raise ValueError(msg)
    if not np.isfinite(array).all():
        bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
        msg = f"points must be finite: {len(bad)} rows have NaN or infinity, the first is row {bad[0]}"
        raise ValueError(msg)
    return array


def first_copies(sites: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Indices of the distinct sites, and pairs (a later copy, the first one): int (m,) and int32 (k, 2).

    The first of equal sites is the one of least index. The distinct sites come in the lexicographic order of
    their coordinates, the pairs in that of the copies.
    """
    order = np.lexsort(sites.T[::-1])
    ordered = sites[order]
    new = np.ones(len(sites), bool)
    new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    # lexsort is stable, so the first of a run of equal sites has the least index
    first = order[new][np.cumsum(new) - 1]
    copies = np.column_stack([order[~new], first[~new]]).astype(np.int32)
    return order[new], copies[np.argsort(copies[:, 0])]


def affine_dimension(sites: np.ndarray, tolerance: float) -> int:
    """0, 1, 2 or 3: of the affine hull of sites (n, 3) in the unit cube, up to ``tolerance``."""
    offset = sites - sites[0]
    direction = offset[np.argmax((offset**2).sum(axis=1))]
    length = np.linalg.norm(direction)
    if length == 0:
        return 0
    beside = np.cross(offset, direction / length)
    widest = np.argmax((beside**2).sum(axis=1))
    width = np.linalg.norm(beside[widest])
    if width <= tolerance:
        return 1
    return 2 if np.abs(offset @ (beside[widest] / width)).max() <= tolerance else 3


def check_volume(sites: np.ndarray, tolerance: float) -> None:
    """Raise DegenerateInputError unless distinct sites (n, 3) in the unit cube span a volume."""
    dimension = affine_dimension(sites, tolerance)
    if dimension == 3:
        return
    raise no_volume(dimension, len(sites))


def no_volume(dimension: int, n: int) -> DegenerateInputError:
    """The error for n distinct sites whose affine hull has the given dimension, 0, 1 or 2."""
    where = ["coincide", "lie on a line", "lie on a plane"][dimension]
    msg = (
        f"a 3D triangulation needs four sites that do not lie on a plane; the {n} distinct sites "
        f"that came {where} (dimension {dimension})"
    )
    return DegenerateInputError(msg, dimension)


def no_area(dimension: int, n: int) -> DegenerateInputError:
    """The error for n distinct sites in the plane whose affine hull has the given dimension, 0 or 1."""
    msg = (
        f"a 2D triangulation needs three sites that do not lie on a line; the {n} distinct sites "
        f"that came {['coincide', 'lie on a line'][dimension]} (dimension {dimension})"
    )
    return DegenerateInputError(msg, dimension)


def exactly_scaled(sites: np.ndarray) -> np.ndarray:
    """Sites times a power of two, float64 (n, d): the greatest coordinate is about 1, where that is exact.

    Elsewhere, where coordinates are more than 2^1000 apart in magnitude, the sites themselves.
    """
    from .predicates import scaled

    return scaled(sites)
