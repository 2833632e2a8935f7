"""Numbers of a file as float64 without a loss, and coordinates that it keeps apart."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .._exact_conversion import to_float64


def as_float64(array: np.ndarray, what: str) -> np.ndarray:
    """The numbers of a file as float64; the message for one that float64 does not hold is made for files.

    Parameters
    ----------
    array : ndarray
        Numbers.
    what : str
        The path, and the array's name if it has one.

    Raises
    ------
    ValueError
        As `to_float64` says.
    """
    try:
        return to_float64(array, what)
    except ValueError as error:
        if array.dtype.kind not in "iuf":
            msg = f"{what}: expected real numbers, found {array.dtype}"
            raise ValueError(msg) from error
        # the words after the semicolon are for callers that have the array
        msg = f"{str(error).partition(';')[0]}; subtract an offset or round before the file is written"
        raise ValueError(msg) from error


def stack_columns(path: Path, columns: Sequence[tuple[str, np.ndarray]]) -> np.ndarray:
    """Named columns as float64 (n, number of columns).

    Each is converted by itself: NumPy would first bring integers and floats to a common type, which rounds.

    Raises
    ------
    ValueError
        If they are not real numbers, of one length and one-dimensional, or float64 does not hold one exactly.
    """
    for name, column in columns:
        if column.ndim != 1 or column.dtype.kind not in "iuf":
            found = f"{column.dtype} of shape {column.shape}"
            msg = f"{path}: {name} should be a row of real numbers, found {found}"
            raise ValueError(msg)
    if len({len(column) for _, column in columns}) > 1:
        lengths = ", ".join(f"{name} has {len(column)}" for name, column in columns)
        msg = f"{path}: the coordinates differ in number: {lengths}"
        raise ValueError(msg)
    return np.stack([as_float64(column, f"{path}: {name}") for name, column in columns], axis=1)
