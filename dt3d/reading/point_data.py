"""What a file says of its points beside their places: gathered by a reader, array by array."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

KINDS = "biufcSUmM"
"""The kinds of NumPy's types that have one value per entry: numbers, truth values, text, bytes and times."""


class PointData:
    """Arrays with an entry for each point, by name, and what was left out.

    A reader that is given one enters what it finds; without one it goes past it.

    Attributes
    ----------
    arrays : dict of str to arrays (n,) or (n, ...)
        In the types of the file, in the machine's order of bytes.
    left_out : dict of str to str
        What the file has beside, and why it is not among the arrays.
    """

    def __init__(self) -> None:
        self.arrays: dict[str, np.ndarray] = {}
        self.left_out: dict[str, str] = {}

    def add(self, name: str, values: np.ndarray, declared: str | None = None) -> None:
        """Enter an array; a name that is taken gets a number behind it.

        Parameters
        ----------
        name : str
            What the file calls it.
        values : (n,) or (n, ...)
            The array; one of shape (n, 1) is entered as (n,).
        declared : str, optional
            The type, such as "f4", that a file says it has, where numbers were read from text.

        Raises
        ------
        ValueError
            If the declared type does not hold a whole number.
        """
        name = self._free(name)
        if declared is not None:
            values = as_declared(values, declared, f"point data {name[:40]!r}")
        if values.dtype.kind not in KINDS or values.dtype.names is not None:
            self.left_out[name] = f"its type is {values.dtype}"
            return
        if values.ndim == 2 and values.shape[1] == 1:
            values = values[:, 0]
        # a copy, since those of readers are parts of the whole file, which they would keep in memory
        self.arrays[name] = np.array(values, values.dtype.newbyteorder("="), order="C")

    def leave_out(self, name: str, why: str) -> None:
        """Say that something of the file is not among the arrays."""
        self.left_out[self._free(name)] = why

    def check(self, what: str, n: int) -> None:
        """A ValueError unless all arrays have n entries; ``what`` is the file, for the message."""
        for name, values in self.arrays.items():
            if values.shape[:1] != (n,):
                msg = f"{what}: point data {name!r} have shape {values.shape}, and there are {n} points"
                raise ValueError(msg)

    def _free(self, name: str) -> str:
        """The name, or with the first number that makes it a new one."""
        # garbled files have control characters in names, which XML has no letters for
        name = "".join(c if c.isprintable() else " " for c in name).strip() or "unnamed"
        taken, free, number = self.arrays.keys() | self.left_out.keys(), name, 2
        while free in taken:
            free, number = f"{name}_{number}", number + 1
        return free


def as_declared(values: np.ndarray, declared: str, what: str) -> np.ndarray:
    """Numbers that were read from text in the type that the file says they have; a ValueError for others."""
    with np.errstate(over="ignore"):
        cast = values.astype(declared)
    if cast.dtype.kind in "iu" and (cast != values).any():
        msg = f"{what} have {values[cast != values][0]}, which is beyond their type {cast.dtype}"
        raise ValueError(msg)
    return cast


def join(whole: PointData | None, parts: Sequence[PointData]) -> None:
    """Enter the arrays of parts of a file, one after the other; what not all parts have is left out."""
    if whole is None or not parts:
        return
    every = dict.fromkeys(name for part in parts for name in part.arrays)
    for name in every:
        found = [part.arrays[name] for part in parts if name in part.arrays]
        if len(found) < len(parts):
            whole.leave_out(name, f"{len(found)} of {len(parts)} pieces have it")
        elif len({(array.shape[1:], array.dtype.kind) for array in found}) > 1:
            whole.leave_out(name, "its type is not the same in all pieces")
        else:
            whole.add(name, np.concatenate(found))
    for part in parts:
        for name, why in part.left_out.items():
            if name not in whole.left_out:
                whole.leave_out(name, why)
