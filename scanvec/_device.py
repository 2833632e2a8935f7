"""A machine that is one XLA device: whole vectors under jit, no ledger."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from . import _local
from ._machine import SMALLEST_BLOCK, Machine, round_up
from ._monoid import COPY, Monoid
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
        return np.asarray(v._block)[: len(v)].copy()

    def iota(self, n: int) -> Vector:
        with jax.enable_x64(True):
            return Vector(self, _iota(*self._shape(n)), n)

    def _item(self, block: jax.Array, n: Any, i: Any) -> jax.Array:
        return _item(block, i)

    def _map(self, fn: Callable, args: Any, where: Any, otherwise: Any, n: int) -> Any:
        return _local.map_elements(fn, args, where, otherwise)

    def _scan(self, op: Monoid, exclusive: bool, backward: bool, record: Any, heads: Any, n: int) -> Any:
        return _scan(op, exclusive, backward, record, heads, np.int32(n))

    def _get(
        self, record: Any, index: Any, where: Any, otherwise: Any, n: int, m: int
    ) -> tuple[Any, Any]:
        return _get(record, index, where, otherwise, np.int32(n), np.int32(m))

    def _send(
        self, op: Monoid, record: Any, index: Any, into: Any, where: Any, n: int, m: int
    ) -> tuple[Any, Any]:
        return _send(op, record, index, into, where, np.int32(n), np.int32(m))


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
    if op is COPY:
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
def _get(record: Any, index: Any, where: Any, otherwise: Any, n: Any, m: Any) -> tuple[Any, Any]:
    active = jnp.arange(index.size, dtype=jnp.int32) < m
    if where is not None:
        active &= where
    place = jnp.where(active, jnp.clip(index, 0, jnp.maximum(n - 1, 0)).astype(jnp.int32), 0)
    out = jax.tree.map(lambda x: jnp.where(active, x[place], jnp.asarray(otherwise, x.dtype)), record)
    return out, jnp.stack(_local.span(index, active))


@partial(jax.jit, static_argnums=0)
def _send(
    op: Monoid, record: Any, index: Any, into: Any, where: Any, n: Any, m: Any
) -> tuple[Any, Any]:
    size = jax.tree.leaves(into)[0].size
    active = jnp.arange(index.size, dtype=jnp.int32) < n
    if where is not None:
        active &= where
    place = jnp.where(active, jnp.clip(index, 0, size - 1).astype(jnp.int32), size)
    out = jax.tree.map(lambda r, x: _local.scatter(op, r, place, x), into, record)
    facts = _local.span(index, active) + _local.collisions(op, place, size)
    return out, jnp.stack([x.astype(jnp.int64) for x in facts])
