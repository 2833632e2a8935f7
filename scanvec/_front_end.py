"""Between vectors and scalars: the scan model's scalar memory is the Python program, its front end."""

from __future__ import annotations

from typing import Any

import jax

from . import _local
from ._composed import composed
from ._records import is_vector, length_of, machine_of, structure_of


def extract(record: Any, i: int) -> Any:
    """v[i] as a NumPy scalar, a record of them for a record; negative i counts from the end. No step.

    Raises IndexError if i is not an index of v.
    """
    machine = machine_of(record)
    return jax.tree.map(lambda v: machine.item(v, i), record, is_leaf=is_vector)


@composed
def insert(record: Any, i: int, value: Any) -> Any:
    """r = v, but r[i] = value; negative i counts from the end. One step, n elements.

    Parameters
    ----------
    record
        A vector, or a record of them; it does not change.
    value
        A scalar, or a record of scalars like ``record``; converted to the vectors' dtypes as NumPy does it.

    Raises
    ------
    IndexError
        If i is not an index of v.
    ValueError
        If the structures of ``record`` and ``value`` differ.
    """
    machine, n = machine_of(record), length_of(record)
    if not -n <= i < n:
        msg = f"index {i} is out of range for a vector of {n} elements"
        raise IndexError(msg)
    if structure_of(record) != jax.tree.structure(value):
        msg = f"insert: {jax.tree.structure(value)} cannot go into a record {structure_of(record)}"
        raise ValueError(msg)
    one = jax.tree.map(lambda v, x: machine.full(1, x, v.dtype), record, value, is_leaf=is_vector)
    return machine.send(one, machine.full(1, i % n, "int32"), _local.UNIQUE, record)
