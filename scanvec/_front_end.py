"""Between vectors and scalars: the scan model's scalar memory is the Python program, its front end."""

from __future__ import annotations

from typing import Any

import jax

from . import _local
from ._composed import composed
from ._deprecated import old_keywords
from ._records import is_vector, length_of, machine_of, structure_of


@old_keywords
def extract(v: Any, i: int) -> Any:
    """v[i] as a NumPy scalar, a record of them for a record; negative i counts from the end. No step.

    Raises IndexError if i is not an index of v.
    """
    machine = machine_of(v)
    return jax.tree.map(lambda x: machine.item(x, i), v, is_leaf=is_vector)


@old_keywords
@composed
def insert(v: Any, i: int, value: Any) -> Any:
    """r = v, but r[i] = value; negative i counts from the end. One step, n elements.

    Parameters
    ----------
    v
        A vector, or a record of them; it does not change.
    value
        A scalar, or a record of scalars like ``v``; converted to the vectors' dtypes as NumPy does it.

    Raises
    ------
    IndexError
        If i is not an index of v.
    ValueError
        If the structures of ``v`` and ``value`` differ.
    """
    machine, n = machine_of(v), length_of(v)
    if not -n <= i < n:
        msg = f"index {i} is out of range for a vector of {n} elements"
        raise IndexError(msg)
    if structure_of(v) != jax.tree.structure(value):
        msg = f"insert: {jax.tree.structure(value)} cannot go into a record {structure_of(v)}"
        raise ValueError(msg)
    one = jax.tree.map(lambda x, s: machine.full(1, s, x.dtype), v, value, is_leaf=is_vector)
    return machine.send(one, machine.full(1, i % n, "int32"), _local.UNIQUE, into=v)
