"""What is checked before a step runs, and what the errors say."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import jax
import numpy as np

from . import _local
from ._records import is_vector
from ._vector import Vector

if TYPE_CHECKING:
    from ._machine import Machine

LARGEST_VECTOR = 2**31 - 1  # indices are int32


def vectors_and_scalars(args: Any) -> list[Vector]:
    """The vectors among the leaves, all others of which must be scalars."""
    leaves = jax.tree.leaves(args, is_leaf=is_vector)
    for x in leaves:
        if not is_vector(x) and np.ndim(x):
            msg = f"map takes Vectors and scalars, got an array of shape {np.shape(x)}; use machine.vector"
            raise TypeError(msg)
    return [x for x in leaves if is_vector(x)]


def check_dtype(dtype: np.dtype) -> None:
    if dtype.kind not in "biuf" or dtype.itemsize > 8:
        msg = f"a vector takes bool, int, uint or float elements of at most 64 bits, got {dtype}"
        raise TypeError(msg)


def check_size(n: int) -> None:
    if not 0 <= n <= LARGEST_VECTOR:
        msg = f"a vector takes 0 .. 2^31 - 1 elements, got {n}"
        raise ValueError(msg)


def check_flags(v: Any, what: str) -> None:
    if not is_vector(v) or v.dtype != bool:
        got = v.dtype if is_vector(v) else type(v).__name__
        msg = f"{what} must be a Vector of bool, got {got}"
        raise TypeError(msg)


def check_index(index: Any, machine: Machine, what: str) -> Vector:
    if not is_vector(index) or index.dtype.kind not in "iu":
        got = index.dtype if is_vector(index) else type(index).__name__
        msg = f"{what}: the index must be a Vector of integers, got {got}"
        raise TypeError(msg)
    if index.machine is not machine:
        msg = f"{what}: the index lives on {index.machine!r}, the vector on {machine!r}"
        raise ValueError(msg)
    return index


def out_of_range(what: str, least: int, greatest: int, n: int) -> None:
    indices = f"0 .. {n - 1}" if n else "no index"
    msg = f"{what}: indices from {least} to {greatest}, but the vector has {n} elements ({indices})"
    raise IndexError(msg)


def check_distinct(what: str, index: Vector, where: Vector | None, place: jax.Array, into: jax.Array) -> None:
    hits = int(_local.most_hits(into, place))
    if hits > 1:
        targets = index.to_numpy() if where is None else index.to_numpy()[where.to_numpy()]
        values, counts = np.unique(targets, return_counts=True)
        msg = (
            f"{what}: {hits} elements are sent to position {values[counts.argmax()]}; an exclusive write "
            f"takes distinct indices. For a concurrent write use scanvec.send with a combining operator"
        )
        raise ValueError(msg)
