"""What is checked before a step runs, and what the errors say."""

from __future__ import annotations

from typing import TYPE_CHECKING, NoReturn

import jax
import numpy as np

from ._records import is_vector
from ._vector import Vector

if TYPE_CHECKING:
    from ._machine.base import Machine

LARGEST_VECTOR = 2**31 - 1  # indices are int32


def vectors_and_scalars(args: object) -> list[Vector]:
    """The vectors among the leaves, all others of which must be scalars."""
    leaves = jax.tree.leaves(args)
    for x in leaves:
        if not is_vector(x) and np.ndim(x):
            msg = f"map takes Vectors and scalars, got an array of shape {np.shape(x)}; use machine.vector"
            raise TypeError(msg)
    return [x for x in leaves if is_vector(x)]


def check_dtype(dtype: np.dtype[np.generic]) -> None:
    """Raise TypeError for elements that no vector has."""
    if dtype.kind not in "biuf" or dtype.itemsize > 8:
        msg = f"a vector takes bool, int, uint or float elements of at most 64 bits, got {dtype}"
        raise TypeError(msg)


def check_size(n: int) -> None:
    """Raise ValueError for a length that no vector has."""
    if not 0 <= n <= LARGEST_VECTOR:
        msg = f"a vector takes 0 .. 2^31 - 1 elements, got {n}"
        raise ValueError(msg)


def check_flags(v: object, what: str) -> None:
    """Raise TypeError unless v is a vector of booleans."""
    if not isinstance(v, Vector) or v.dtype != bool:
        got = v.dtype if isinstance(v, Vector) else type(v).__name__
        msg = f"{what} must be a Vector of bool, got {got}"
        raise TypeError(msg)


def check_index(index: object, machine: Machine, what: str) -> Vector:
    """The index, if it is a vector of integers on the machine; an error otherwise."""
    if not isinstance(index, Vector) or index.dtype.kind not in "iu":
        got = index.dtype if isinstance(index, Vector) else type(index).__name__
        msg = f"{what}: the index must be a Vector of integers, got {got}"
        raise TypeError(msg)
    if index.machine is not machine:
        msg = f"{what}: the index lives on {index.machine!r}, the vector on {machine!r}"
        raise ValueError(msg)
    return index


def out_of_range(what: str, least: int, greatest: int, n: int) -> NoReturn:
    """Raise IndexError: the indices run from least to greatest, and there are n elements."""
    indices = f"0 .. {n - 1}" if n else "no index"
    msg = f"{what}: indices from {least} to {greatest}, but the vector has {n} elements ({indices})"
    raise IndexError(msg)


def not_distinct(what: str, index: Vector, where: Vector | None, hits: int) -> NoReturn:
    """Raise ValueError: ``hits`` elements go to one position of an exclusive write."""
    targets = index.to_numpy() if where is None else index.to_numpy()[where.to_numpy()]
    values, counts = np.unique(targets, return_counts=True)
    msg = (
        f"{what}: {hits} elements are sent to position {values[counts.argmax()]}; an exclusive write "
        f"takes distinct indices. For a concurrent write use scanvec.send with a combining operator"
    )
    raise ValueError(msg)
