"""A machine that is one XLA device: whole vectors under jit, no ledger."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from . import _local
from ._checks import check_size
from ._machine import SMALLEST_BLOCK, Machine, round_up
from ._monoid import ONE_SIDED, Monoid
from ._running import computing
from ._vector import Vector


class Device(Machine):
    """Whole vectors on JAX's default device (a CPU or a GPU).

    The same programs as on `Simulated`, with equal results, and without the bookkeeping.
    """

    def __repr__(self) -> str:
        return "Device()"

    def _shape(self, n: int) -> tuple[int]:
        return (round_up(n, SMALLEST_BLOCK),)

    def _load(self, array: np.ndarray) -> jax.Array:
        block = np.zeros(self._shape(len(array)), array.dtype)
        block[: len(array)] = array
        return jax.device_put(block)

    def to_numpy(self, v: Vector) -> np.ndarray:
        with computing():
            return np.asarray(v._block)[: len(v)].copy()

    def iota(self, n: int) -> Vector:
        check_size(n)
        with computing():
            return Vector(self, _iota(*self._shape(n)), n)

    def _item(self, block: jax.Array, n: Any, i: Any) -> jax.Array:
        return _item(block, i)

    def _map(self, fn: Callable, args: Any, where: Any, otherwise: Any, n: int) -> Any:
        return _local.map_elements(fn, args, where, otherwise)

    def _scan(self, op: Monoid, exclusive: bool, backward: bool, record: Any, heads: Any, n: int) -> Any:
        return _scan(op, exclusive, backward, record, heads, np.int32(n))

    def _route(self, what: str, index: Any, where: Any, n: int, m: int) -> tuple[Any, Any, None]:
        return *_route(index, where, np.int32(n)), None


@partial(jax.jit, static_argnums=0)
def _iota(size: int) -> jax.Array:
    return jnp.arange(size, dtype=jnp.int32)


@jax.jit
def _item(block: jax.Array, i: Any) -> jax.Array:
    return block[i]


@partial(jax.jit, static_argnums=(0, 1, 2))
def _scan(op: Monoid, exclusive: bool, backward: bool, record: Any, heads: Any, n: Any) -> Any:
    index = jnp.arange(jax.tree.leaves(record)[0].size, dtype=jnp.int32)
    valid = index < n
    values = _local.mask_identity(op, record, valid)
    flags = None if heads is None else heads & valid
    if backward and flags is not None:
        # going backward, segments begin at their last elements: where the next one is a head
        flags = jnp.append(flags[1:], False)
    if op in ONE_SIDED:
        first = index == (n - 1 if backward else 0)
        flags = first if flags is None else flags | first
    if backward:
        values, flags = jax.tree.map(lambda x: x[::-1], (values, flags))
    result, _ = _local.inclusive_scan(op, values, flags)
    if exclusive:
        identity = _local.identity_like(op, record)
        result = jax.tree.map(lambda x, e: _local.shift(x, 1, e), result, identity)
        if flags is not None:
            result = jax.tree.map(lambda x, e: jnp.where(flags, e, x), result, identity)
    return jax.tree.map(lambda x: x[::-1], result) if backward else result


@jax.jit
def _route(index: Any, where: Any, n: Any) -> tuple[Any, Any]:
    active = jnp.arange(index.size, dtype=jnp.int32) < n
    if where is not None:
        active &= where
    facts = jnp.stack(_local.span(index, active))
    return jnp.where(active, index.astype(jnp.int32), _local.NOWHERE), facts
