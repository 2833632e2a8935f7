"""Vectors: n elements of one dtype that live on a machine."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from ._machine.base import Machine

Scalar = bool | int | float | np.generic


class Vector:
    """n elements on a machine, in the order of their indices.

    Make one with ``machine.vector(array)``. Vectors do not change: every operation gives a new one.
    Arithmetic, comparison and bitwise operators act elementwise, between vectors of one length on one
    machine, or with a Python scalar; ``to_numpy`` (or ``numpy.asarray``) brings the elements back. A quotient
    of two vectors is rounded once; for that by a scalar XLA multiplies by its reciprocal, which rounds twice.

    Attributes
    ----------
    machine : Machine
        Where the elements live.
    dtype : numpy.dtype
        bool, int8 ... int64, uint8 ... uint64, float16, float32 or float64.

    Examples
    --------
    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3])
    >>> v * 2 + 1
    Vector([11  3  7], dtype=int64, Device())
    """

    __slots__ = ("_block", "_n", "machine")
    __hash__ = None  # type: ignore[assignment]  # == is elementwise
    __array_priority__ = 100  # numpy scalars leave the operators below to this class

    def __init__(self, machine: Machine, block: jax.Array, n: int) -> None:
        self.machine = machine
        self._block = block
        self._n = n

    @property
    def dtype(self) -> np.dtype[np.generic]:
        """What each element is: bool, an integer or a float.

        Examples
        --------
        >>> import scanvec as sv
        >>> sv.Device().vector([5, 1, 3], "int16").dtype
        dtype('int16')
        """
        return np.dtype(self._block.dtype)

    @property
    def shape(self) -> tuple[int]:
        """(n,), as NumPy has it.

        Examples
        --------
        >>> import scanvec as sv
        >>> sv.Device().vector([5, 1, 3]).shape
        (3,)
        """
        return (self._n,)

    def __len__(self) -> int:
        return self._n

    def __bool__(self) -> bool:
        msg = "the truth of a Vector is ambiguous; use scanvec.reduce(v, scanvec.OR) or scanvec.AND"
        raise ValueError(msg)

    def to_numpy(self) -> npt.NDArray[np.generic]:
        """The elements as a NumPy array of shape (n,) and the same dtype.

        >>> import scanvec as sv
        >>> sv.Device().vector([4, 5, 6]).to_numpy().tolist()
        [4, 5, 6]
        """
        return self.machine.to_numpy(self)

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.generic]:
        out = self.to_numpy()
        return out if dtype is None else out.astype(dtype)

    def __repr__(self) -> str:
        elements = np.array2string(self.to_numpy(), threshold=12)
        return f"Vector({elements}, dtype={self.dtype}, {self.machine!r})"

    def astype(self, dtype: npt.DTypeLike) -> Vector:
        """r[i] = v[i] converted as NumPy does it. One elementwise step.

        >>> import scanvec as sv
        >>> sv.Device().vector([0.5, 2.5]).astype("int8")
        Vector([0 2], dtype=int8, Device())
        """
        return self._map(_cast(np.dtype(dtype)), self)

    def _map(self, fn: Callable[..., object], *args: object) -> Vector:
        out: Vector = self.machine.map(fn, *args)
        return out

    # Operators: each is one elementwise step. They are written out, so that type checkers see them.

    def __neg__(self) -> Vector:
        return self._map(jnp.negative, self)

    def __invert__(self) -> Vector:
        return self._map(jnp.invert, self)

    def __abs__(self) -> Vector:
        return self._map(jnp.abs, self)

    def __eq__(self, other: object) -> Vector:  # type: ignore[override]
        return self._map(jnp.equal, self, other)

    def __ne__(self, other: object) -> Vector:  # type: ignore[override]
        return self._map(jnp.not_equal, self, other)

    def __lt__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.less, self, other)

    def __le__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.less_equal, self, other)

    def __gt__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.greater, self, other)

    def __ge__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.greater_equal, self, other)

    def __add__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.add, self, other)

    def __sub__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.subtract, self, other)

    def __mul__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.multiply, self, other)

    def __truediv__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.true_divide, self, other)

    def __floordiv__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.floor_divide, self, other)

    def __mod__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.remainder, self, other)

    def __pow__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.power, self, other)

    def __and__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.bitwise_and, self, other)

    def __or__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.bitwise_or, self, other)

    def __xor__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.bitwise_xor, self, other)

    def __lshift__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.left_shift, self, other)

    def __rshift__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.right_shift, self, other)

    def __radd__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.add, other, self)

    def __rsub__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.subtract, other, self)

    def __rmul__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.multiply, other, self)

    def __rtruediv__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.true_divide, other, self)

    def __rfloordiv__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.floor_divide, other, self)

    def __rmod__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.remainder, other, self)

    def __rpow__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.power, other, self)

    def __rand__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.bitwise_and, other, self)

    def __ror__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.bitwise_or, other, self)

    def __rxor__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.bitwise_xor, other, self)

    def __rlshift__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.left_shift, other, self)

    def __rrshift__(self, other: Vector | Scalar) -> Vector:
        return self._map(jnp.right_shift, other, self)


_CASTS: dict[np.dtype[np.generic], Callable[[jax.Array], jax.Array]] = {}


def _cast(dtype: np.dtype[np.generic]) -> Callable[[jax.Array], jax.Array]:
    # one function object per dtype, so that its compiled kernel is found again
    return _CASTS.setdefault(dtype, lambda x: x.astype(dtype))
