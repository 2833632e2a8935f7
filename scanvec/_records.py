"""Records: pytrees whose leaves are vectors of one length on one machine."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import jax

from ._vector import Vector

if TYPE_CHECKING:
    from ._machine import Machine


def is_vector(x: Any) -> bool:
    return isinstance(x, Vector)


def has_vectors(record: Any) -> bool:
    """Whether any leaf is a vector; a scalar has none."""
    return any(map(is_vector, jax.tree.leaves(record, is_leaf=is_vector)))


def vectors_of(record: Any) -> list[Vector]:
    """The vectors of a record (a pytree whose leaves are vectors), checked to share machine and length."""
    leaves = jax.tree.leaves(record, is_leaf=is_vector)
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


def structure_of(record: Any) -> Any:
    """How a record's vectors hang together, for comparison."""
    return jax.tree.structure(record, is_leaf=is_vector)


def machine_of(record: Any) -> Machine:
    return vectors_of(record)[0].machine


def length_of(record: Any) -> int:
    return len(vectors_of(record)[0])


def blocks_of(record: Any) -> Any:
    """The record with each vector replaced by its array."""
    return jax.tree.map(lambda v: v._block if is_vector(v) else v, record, is_leaf=is_vector)
