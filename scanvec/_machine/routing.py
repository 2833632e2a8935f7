"""Routes: where indices lead in blocks, and how many messages between processors that takes.

Each processor finds the places of its own indices. Messages are counted where they come from and go to, for
all processors at once: as a sum of the processors' own counts, P numbers each, it would be P * P of them.
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax.typing import ArrayLike

from . import blocks, processor


class Route(NamedTuple):
    """Where the indices of a get or a send lead, and what it takes to get there."""

    place: jax.Array  # flat places in the target's block; beyond it outside the context
    loads: list[int]  # messages in all, and of the busiest processor; accesses; the same for other machines
    handled: jax.Array | None  # messages of each processor, where they are counted


class Layout(NamedTuple):
    """How a vector of n indices and the m elements that they name lie in blocks."""

    n: ArrayLike
    vp_n: ArrayLike
    m: ArrayLike
    vp_m: ArrayLike
    row: ArrayLike  # how long the rows of the m elements are


def layout(n: int, m: int, processors: int) -> Layout:
    """The layout of n indices and m elements on P processors."""
    counts = n, blocks.vp_ratio(n, processors), m, blocks.vp_ratio(m, processors)
    return Layout(*map(np.int32, (*counts, blocks.row_length(m, processors))))


def _places(index: jax.Array, where: jax.Array | None, at: Layout) -> tuple[jax.Array, ...]:
    """One processor: the places of its indices, what they span, and the owners of those that lead away."""
    active = processor.in_use(index.size, at.n, at.vp_n, False)
    if where is not None:
        active &= where
    least, greatest = processor.span(index, active, False)
    index = jnp.clip(index, 0, jnp.maximum(at.m - 1, 0)).astype(jnp.int32)
    owner = index // at.vp_m
    place = jnp.where(active, owner * at.row + (index - owner * at.vp_m), processor.NOWHERE)
    remote = active & (owner != processor.rank(False))
    return place, least, greatest, remote, owner


@partial(jax.jit, static_argnums=0)
def find(
    replies: bool, index: jax.Array, where: jax.Array | None, at: Layout
) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Flat places; least and greatest index, messages in all and of the busiest processor; those of each."""
    of_all = blocks.on_all(_places, (0, 0, None), (0, None, None, 0, 0))
    place, least, greatest, remote, owner = of_all(index, where, at)
    sent = jnp.sum(remote, 1)
    received = _count(owner, remote, len(index), sent.dtype)
    # a request goes out for each reply that comes in, and the other way round
    handled = sent + received if replies else jnp.maximum(sent, received)
    total = 2 * jnp.sum(sent) if replies else jnp.sum(sent)
    facts = [least, greatest, total, jnp.max(handled)]
    return place, jnp.stack([x.astype(jnp.int64) for x in facts]), handled


@partial(jax.jit, static_argnums=(0, 1))
def loads_elsewhere(
    replies: bool, machines: tuple[int, ...], index: jax.Array, where: jax.Array | None, at: Layout,
    vps_n: jax.Array, vps_m: jax.Array,
) -> jax.Array:  # fmt: skip
    """Messages in all, and of the busiest processor, on machines of other numbers of processors: int64 (2k,).

    The block is laid out as ``at`` says; ``vps_n`` and ``vps_m`` are the VP ratios on the others.
    """
    element = blocks.indices(index.shape, at.vp_n)
    active = (jnp.arange(index.shape[1], dtype=jnp.int32) < at.vp_n) & (element < at.n)
    if where is not None:
        active &= where
    out = []
    for k, p in enumerate(machines):
        owner, asker = (index // vps_m[k]).astype(jnp.int32), element // vps_n[k]
        remote = active & (owner != asker)
        sent, received = _count(asker, remote, p, jnp.int32), _count(owner, remote, p, jnp.int32)
        total = jnp.sum(remote, dtype=jnp.int64)
        if replies:
            out += [2 * total, jnp.max(sent + received)]
        else:
            out += [total, jnp.maximum(jnp.max(sent), jnp.max(received))]
    return jnp.stack([x.astype(jnp.int64) for x in out])


def _count(processors: jax.Array, remote: jax.Array, p: int, dtype: jnp.dtype) -> jax.Array:
    """How many of the messages each of p processors has."""
    to = jnp.where(remote, processors, p).reshape(-1)
    return jnp.zeros(p, dtype).at[to].add(1, mode="drop")
