"""How many elementary operations an elementwise function is: what a vector machine would issue one by one.

A Connection Machine has no instruction "signed distance": its compiler issues the additions, products and
comparisons of an expression, each of which runs over all virtual processors. They are counted in the
function's JAX trace.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import jax
import numpy as np
from jax.extend.core import Jaxpr

from .._vector import Scalar

# What moves or renames values without computing any.
FREE = frozenset(
    ("broadcast_in_dim", "reshape", "squeeze", "convert_element_type", "copy", "stop_gradient", "concatenate",
     "slice", "expand_dims", "transpose", "bitcast_convert_type", "iota")
)  # fmt: skip


def count_operations(fn: Callable[..., object], args: object, context: bool) -> int:
    """Elementary operations of ``fn`` on one element, at least 1; a select for each result under a context.

    ``args`` are blocks and scalars, as a machine's map gets them. Loops of a known length count as often as
    they run, others once; of branches the longest counts.
    """
    leaves, structure = jax.tree.flatten(args)
    dtypes = tuple(_dtype(x) for x in leaves)
    operations, results = _traced(fn, structure, dtypes)
    return max(1, operations + (results if context else 0))


def _dtype(x: jax.Array | Scalar) -> np.dtype[np.generic] | type:
    # Python scalars stay themselves, so that they do not widen what they meet
    return type(x) if isinstance(x, bool | int | float) else np.dtype(x.dtype)


@cache
def _traced(
    fn: Callable[..., object],
    structure: jax.tree_util.PyTreeDef,
    dtypes: tuple[np.dtype[np.generic] | type, ...],
) -> tuple[int, int]:
    elements = [d(0) if isinstance(d, type) else np.zeros((), d) for d in dtypes]
    with jax.enable_x64(True):
        traced = jax.make_jaxpr(fn)(*jax.tree.unflatten(structure, elements))
    return _count(traced.jaxpr), len(traced.jaxpr.outvars)


def _count(jaxpr: Jaxpr) -> int:
    total = 0
    for equation in jaxpr.eqns:
        inner = [_count(j) for j in map(_jaxpr_of, jax.tree.leaves(list(equation.params.values()))) if j]
        if inner and equation.primitive.name == "cond":
            total += max(inner)
        elif inner:
            total += equation.params.get("length", 1) * sum(inner)
        elif equation.primitive.name not in FREE:
            shapes = [getattr(v.aval, "shape") for v in equation.outvars]  # noqa: B009
            total += max(map(math.prod, shapes), default=1)
    return total


def _jaxpr_of(parameter: object) -> Jaxpr | None:
    inner = getattr(parameter, "jaxpr", parameter)
    return inner if isinstance(inner, Jaxpr) else None
