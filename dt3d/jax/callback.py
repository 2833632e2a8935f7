"""How a compiled program calls the host: once for a batch, without derivatives, with every bit of float64."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import jax
import jax.numpy as jnp

from .host import Arrays


def call_host(
    function: Callable[..., Arrays], results: Sequence[jax.ShapeDtypeStruct], *arrays: jax.Array
) -> Sequence[jax.Array]:
    """What the function of these arrays returns, of those shapes and dtypes; a constant to derivatives.

    Float64 goes as pairs of 32-bit words, see `host.numbers`: JAX hands the arguments over in a thread of its
    own, where ``with jax.enable_x64(True)`` of the caller's does not hold, and rounds them to float32.
    """
    words = [
        jax.lax.bitcast_convert_type(array, jnp.uint32) if array.dtype == jnp.float64 else array
        for array in jax.lax.stop_gradient(arrays)
    ]
    called: Sequence[jax.Array] = jax.pure_callback(function, results, *words, vmap_method="expand_dims")
    return called
