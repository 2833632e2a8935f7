"""Functions of elements that are called with vectors."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

import jax

from .._records import is_vector


def elementwise(fn: Callable[..., object]) -> Callable[..., Any]:
    """A function of one element that takes vectors, records of them and scalars: ``machine.map(fn, ...)``.

    The machine is that of the first vector. ``where=`` and ``otherwise=`` are those of `Machine.map`. Where
    no argument is a vector, as in another such function, it is ``fn`` itself.

    >>> import scanvec as sv
    >>> @sv.elementwise
    ... def square(x):
    ...     return x * x
    >>> square(sv.Device().vector([1, 2, 3]))
    Vector([1 4 9], dtype=int64, Device())
    """

    @wraps(fn)
    def mapped(*args: object, **context: object) -> object:
        for leaf in jax.tree.leaves(args):
            if is_vector(leaf):
                return leaf.machine.map(fn, *args, **context)
        return fn(*args)

    return mapped
