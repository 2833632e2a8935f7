"""A machine of P simulated processors: blocks, local work under vmap, and a ledger."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from . import _local
from ._ledger import Ledger
from ._machine import SMALLEST_BLOCK, Machine, round_up
from ._monoid import COPY, Monoid
from ._vector import Vector


class Simulated(Machine):
    """P processors, each with ceil(n / P) consecutive elements of every vector of length n.

    Virtual processing as on a Connection Machine: element i lives on processor i // ceil(n / P), and a step
    takes as long as the processor with most elements. Work inside a processor runs under `jax.vmap` over
    the processors; what crosses between them is counted in `ledger`.

    Parameters
    ----------
    processors : int
        P, at least 1.

    Attributes
    ----------
    ledger : Ledger
        Every step so far.

    Raises
    ------
    ValueError
        If ``processors`` is not a positive integer.
    """

    def __init__(self, processors: int) -> None:
        if isinstance(processors, bool) or int(processors) != processors or processors < 1:
            msg = f"processors must be a positive integer, got {processors!r}"
            raise ValueError(msg)
        self.processors = int(processors)
        self.ledger = Ledger()

    def __repr__(self) -> str:
        return f"Simulated(processors={self.processors})"

    def vp_ratio(self, n: int) -> int:
        """Virtual processors a processor for vectors of length n: ceil(n / P), at least 1."""
        return max(1, -(-n // self.processors))

    def _shape(self, n: int) -> tuple[int, int]:
        # A row is longer than the VP ratio: rounded up, so that few shapes are compiled.
        least = round_up(-(-SMALLEST_BLOCK // self.processors), 1)
        return self.processors, round_up(self.vp_ratio(n), least)

    def _load(self, array: np.ndarray) -> jax.Array:
        p, row = self._shape(len(array))
        vp = self.vp_ratio(len(array))
        block = np.zeros((p, row), array.dtype)
        padded = np.zeros(p * vp, array.dtype)
        padded[: len(array)] = array
        block[:, :vp] = padded.reshape(p, vp)
        return jax.device_put(block)

    def to_numpy(self, v: Vector) -> np.ndarray:
        vp = self.vp_ratio(len(v))
        return np.asarray(v._block)[:, :vp].reshape(-1)[: len(v)].copy()

    def iota(self, n: int) -> Vector:
        self._enter("map", n)
        with jax.enable_x64(True):
            return Vector(self, _iota(self._shape(n), np.int32(self.vp_ratio(n))), n)

    def _item(self, block: jax.Array, n: Any, i: Any) -> jax.Array:
        vp = self.vp_ratio(int(n))
        return _item(block, np.int32(i // vp), np.int32(i % vp))

    def _map(self, fn: Callable, args: Any, where: Any, otherwise: Any, n: int) -> Any:
        self._enter("map", n)
        return _local.map_elements(fn, args, where, otherwise)

    def _scan(self, op: Monoid, exclusive: bool, backward: bool, record: Any, heads: Any, n: int) -> Any:
        # every processor that holds elements, but the last, passes one partial result on
        holding = -(-n // self.vp_ratio(n))
        size = sum(x.dtype.itemsize for x in jax.tree.leaves(record))
        self.ledger.record("scan", n, self.vp_ratio(n), max(holding - 1, 0), min(holding - 1, 1), size)
        return _scan(op, exclusive, backward, record, heads, np.int32(n), np.int32(self.vp_ratio(n)))

    def _get(
        self, record: Any, index: Any, where: Any, otherwise: Any, n: int, m: int
    ) -> tuple[Any, Any]:
        vps = np.int32(self.vp_ratio(n)), np.int32(self.vp_ratio(m))
        return _get(record, index, where, otherwise, np.int32(n), np.int32(m), *vps)

    def _send(
        self, op: Monoid, record: Any, index: Any, into: Any, where: Any, n: int, m: int
    ) -> tuple[Any, Any]:
        vps = np.int32(self.vp_ratio(n)), np.int32(self.vp_ratio(m))
        return _send(op, record, index, into, where, np.int32(n), np.int32(m), *vps)

    def _charge(self, primitive: str, n: int, loads: list[int], vectors: list[Vector]) -> None:
        messages, busiest = loads
        size = sum(v.dtype.itemsize for v in vectors)
        self.ledger.record(primitive, n, self.vp_ratio(n), messages, busiest, size)

    def _enter(self, primitive: str, n: int) -> None:
        self.ledger.record(primitive, n, self.vp_ratio(n), 0, 0, 0)


# The kernels. Arrays are (P, row); row >= vp, the VP ratio; element i is at [i // vp, i % vp].


def _valid(shape: tuple[int, int], n: Any, vp: Any) -> jax.Array:
    """Which places of a block hold an element."""
    column = jnp.arange(shape[1], dtype=jnp.int32)
    return (column < vp) & (_indices(shape, vp) < n)


def _indices(shape: tuple[int, int], vp: Any) -> jax.Array:
    p, row = shape
    return jnp.arange(p, dtype=jnp.int32)[:, None] * vp + jnp.arange(row, dtype=jnp.int32)


@partial(jax.jit, static_argnums=0)
def _iota(shape: tuple[int, int], vp: Any) -> jax.Array:
    return _indices(shape, vp)


@jax.jit
def _item(block: jax.Array, p: Any, j: Any) -> jax.Array:
    return block[p, j]


@partial(jax.jit, static_argnums=(0, 1, 2))
def _scan(
    op: Monoid, exclusive: bool, backward: bool, record: Any, heads: Any, n: Any, vp: Any
) -> Any:
    shape = jax.tree.leaves(record)[0].shape
    valid = _valid(shape, n, vp)
    index = _indices(shape, vp)
    values = _local.mask_identity(op, record, valid)
    flags = None if heads is None else heads & valid
    if backward and flags is not None:
        # going backward, segments begin at their last elements: where the next one is a head
        following = jnp.roll(flags[:, 0], -1)[:, None]
        following = jnp.where(
            jnp.arange(shape[1]) == vp - 1, following, jnp.concatenate([flags[:, 1:], following], 1)
        )
        flags = following & valid
    if op is COPY:
        first = index == (n - 1 if backward else 0)
        flags = (first & valid) if flags is None else flags | (first & valid)
    if backward:
        values, flags = jax.tree.map(lambda x: x[::-1, ::-1], (values, flags))

    # every processor scans its own elements
    local, seen = jax.vmap(partial(_local.inclusive_scan, op))(values, flags)
    # the processors' totals are scanned once, and come back as what each one starts with
    totals = jax.tree.map(lambda x: x[:, -1], local)
    running, _ = _local.inclusive_scan(op, totals, None if seen is None else seen[:, -1])
    identity = _local.identity_like(op, record)
    carry = jax.tree.map(lambda x, e: _local.shift(x, 1, e)[:, None], running, identity)
    result = op.fn(jax.tree.map(lambda c, x: jnp.broadcast_to(c, x.shape), carry, local), local)
    if seen is not None:
        result = _local.select(seen, local, result)
    if exclusive:
        result = jax.tree.map(lambda c, x: jnp.concatenate([c, x[:, :-1]], 1), carry, result)
        if flags is not None:
            result = jax.tree.map(lambda x, e: jnp.where(flags, e, x), result, identity)
    return jax.tree.map(lambda x: x[::-1, ::-1], result) if backward else result


def _place(index: jax.Array, n: Any, vp: Any, row: int, active: jax.Array, size: int) -> tuple:
    """Owner and flat place of each indexed element; inactive ones get the place ``size``."""
    index = jnp.clip(index, 0, jnp.maximum(n - 1, 0)).astype(jnp.int32)
    owner = index // vp
    return owner, jnp.where(active, owner * row + (index - owner * vp), size)


@jax.jit
def _get(
    record: Any, index: Any, where: Any, otherwise: Any, n: Any, m: Any, vp_n: Any, vp_m: Any
) -> tuple[Any, Any]:
    processors, row = jax.tree.leaves(record)[0].shape
    active = _valid(index.shape, m, vp_m)
    if where is not None:
        active &= where
    owner, place = _place(index, n, vp_n, row, active, 0)
    out = jax.tree.map(
        lambda x: jnp.where(active, x.reshape(-1)[place], jnp.asarray(otherwise, x.dtype)), record
    )
    remote = active & (owner != jnp.arange(processors, dtype=jnp.int32)[:, None])
    asked = jnp.sum(remote, 1)
    answered = _count_by_processor(owner, remote, processors)
    loads = [2 * jnp.sum(asked), jnp.max(asked + answered)]
    return out, jnp.stack([x.astype(jnp.int64) for x in _local.span(index, active) + loads])


@partial(jax.jit, static_argnums=0)
def _send(
    op: Monoid, record: Any, index: Any, into: Any, where: Any, n: Any, m: Any, vp_n: Any, vp_m: Any
) -> tuple[Any, Any]:
    processors, row = jax.tree.leaves(into)[0].shape
    size = processors * row
    active = _valid(index.shape, n, vp_n)
    if where is not None:
        active &= where
    owner, place = _place(index, m, vp_m, row, active, size)
    out = jax.tree.map(
        lambda r, x: _local.scatter(op, r.reshape(-1), place.reshape(-1), x.reshape(-1)).reshape(r.shape),
        into,
        record,
    )
    most, worst = _local.collisions(op, place.reshape(-1), size)
    hits = [most, worst // row * vp_m + worst % row]
    remote = active & (owner != jnp.arange(processors, dtype=jnp.int32)[:, None])
    sent = jnp.sum(remote, 1)
    received = _count_by_processor(owner, remote, processors)
    loads = [jnp.sum(sent), jnp.maximum(jnp.max(sent), jnp.max(received))]
    return out, jnp.stack([x.astype(jnp.int64) for x in _local.span(index, active) + hits + loads])


def _count_by_processor(owner: jax.Array, counted: jax.Array, processors: int) -> jax.Array:
    place = jnp.where(counted, owner, processors)
    return jnp.zeros(processors, jnp.int32).at[place.reshape(-1)].add(1, mode="drop")
