"""Monoids: the operators of scans, reductions and concurrent writes.

A monoid is a value, not a string: an associative function, its identity and a name. The seven of the
scan model are here (Blelloch 1990, chapter 3); a reader's own are as good, on records too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from ._records import R, each


@dataclass(frozen=True)
class Monoid:
    """An associative operator with an identity.

    >>> import jax.numpy as jnp, scanvec as sv
    >>> FARTHEST = sv.Monoid("farthest", lambda a, b: jnp.where(abs(b) > abs(a), b, a), lambda dtype: 0)
    >>> print(sv.reduce(sv.Device().vector([3, -7, 5]), FARTHEST))
    -7

    Attributes
    ----------
    name
        What the ledger and the errors call it.
    fn
        ``fn(a, b)``: traceable by JAX, associative, elementwise on arrays of any shape. ``a`` and ``b`` are
        what one element of the scanned record is: an array, or a pytree of arrays.
    identity
        ``identity(dtypes)``: the element with ``fn(identity, a) == fn(a, identity) == a``, given the dtype
        of each leaf.
    kinds
        NumPy dtype kinds that it takes ("b" bool, "i" int, "u" unsigned, "f" float).
    """

    name: str
    fn: Callable[[Any, Any], Any]
    identity: Callable[[Any], Any]
    kinds: str = "biuf"

    def check(self, dtype: np.dtype[np.generic], primitive: str) -> None:
        """Raise TypeError where this operator has no meaning for ``dtype``.

        >>> ADD.check(np.dtype("int32"), "scan")
        """
        if dtype.kind not in self.kinds:
            msg = (
                f"{primitive}: the operator {self.name} is not defined for {dtype} elements; "
                f"convert the vector first, for example with v.astype('int32')"
            )
            raise TypeError(msg)

    def __repr__(self) -> str:
        return f"scanvec.{self.name.upper()}"


def lowest(dtype: npt.DTypeLike) -> float:
    """The least value of a dtype: -inf, the least integer, or False."""
    dtype = np.dtype(dtype)
    if dtype.kind == "f":
        return -np.inf
    return False if dtype.kind == "b" else int(np.iinfo(dtype).min)


def highest(dtype: npt.DTypeLike) -> float:
    """The greatest value of a dtype: inf, the greatest integer, or True."""
    dtype = np.dtype(dtype)
    if dtype.kind == "f":
        return np.inf
    return True if dtype.kind == "b" else int(np.iinfo(dtype).max)


def _all_ones(dtype: npt.DTypeLike) -> int:
    dtype = np.dtype(dtype)
    if dtype.kind == "b":
        return True
    return -1 if dtype.kind == "i" else int(np.iinfo(dtype).max)


def _left(a: jax.Array, b: jax.Array) -> jax.Array:
    return a


def _right(a: jax.Array, b: jax.Array) -> jax.Array:
    return b


def _argmin(a: tuple[jax.Array, R], b: tuple[jax.Array, R]) -> tuple[jax.Array, R]:
    # Strict, so that of equal keys the one further left is kept. NaN is less than any number, as it is to
    # minimum: were it neither less nor greater, the operator would not be associative.
    a_is_nan, b_is_nan = a[0] != a[0], b[0] != b[0]
    take_b = (b[0] < a[0]) | (b_is_nan & ~a_is_nan)
    return each(lambda u, v: jnp.where(take_b, v, u), a, b)


def _of_leaves(
    name: str, fn: Callable[..., object], identity: Callable[..., object], kinds: str = "biuf"
) -> Monoid:
    """The operator that combines a record leaf by leaf."""
    return Monoid(
        name, lambda a, b: jax.tree.map(fn, a, b), lambda dtypes: jax.tree.map(identity, dtypes), kinds
    )


ADD = _of_leaves("add", jnp.add, lambda dtype: 0, "iuf")
MUL = _of_leaves("mul", jnp.multiply, lambda dtype: 1, "iuf")
# XLA takes subnormal floats for zero on CPUs, in these two as in all arithmetic; sorts and copies do not.
MIN = _of_leaves("min", jnp.minimum, highest)
MAX = _of_leaves("max", jnp.maximum, lowest)
AND = _of_leaves("and", jnp.bitwise_and, _all_ones, "biu")
OR = _of_leaves("or", jnp.bitwise_or, lambda dtype: 0, "biu")

# The copy of a segment's first element; what an exclusive scan leaves at a head is zero.
COPY = _of_leaves("copy", _left, lambda dtype: 0)

# On records (key, payload): the pair of least key, of equal keys the leftmost.
ARGMIN = Monoid("argmin", _argmin, lambda dtypes: (highest(dtypes[0]), jax.tree.map(lambda _: 0, dtypes[1])))

# Their identities hold on the right only: COPY(0, a) is 0, and ARGMIN((inf, 0), (inf, 7)) loses the 7. So
# machines start their scans with a head flag at the first element, and nothing is combined from its left.
ONE_SIDED = (COPY, ARGMIN)

# For exclusive writes: no two elements may go to one place, which is checked, so nothing is combined.
UNIQUE = Monoid("unique", _right, lambda dtype: 0)
