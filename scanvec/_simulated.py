"""A machine of P simulated processors: blocks, local work under vmap, and a ledger."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from . import _local
from ._checks import check_size
from ._ledger import Ledger
from ._machine import SMALLEST_BLOCK, Machine, round_up
from ._monoid import ONE_SIDED, Monoid
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
        check_size(n)
        self._enter("map", n)
        with jax.enable_x64(True):
            return Vector(self, _iota(self._shape(n), np.int32(self.vp_ratio(n))), n)

    def _item(self, block: jax.Array, n: Any, i: Any) -> jax.Array:
        vp = self.vp_ratio(int(n))
        return _item(block, np.int32(i // vp), np.int32(i % vp))

    def _map(self, fn: Callable, args: Any, where: Any, otherwise: Any, n: int) -> Any:
        out = _local.map_elements(fn, args, where, otherwise)
        self._enter("map", n)
        return out

    def _scan(self, op: Monoid, exclusive: bool, backward: bool, record: Any, heads: Any, n: int) -> Any:
        # every processor that holds elements, but the last, passes one partial result on
        messages = max(-(-n // self.vp_ratio(n)) - 1, 0)
        size = sum(x.dtype.itemsize for x in jax.tree.leaves(record))
        vp = self.vp_ratio(n)
        out = _scan(op, exclusive, backward, record, heads, np.int32(n), np.int32(vp))
        self.ledger.record("scan", n, vp, messages, min(messages, 1), size)
        return out

    def _route(self, what: str, index: Any, where: Any, n: int, m: int) -> tuple[Any, Any]:
        row = np.int32(self._shape(m)[1])
        vps = np.int32(self.vp_ratio(n)), np.int32(self.vp_ratio(m))
        return _route(what == "get", index, where, np.int32(n), np.int32(m), row, *vps)

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
def _scan(op: Monoid, exclusive: bool, backward: bool, record: Any, heads: Any, n: Any, vp: Any) -> Any:
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
    if op in ONE_SIDED:
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


@partial(jax.jit, static_argnums=0)
def _route(
    replies: bool, index: Any, where: Any, n: Any, m: Any, row: Any, vp_n: Any, vp_m: Any
) -> tuple[Any, Any]:
    """Where n indices lead in a vector of m elements whose blocks have rows of ``row``."""
    processors = index.shape[0]
    active = _valid(index.shape, n, vp_n)
    if where is not None:
        active &= where
    least, greatest = _local.span(index, active)
    index = jnp.clip(index, 0, jnp.maximum(m - 1, 0)).astype(jnp.int32)
    owner = index // vp_m
    place = jnp.where(active, owner * row + (index - owner * vp_m), _local.NOWHERE)
    # messages: each processor's own elements that lead elsewhere, and those of others that lead to it
    remote = active & (owner != jnp.arange(processors, dtype=jnp.int32)[:, None])
    sent = jnp.sum(remote, 1)
    to = jnp.where(remote, owner, processors).reshape(-1)
    received = jnp.zeros(processors, sent.dtype).at[to].add(1, mode="drop")
    if replies:
        loads = [2 * jnp.sum(sent), jnp.max(sent + received)]
    else:
        loads = [jnp.sum(sent), jnp.maximum(jnp.max(sent), jnp.max(received))]
    return place, jnp.stack([x.astype(jnp.int64) for x in [least, greatest, *loads]])
