"""Vectors in blocks: element i of n on processor i // vp, vp = ceil(n / P); all processors at once.

Arrays are (P, row) with row >= vp; element i is at [i // vp, i % vp]. What each processor does is in
`processor`; here it is mapped over the rows, and compiled.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jax.typing import ArrayLike

from .._monoid import Monoid
from .._records import Args, R
from . import processor

SMALLEST_BLOCK = 16384  # elements; shorter vectors share its compiled kernels

# run by every processor; arguments that have no axis go to all
on_all = partial(jax.vmap, axis_name=processor.PROCESSORS)


def round_up(n: int, least: int) -> int:
    """The smallest of least, 4 least, 16 least, ... that holds n: few lengths, so few compilations."""
    size = least
    while size < n:
        size *= 4
    return size


def vp_ratio(n: int, processors: int) -> int:
    """Virtual processors per processor: ceil(n / P), at least 1."""
    return max(1, -(-n // processors))


def row_length(n: int, processors: int) -> int:
    """How long rows are: at least the VP ratio, rounded up, so that few shapes are compiled."""
    least = round_up(-(-SMALLEST_BLOCK // processors), 1)
    return round_up(vp_ratio(n, processors), least)


def to_blocks(array: np.ndarray, processors: int) -> np.ndarray:
    """The n elements in their rows, zeros behind them."""
    vp = vp_ratio(len(array), processors)
    padded = np.zeros(processors * vp, array.dtype)
    padded[: len(array)] = array
    block = np.zeros((processors, row_length(len(array), processors)), array.dtype)
    block[:, :vp] = padded.reshape(processors, vp)
    return block


def from_blocks(block: np.ndarray, n: int) -> np.ndarray:
    """The n elements of a block, in order, as an array of its own."""
    vp = vp_ratio(n, len(block))
    return block[:, :vp].reshape(-1)[:n].copy()


def indices(shape: tuple[int, ...], vp: ArrayLike) -> jax.Array:
    """The index of each element of a block."""
    p, row = shape
    return jnp.arange(p, dtype=jnp.int32)[:, None] * vp + jnp.arange(row, dtype=jnp.int32)


iota = partial(jax.jit, static_argnums=0)(indices)


@jax.jit
def item(block: jax.Array, p: ArrayLike, j: ArrayLike) -> jax.Array:
    """One element."""
    return block[p, j]


@partial(jax.jit, static_argnums=0)
def map_blocks(fn: Callable[..., R], args: Args, where: jax.Array | None, otherwise: object) -> R:
    """`processor.map_row` on all rows."""
    axes = processor.axes_of((args, where, otherwise))
    out: R = on_all(partial(processor.map_row, fn), axes)(args, where, otherwise)
    return out


@partial(jax.jit, static_argnums=(0, 1, 2))
def scan(
    op: Monoid,
    exclusive: bool,
    backward: bool,
    record: R,
    heads: jax.Array | None,
    n: ArrayLike,
    vp: ArrayLike,
) -> R:
    """`processor.scan` on all rows."""
    one = partial(processor.scan, op, exclusive, backward, False)
    out: R = on_all(one, (0, 0, None, None))(record, heads, n, vp)
    return out


@jax.jit
def get(block: jax.Array, place: jax.Array, otherwise: ArrayLike) -> jax.Array:
    """`processor.get` on all rows."""
    one = partial(processor.get, alone=False)
    out: jax.Array = on_all(one, (0, 0, None))(block, place, otherwise)
    return out
