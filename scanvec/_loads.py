"""Where indices lead in vectors that lie in blocks, and how many messages between processors that takes."""

from __future__ import annotations

from functools import partial
from typing import Any

import jax
import jax.numpy as jnp

from . import _local
from ._blocks import in_use, indices


@partial(jax.jit, static_argnums=0)
def route(
    replies: bool, index: Any, where: Any, n: Any, m: Any, row: Any, vp_n: Any, vp_m: Any
) -> tuple[Any, Any, Any]:
    """Where n indices lead in a vector of m elements whose blocks have rows of ``row``."""
    processors = index.shape[0]
    active = in_use(index.shape, n, vp_n)
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
    if replies:  # a request goes out for each reply that comes in, and the other way round
        handled = sent + received
        loads = [2 * jnp.sum(sent), jnp.max(handled)]
    else:
        handled = jnp.maximum(sent, received)
        loads = [jnp.sum(sent), jnp.max(handled)]
    return place, jnp.stack([x.astype(jnp.int64) for x in [least, greatest, *loads]]), handled


@partial(jax.jit, static_argnums=(0, 1))
def loads_elsewhere(
    replies: bool, machines: tuple[int, ...], index: Any, where: Any, n: Any, vp: Any, vps_n: Any, vps_m: Any
) -> jax.Array:
    """Messages in all, and of the busiest processor, on machines of other numbers of processors: int64 (2k,).

    The block is laid out with ``vp`` elements a row; ``vps_n`` and ``vps_m`` are the VP ratios on the others.
    """
    active = in_use(index.shape, n, vp)
    if where is not None:
        active &= where
    element = indices(index.shape, vp)
    out = []
    for k, p in enumerate(machines):
        owner, asker = (index // vps_m[k]).astype(jnp.int32), element // vps_n[k]
        remote = active & (owner != asker)
        none = jnp.zeros(p, jnp.int32)
        sent = none.at[jnp.where(remote, asker, p).reshape(-1)].add(1, mode="drop")
        received = none.at[jnp.where(remote, owner, p).reshape(-1)].add(1, mode="drop")
        total = jnp.sum(remote, dtype=jnp.int64)
        if replies:
            out += [2 * total, jnp.max(sent + received)]
        else:
            out += [total, jnp.maximum(jnp.max(sent), jnp.max(received))]
    return jnp.stack([x.astype(jnp.int64) for x in out])
