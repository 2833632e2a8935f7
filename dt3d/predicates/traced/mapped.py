"""Functions of single points that work on arrays when they are mapped, and signs of whole arrays.

Under `jax.vmap` what a function stacks has the mapped axis first, and loops over few digits inside. Here the
mapped axis comes last, so that XLA's inner loops are over cases; and on a CPU many cases are taken in
blocks, so that what is computed on the way stays in cache.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jax.custom_batching import custom_vmap

from scanvec._running import computing

from . import determinants
from .digits import limbs_of

Coordinate = tuple[jax.Array, ...]  # its digits
Point = tuple[Coordinate, ...]

# Digits of a coordinate, over the cases of a block, for which an in-sphere test stays in cache. Measured on
# two cores with 1 MiB each, 10^5 cases of four digits: 1.3 microseconds a test, and 4.3 without blocks.
DIGITS_IN_CACHE = 4096


def on_arrays(function: Callable[..., jax.Array]) -> Callable[..., jax.Array]:
    """A function of a tuple of points, and of more scalars, from one of arrays.

    ``function(x, *more)`` gets points int32 (L, k, d, n), and arrays (n,) for scalars, and returns (n,).
    """

    @custom_vmap
    def whole(points: tuple[Point, ...], *more: object) -> jax.Array:
        k, d, length = len(points), len(points[0]), len(points[0][0])
        digits = [jnp.ravel(c[i]) for i in range(length) for p in points for c in p]
        x = jnp.stack(digits).reshape(length, k, d, -1).astype(jnp.int32)
        more = jax.tree.map(jnp.ravel, more)
        return in_blocks(function, x, *more).reshape(jnp.shape(points[0][0][0]))

    @whole.def_vmap
    def mapped(size: int, is_mapped: list[object], *args: object) -> tuple[jax.Array, bool]:
        def with_axis(x: jax.Array, is_mapped: bool) -> jax.Array:
            return x if is_mapped else jnp.broadcast_to(x, (size, *jnp.shape(x)))

        return whole(*jax.tree.map(with_axis, args, tuple(is_mapped))), True

    return whole


def in_blocks(function: Callable[..., jax.Array], x: jax.Array, *more: object) -> jax.Array:
    """``function(x, *more)``, on a CPU of one block of the last axis after the other."""
    count = x.shape[-1]
    size = max(DIGITS_IN_CACHE // len(x), 64)
    if count <= size:
        return function(x, *more)

    def loop(*args: object) -> jax.Array:
        def block(i: jax.Array, out: jax.Array) -> jax.Array:
            start = jnp.minimum(i * size, count - size)  # the last block laps over the one before
            part = function(*jax.tree.map(lambda x: lax.dynamic_slice_in_dim(x, start, size, -1), args))
            return lax.dynamic_update_slice_in_dim(out, part, start, 0)

        result = jax.eval_shape(function, *args)
        out: jax.Array = lax.fori_loop(0, -(-count // size), block, jnp.zeros(result.shape, result.dtype))
        return out

    values: jax.Array = lax.platform_dependent(x, *more, cpu=loop, default=function)
    return values


def signs(predicate: str, cases: np.ndarray) -> np.ndarray:
    """Return the signs of cases float64 (m, k, d), int8 (m,), all at once."""
    count, k, d = cases.shape
    digits = limbs_of(cases.reshape(-1, d))
    digits = np.moveaxis(digits.reshape(len(digits), count, k, d), 1, -1)
    # the next power of two, so that few lengths are compiled
    room = 1 << max(count - 1, 0).bit_length()
    digits = np.pad(digits, [(0, 0), (0, 0), (0, 0), (0, room - count)])
    with computing():
        return np.asarray(_signs(predicate, digits))[:count].astype(np.int8)


@partial(jax.jit, static_argnums=0)
def _signs(predicate: str, digits: jax.Array) -> jax.Array:
    return in_blocks(getattr(determinants, predicate), digits)
