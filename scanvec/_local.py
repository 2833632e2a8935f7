"""What one processor does with its own elements: the kernels that both machines share.

Records are pytrees of arrays; the last axis runs over the elements of one processor.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax

from ._monoid import ADD, AND, COPY, MAX, MIN, MUL, OR, Monoid

# The place of elements outside the context: beyond every block.
NOWHERE = 2**31 - 1

# What permute asks of `put`: places are checked to be distinct.
UNIQUE = Monoid("unique", lambda a, b: b, lambda dtype: 0)

# What `put` can do, which is what XLA's scatters can.
COMBINERS = (UNIQUE, ADD, MUL, MIN, MAX, AND, OR, COPY)


def identity_like(op: Monoid, record: Any) -> Any:
    """The identity of ``op`` in the structure and dtypes of ``record``, as scalars."""
    dtypes = jax.tree.map(lambda x: np.dtype(x.dtype), record)
    value = op.identity(dtypes)
    return jax.tree.map(lambda x, e: jnp.asarray(e, x.dtype), record, value)


def mask_identity(op: Monoid, record: Any, valid: jax.Array) -> Any:
    """The record with the operator's identity where ``valid`` is not set."""
    identity = identity_like(op, record)
    return jax.tree.map(lambda x, e: jnp.where(valid, x, e), record, identity)


def select(mask: jax.Array, a: Any, b: Any) -> Any:
    """Elementwise ``mask ? a : b`` on records."""
    return jax.tree.map(lambda x, y: jnp.where(mask, x, y), a, b)


def shift(x: jax.Array, by: Any, fill: jax.Array) -> jax.Array:
    """``x`` moved ``by`` places to the right along its last axis, ``fill`` coming in."""
    n = x.shape[-1]
    padding = jnp.broadcast_to(fill, x.shape)
    return lax.dynamic_slice_in_dim(jnp.concatenate([padding, x], -1), n - by, n, -1)


@partial(jax.jit, static_argnums=0)
def map_elements(fn: Callable, args: Any, where: Any, otherwise: Any) -> Any:
    """``fn`` of every element, under `jax.vmap` over each axis of the blocks; scalars go to all."""

    def checked(*element: Any) -> Any:
        out = fn(*element)
        for leaf in jax.tree.leaves(out):
            if np.shape(leaf) != ():
                name = getattr(fn, "__name__", repr(fn))
                msg = f"map: {name} returned shape {np.shape(leaf)} for one element; it must return scalars"
                raise TypeError(msg)
            if jnp.iscomplexobj(leaf):
                name = getattr(fn, "__name__", repr(fn))
                msg = f"map: {name} returned a complex number; return a record of its two parts"
                raise TypeError(msg)
        return out

    dimensions = max(map(jnp.ndim, jax.tree.leaves((args, where, otherwise))))
    axes = jax.tree.map(lambda x: 0 if jnp.ndim(x) else None, args)
    for _ in range(dimensions):
        checked = jax.vmap(checked, axes)
    out = checked(*args)
    if where is None:
        return out
    if jax.tree_util.all_leaves([otherwise]):
        otherwise = jax.tree.map(lambda _: otherwise, out)  # one for all leaves
    got, want = map(str, (jax.tree.structure(otherwise), jax.tree.structure(out)))
    if got != want:
        msg = f"map: `otherwise` is a record {got}, the result {want}; give one like the result or a scalar"
        raise TypeError(msg)
    return jax.tree.map(lambda x, y: jnp.where(where, x, jnp.asarray(y, x.dtype)), out, otherwise)


def span(index: jax.Array, active: jax.Array) -> list[jax.Array]:
    """Least and greatest active index, as int64; (0, -1) when none is active."""
    if index.dtype == jnp.uint64:
        index = jnp.minimum(index, jnp.uint64(2**62))
    index = index.astype(jnp.int64)
    greatest = jnp.max(jnp.where(active, index, jnp.iinfo(jnp.int64).min))
    least = jnp.min(jnp.where(active, index, jnp.iinfo(jnp.int64).max))
    some = jnp.any(active)
    return [jnp.where(some, least, 0), jnp.where(some, greatest, -1)]


def inclusive_scan(op: Monoid, record: Any, flags: jax.Array | None) -> tuple[Any, jax.Array | None]:
    """Inclusive scan along the last axis, restarting where ``flags`` is set; and the running OR of ``flags``.

    Recursive doubling (Hillis and Steele 1986): log2(n) sweeps. On a CPU that compiles ten times faster than
    a work-efficient tree and, as every sweep is one wide vector operation, runs no slower.
    """
    n = jax.tree.leaves(record)[0].shape[-1]
    identity = identity_like(op, record)
    sweeps = (n - 1).bit_length()

    def sweep(k: Any, state: tuple) -> tuple:
        values, flags = state
        by = jnp.left_shift(jnp.int32(1), k)
        left = jax.tree.map(lambda x, e: shift(x, by, e), values, identity)
        combined = op.fn(left, values)
        if flags is None:
            return combined, None
        return select(flags, values, combined), flags | shift(flags, by, jnp.asarray(False))

    return lax.fori_loop(0, sweeps, sweep, (record, flags))


@jax.jit
def take(block: jax.Array, place: jax.Array, otherwise: Any) -> jax.Array:
    """The elements of a block at flat places, ``otherwise`` where the place is `NOWHERE`."""
    found = block.reshape(-1)[jnp.minimum(place, block.size - 1)]
    return jnp.where(place < NOWHERE, found, jnp.asarray(otherwise, block.dtype))


@partial(jax.jit, static_argnums=0)
def put(op: Monoid, into: jax.Array, place: jax.Array, values: jax.Array) -> jax.Array:
    """A block with ``values`` combined in at flat places."""
    return _scatter(op, into.reshape(-1), place.reshape(-1), values.reshape(-1)).reshape(into.shape)


def _scatter(op: Monoid, into: jax.Array, target: jax.Array, values: jax.Array) -> jax.Array:
    """``into`` (flat) with ``values`` combined in at ``target``; a target beyond it drops the value."""
    ref = into.at[target]
    if op is UNIQUE:
        return ref.set(values, mode="drop")
    if op in (ADD, MUL):
        return getattr(ref, op.name)(values, mode="drop")
    if op in (MIN, MAX):
        if into.dtype == bool:
            out = into.astype(jnp.uint8)
            out = getattr(out.at[target], op.name)(values.astype(jnp.uint8), mode="drop")
            return out.astype(bool)
        return getattr(ref, op.name)(values, mode="drop")
    if op == COPY:
        # the sender of lowest index wins, whatever the machine
        sender = jnp.arange(target.size, dtype=jnp.int32)
        nobody = jnp.int32(target.size)
        first = jnp.full(into.shape, nobody).at[target.ravel()].min(sender, mode="drop")
        taken = values.ravel()[jnp.minimum(first, target.size - 1)]
        return jnp.where(first < nobody, taken, into)
    return _scatter_bits(op, into, target, values)


@partial(jax.jit, static_argnums=0)
def most_accesses(size: int, place: jax.Array) -> jax.Array:
    """How often the place that is named most, of ``size`` flat ones, is named."""
    count = jnp.zeros(size, jnp.int32).at[place.reshape(-1)].add(1, mode="drop")
    return jnp.max(count)


@jax.jit
def most_hits(into: jax.Array, place: jax.Array) -> jax.Array:
    """How many elements go to the place of ``into`` that is wanted most."""
    return most_accesses(into.size, place)


def _scatter_bits(op: Monoid, into: jax.Array, target: jax.Array, values: jax.Array) -> jax.Array:
    # XLA scatters no bitwise operator; a bit plane at a time, AND is min and OR is max
    mode = "min" if op == AND else "max"
    if into.dtype == bool:
        plane = into.astype(jnp.uint8)
        plane = getattr(plane.at[target], mode)(values.astype(jnp.uint8), mode="drop")
        return plane.astype(bool)
    one = jnp.asarray(1, into.dtype)

    def bit(k: Any, out: jax.Array) -> jax.Array:
        k = k.astype(into.dtype)
        plane = ((into >> k) & one).astype(jnp.uint8)
        sent = ((values >> k) & one).astype(jnp.uint8)
        plane = getattr(plane.at[target], mode)(sent, mode="drop")
        return out | (plane.astype(into.dtype) << k)

    return lax.fori_loop(0, into.dtype.itemsize * 8, bit, jnp.zeros_like(into))
