"""Concurrent writes: several elements may go to one place, wherever they come from.

They are one scatter over a whole block, not a program of one processor: a processor that knew others by
collectives alone would go through the elements of all.
"""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
from jax import lax

from .._monoid import ADD, AND, COPY, MAX, MIN, MUL, OR, UNIQUE, Monoid

# What XLA's scatters can do.
COMBINERS = (UNIQUE, ADD, MUL, MIN, MAX, AND, OR, COPY)


@partial(jax.jit, static_argnums=0)
def put(op: Monoid, into: jax.Array, place: jax.Array, values: jax.Array) -> jax.Array:
    """A block with ``values`` combined in at flat places; a place beyond it drops the value."""
    return _scatter(op, into.reshape(-1), place.reshape(-1), values.reshape(-1)).reshape(into.shape)


def _scatter(op: Monoid, into: jax.Array, target: jax.Array, values: jax.Array) -> jax.Array:
    ref = into.at[target]
    if op is UNIQUE:
        return ref.set(values, mode="drop")
    if op is ADD:
        return ref.add(values, mode="drop")
    if op is MUL:
        return ref.mul(values, mode="drop")
    if op in (MIN, MAX) and into.dtype != bool:
        return _extremum(op, into, target, values)
    if op == COPY:
        # the sender of lowest index wins, whatever the machine
        sender = jnp.arange(target.size, dtype=jnp.int32)
        nobody = jnp.int32(target.size)
        first = jnp.full(into.shape, nobody).at[target.ravel()].min(sender, mode="drop")
        taken = values.ravel()[jnp.minimum(first, target.size - 1)]
        return jnp.where(first < nobody, taken, into)
    # XLA scatters no bitwise operator; a bit plane at a time, AND is min and OR is max
    of_bits = MIN if op in (MIN, AND) else MAX
    if into.dtype == bool:
        plane = _extremum(of_bits, into.astype(jnp.uint8), target, values.astype(jnp.uint8))
        return plane.astype(bool)
    one = jnp.asarray(1, into.dtype)

    def bit(k: jax.Array, out: jax.Array) -> jax.Array:
        k = k.astype(into.dtype)
        plane = ((into >> k) & one).astype(jnp.uint8)
        sent = ((values >> k) & one).astype(jnp.uint8)
        return out | (_extremum(of_bits, plane, target, sent).astype(into.dtype) << k)

    out: jax.Array = lax.fori_loop(0, into.dtype.itemsize * 8, bit, jnp.zeros_like(into))
    return out


def _extremum(op: Monoid, into: jax.Array, target: jax.Array, values: jax.Array) -> jax.Array:
    ref = into.at[target]
    return ref.min(values, mode="drop") if op is MIN else ref.max(values, mode="drop")


@partial(jax.jit, static_argnums=0)
def most_accesses(size: int, place: jax.Array) -> jax.Array:
    """How often the place that is named most, of ``size`` flat ones, is named."""
    count = jnp.zeros(size, jnp.int32).at[place.reshape(-1)].add(1, mode="drop")
    return jnp.max(count)
