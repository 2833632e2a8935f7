"""Points that a file does not list: those of a lattice along its axes."""

from __future__ import annotations

from collections.abc import Sequence
from math import prod
from pathlib import Path

import numpy as np

from .._memory import available_memory, gigabytes


def lattice(path: Path, axes: Sequence[np.ndarray]) -> np.ndarray:
    """All combinations of the coordinates on three axes, float64 (n, 3), in VTK's order: x changes fastest.

    Raises
    ------
    ValueError
        If memory would not hold them: a few words of a file can ask for any number.
    """
    check_room(path, prod(len(axis) for axis in axes), "points of the lattice")
    z, y, x = np.meshgrid(*axes[::-1], indexing="ij")
    return np.stack([x, y, z], axis=-1).reshape(-1, 3).astype(np.float64)


def image(
    path: Path, extent: Sequence[int], origin: Sequence[float], spacing: Sequence[float], turn: np.ndarray
) -> np.ndarray:
    """The points of an image: origin + turn @ (spacing * index), for the indices of the extent.

    Parameters
    ----------
    path : Path
        What messages call the file.
    extent : six int
        The first and last index on each axis.
    origin, spacing : three float
        Where index 0 is, and how far apart the points are.
    turn : float64 (3, 3)
        Columns are the directions of the axes.
    """
    check_room(path, prod(max(0, extent[k + 1] - extent[k] + 1) for k in (0, 2, 4)), "points of the image")
    steps = [np.arange(extent[2 * k], extent[2 * k + 1] + 1) for k in range(3)]
    if (turn == np.eye(3)).all():
        return lattice(path, [origin[k] + spacing[k] * steps[k] for k in range(3)])
    offsets = lattice(path, [spacing[k] * steps[k] for k in range(3)])
    points: np.ndarray = np.asarray(origin) + offsets @ turn.T
    return points


def check_room(path: Path, n: int, what: str) -> None:
    """Raise a ValueError unless memory holds n points three times, as long as they are put together."""
    need, room = 3 * 24 * n, available_memory()
    if need > room:
        msg = f"{path}: the {n} {what} need {gigabytes(need)} of memory; {gigabytes(room)} are available"
        raise ValueError(msg)
