"""Vectors: n elements of one dtype that live on a machine."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any

import jax
import jax.numpy as jnp
import numpy as np

if TYPE_CHECKING:
    from ._machine import Machine


class Vector:
    """n elements on a machine, in the order of their indices.

    Make one with ``machine.vector(array)``. Vectors do not change: every operation gives a new one.
    Arithmetic, comparison and bitwise operators act elementwise, between vectors of one length on one
    machine, or with a Python scalar; ``to_numpy`` (or ``numpy.asarray``) brings the elements back.

    Attributes
    ----------
    machine : Machine
        Where the elements live.
    dtype : numpy.dtype
        bool, int8 ... int64, uint8 ... uint64, float16, float32 or float64.
    """

    __slots__ = ("_block", "_n", "machine")
    __hash__ = None  # type: ignore[assignment]  # == is elementwise
    __array_priority__ = 100  # numpy scalars leave the operators below to this class

    def __init__(self, machine: Machine, block: jax.Array, n: int) -> None:
        self.machine = machine
        self._block = block
        self._n = n

    @property
    def dtype(self) -> np.dtype:
        return np.dtype(self._block.dtype)

    @property
    def shape(self) -> tuple[int]:
        return (self._n,)

    def __len__(self) -> int:
        return self._n

    def __bool__(self) -> bool:
        msg = "the truth of a Vector is ambiguous; use scanvec.reduce(v, scanvec.OR) or scanvec.AND"
        raise ValueError(msg)

    def to_numpy(self) -> np.ndarray:
        """The elements as a NumPy array of shape (n,) and the same dtype."""
        return self.machine.to_numpy(self)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        out = self.to_numpy()
        return out if dtype is None else out.astype(dtype)

    def __repr__(self) -> str:
        return f"Vector({np.array2string(self.to_numpy(), threshold=12)}, dtype={self.dtype}, {self.machine!r})"

    def astype(self, dtype: Any) -> Vector:
        """r[i] = v[i] converted as NumPy does it. One elementwise step."""
        return self.machine.map(_cast(np.dtype(dtype)), self)

    # elementwise operators, each one step over n elements
    def __neg__(self) -> Vector:
        return self.machine.map(jnp.negative, self)

    def __invert__(self) -> Vector:
        return self.machine.map(jnp.invert, self)

    def __abs__(self) -> Vector:
        return self.machine.map(jnp.abs, self)


_CASTS: dict[np.dtype, Any] = {}


def _cast(dtype: np.dtype) -> Any:
    # one function object a dtype, so that its compiled kernel is found again
    return _CASTS.setdefault(dtype, lambda x: x.astype(dtype))


def _add_operators() -> None:
    functions = {
        "add": jnp.add, "sub": jnp.subtract, "mul": jnp.multiply, "truediv": jnp.true_divide,
        "floordiv": jnp.floor_divide, "mod": jnp.remainder, "pow": jnp.power, "and": jnp.bitwise_and,
        "or": jnp.bitwise_or, "xor": jnp.bitwise_xor, "lshift": jnp.left_shift, "rshift": jnp.right_shift,
    }  # fmt: skip
    for name, fn in functions.items():
        setattr(Vector, f"__{name}__", lambda self, other, fn=fn: self.machine.map(fn, self, other))
        setattr(Vector, f"__r{name}__", lambda self, other, fn=fn: self.machine.map(fn, other, self))
    comparisons = {
        operator.eq: jnp.equal, operator.ne: jnp.not_equal, operator.lt: jnp.less,
        operator.le: jnp.less_equal, operator.gt: jnp.greater, operator.ge: jnp.greater_equal,
    }  # fmt: skip
    for op, fn in comparisons.items():
        setattr(
            Vector, f"__{op.__name__}__", lambda self, other, fn=fn: self.machine.map(fn, self, other)
        )


_add_operators()
