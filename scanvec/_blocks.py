"""Vectors in blocks: element i of n on processor i // vp, vp = ceil(n / P); and scans within and across them.

Arrays are (P, row) with row >= vp; element i is at [i // vp, i % vp].
"""

from __future__ import annotations

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp

from . import _local
from ._monoid import ONE_SIDED, Monoid


def vp_ratio(n: int, processors: int) -> int:
    """Virtual processors a processor: ceil(n / P), at least 1."""
    return max(1, -(-n // processors))


def in_use(shape: tuple[int, int], n: Any, vp: Any) -> jax.Array:
    """Which places of a block hold an element."""
    column = jnp.arange(shape[1], dtype=jnp.int32)
    return (column < vp) & (indices(shape, vp) < n)


def indices(shape: tuple[int, int], vp: Any) -> jax.Array:
    p, row = shape
    return jnp.arange(p, dtype=jnp.int32)[:, None] * vp + jnp.arange(row, dtype=jnp.int32)


@partial(jax.jit, static_argnums=0)
def iota(shape: tuple[int, int], vp: Any) -> jax.Array:
    return indices(shape, vp)


@jax.jit
def item(block: jax.Array, p: Any, j: Any) -> jax.Array:
    return block[p, j]


@partial(jax.jit, static_argnums=(0, 1, 2))
def scan(op: Monoid, exclusive: bool, backward: bool, record: Any, heads: Any, n: Any, vp: Any) -> Any:
    shape = jax.tree.leaves(record)[0].shape
    valid = in_use(shape, n, vp)
    index = indices(shape, vp)
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
