"""Functions of elements that are called with vectors."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any

import jax

from ._records import is_vector


def elementwise(fn: Callable[..., Any]) -> Callable[..., Any]:
    """A function of one element that takes vectors, records of them and scalars: ``machine.map(fn, ...)``.

    The machine is that of the first vector. ``where=`` and ``otherwise=`` are those of `Machine.map`. Where
    no argument is a vector, as in another such function, it is ``fn`` itself.
    """

    @wraps(fn)
    def mapped(*args: Any, **context: Any) -> Any:
        for leaf in jax.tree.leaves(args, is_leaf=is_vector):
            if is_vector(leaf):
                return leaf.machine.map(fn, *args, **context)
        return fn(*args)

    return mapped
