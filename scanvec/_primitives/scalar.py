"""Between vectors and scalars: the scan model's scalar memory is the Python program, its front end."""

from __future__ import annotations

from typing import Any

import jax
import numpy.typing as npt

from .._deprecated import old_keywords
from .._monoid import UNIQUE
from .._records import R, each, length_of, machine_of, structure_of
from .._vector import Scalar
from .composed import composed


def full_like(v: R, value: Scalar, dtype: npt.DTypeLike | None = None) -> R:
    """r[i] = ``value``, as many elements as v has, on its machine. No step.

    A record gives a record like it. The elements have the dtypes of v, or ``dtype``.

    >>> import scanvec as sv
    >>> sv.full_like(sv.Device().vector([5, 1, 3]), 7)
    Vector([7 7 7], dtype=int64, Device())
    """
    return each(lambda x: x.machine.full(len(x), value, x.dtype if dtype is None else dtype), v)


@old_keywords
def extract(v: object, i: int) -> Any:
    """v[i] as a NumPy scalar, a record of them for a record; negative i counts from the end. No step.

    Raises IndexError if i is not an index of v.

    >>> import scanvec as sv
    >>> int(sv.extract(sv.Device().vector([5, 1, 3]), -1))
    3
    """
    machine = machine_of(v)
    return jax.tree.map(lambda x: machine.item(x, i), v)


@old_keywords
@composed
def insert(v: R, i: int, value: object) -> R:
    """r = v, but r[i] = value; negative i counts from the end. One step, n elements.

    Parameters
    ----------
    v
        A vector, or a record of them; it does not change.
    i
        Where the value goes.
    value
        A scalar, or a record of scalars like ``v``; converted to the vectors' dtypes as NumPy does it.

    Raises
    ------
    IndexError
        If i is not an index of v.
    ValueError
        If the structures of ``v`` and ``value`` differ.

    Examples
    --------
    >>> import scanvec as sv
    >>> sv.insert(sv.Device().vector([5, 1, 3]), -1, 7)
    Vector([5 1 7], dtype=int64, Device())
    """
    machine, n = machine_of(v), length_of(v)
    if not -n <= i < n:
        msg = f"index {i} is out of range for a vector of {n} elements"
        raise IndexError(msg)
    if structure_of(v) != jax.tree.structure(value):
        msg = f"insert: {jax.tree.structure(value)} cannot go into a record {structure_of(v)}"
        raise ValueError(msg)
    one = each(lambda x, s: machine.full(1, s, x.dtype), v, value)
    return machine.send(one, machine.full(1, i % n, "int32"), UNIQUE, into=v)
