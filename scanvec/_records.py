"""Records: pytrees whose leaves are vectors of one length on one machine."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar, cast

import jax

from ._vector import Vector

if TYPE_CHECKING:
    from ._machine.base import Machine

# a record: a vector, or a pytree of them; inside a machine the same pytree of arrays
R = TypeVar("R")

# what a function of elements is called with: records, and scalars
Args = tuple[object, ...]


def is_vector(x: object) -> bool:
    """Whether x is a vector, the leaf of records."""
    return isinstance(x, Vector)


def each(fn: Callable[..., object], record: R, *others: object) -> R:
    """The record of ``fn(leaf, other leaf, ...)``."""
    return cast(R, jax.tree.map(fn, record, *others))


def has_vectors(record: object) -> bool:
    """Whether any leaf is a vector; a scalar has none."""
    return any(map(is_vector, jax.tree.leaves(record)))


def vectors_of(record: object) -> list[Vector]:
    """The vectors of a record (a pytree whose leaves are vectors), checked to share machine and length."""
    leaves = jax.tree.leaves(record)
    if not leaves or not all(map(is_vector, leaves)):
        kinds = ", ".join(sorted({type(x).__name__ for x in leaves})) or "nothing"
        msg = f"expected a Vector or a record (pytree) of Vectors, got {kinds}; use machine.vector(array)"
        raise TypeError(msg)
    check_alike(leaves)
    return leaves


def check_alike(vectors: list[Vector]) -> None:
    """Raise ValueError unless all vectors live on one machine and have one length."""
    first = vectors[0]
    for v in vectors[1:]:
        if v.machine is not first.machine:
            msg = (
                f"vectors live on different machines: {first.machine!r} and {v.machine!r}; "
                f"move one through to_numpy"
            )
            raise ValueError(msg)
        if len(v) != len(first):
            msg = f"vectors have different lengths: {len(first)} and {len(v)}"
            raise ValueError(msg)


def check_one_kind(what: str, v: object, w: object) -> None:
    """Raise ValueError unless the two records have one structure and the same dtypes."""
    if structure_of(v) != structure_of(w):
        msg = f"{what}: the two records have different structures"
        raise ValueError(msg)
    if [x.dtype for x in vectors_of(v)] != [x.dtype for x in vectors_of(w)]:
        msg = f"{what}: the two records have different dtypes; convert with astype"
        raise ValueError(msg)


def structure_of(record: object) -> jax.tree_util.PyTreeDef:
    """How a record's vectors hang together, for comparison."""
    return jax.tree.structure(record)


def machine_of(record: object) -> Machine:
    """The machine of a record's vectors."""
    return vectors_of(record)[0].machine


def length_of(record: object) -> int:
    """The number of elements of each of a record's vectors."""
    return len(vectors_of(record)[0])


def blocks_of(record: object) -> Any:
    """The record with each vector replaced by its array."""
    return jax.tree.map(lambda v: v._block if is_vector(v) else v, record)
