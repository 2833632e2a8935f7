"""A machine that is one XLA device: whole vectors under jit, no ledger."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt
from jax.typing import ArrayLike

from .._checks import check_size
from .._monoid import Monoid
from .._records import Args, R
from .._running import computing
from .._vector import Scalar, Vector
from . import processor
from .base import Machine
from .blocks import SMALLEST_BLOCK, round_up
from .combining import put


class Device(Machine):
    """Whole vectors on JAX's default device (a CPU or a GPU).

    The same programs as on `Simulated`, with equal results, and without the bookkeeping.

    >>> import scanvec as sv
    >>> sv.Device().vector([4, 5, 6]) * 2
    Vector([ 8 10 12], dtype=int64, Device())
    """

    def __repr__(self) -> str:
        return "Device()"

    def _shape(self, n: int) -> tuple[int]:
        return (round_up(n, SMALLEST_BLOCK),)

    def _load(self, array: npt.NDArray[np.generic]) -> jax.Array:
        block = np.zeros(self._shape(len(array)), array.dtype)
        block[: len(array)] = array
        out: jax.Array = jax.device_put(block)
        return out

    def to_numpy(self, v: Vector) -> npt.NDArray[np.generic]:  # noqa: D102
        with computing():
            return np.asarray(v._block)[: len(v)].copy()

    def iota(self, n: int) -> Vector:  # noqa: D102
        check_size(n)
        with computing():
            return Vector(self, _iota(*self._shape(n)), n)

    def _item(self, block: jax.Array, n: int, i: int) -> jax.Array:
        out: jax.Array = _item(block, np.int32(i))
        return out

    def _map(self, fn: Callable[..., R], args: Args, where: jax.Array | None, otherwise: object, n: int) -> R:
        out: R = _map(fn, args, where, otherwise)
        return out

    def _scan(
        self, op: Monoid, exclusive: bool, backward: bool, record: R, heads: jax.Array | None, n: int
    ) -> R:
        out: R = _scan(op, exclusive, backward, True, record, heads, np.int32(n), np.int32(n))
        return out

    def _find(
        self, what: str, index: jax.Array, where: jax.Array | None, n: int, m: int
    ) -> tuple[jax.Array, jax.Array, None]:
        place, facts = _find(index, where, np.int32(n))
        return place, facts, None

    def _get(self, block: jax.Array, place: jax.Array, otherwise: Scalar) -> jax.Array:
        out: jax.Array = _get(block, place, otherwise, True)
        return out

    def _send(self, op: Monoid, into: jax.Array, place: jax.Array, values: jax.Array) -> jax.Array:
        out: jax.Array = put(op, into, place, values)
        return out


# a device is one processor

_map = partial(jax.jit, static_argnums=0)(processor.map_row)
_scan = partial(jax.jit, static_argnums=(0, 1, 2, 3))(processor.scan)
_get = partial(jax.jit, static_argnums=3)(processor.get)


@partial(jax.jit, static_argnums=0)
def _iota(size: int) -> jax.Array:
    return jnp.arange(size, dtype=jnp.int32)


@jax.jit
def _item(block: jax.Array, i: ArrayLike) -> jax.Array:
    return block[i]


@jax.jit
def _find(index: jax.Array, where: jax.Array | None, n: ArrayLike) -> tuple[jax.Array, jax.Array]:
    active = processor.in_use(index.size, n, n, True)
    if where is not None:
        active &= where
    facts = jnp.stack(processor.span(index, active, True))
    return jnp.where(active, index.astype(jnp.int32), processor.NOWHERE), facts
