"""Names composed operations in the ledger of the machine that runs them."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

import jax

from .._records import is_vector

P = ParamSpec("P")
T = TypeVar("T")


def composed(function: Callable[P, T]) -> Callable[P, T]:
    """Enter all steps of ``function`` in the ledger under its name.

    The machine is that of the first vector among the arguments; outermost names count, so a `union` that
    calls `sort` is entered as "union".
    """

    @wraps(function)
    def run(*args: P.args, **kwargs: P.kwargs) -> T:
        for leaf in jax.tree.leaves((args, kwargs)):
            if is_vector(leaf):
                with leaf.machine.operation(function.__name__):
                    return function(*args, **kwargs)
        return function(*args, **kwargs)

    return run
