"""Where JAX runs; `tests/dt3d/test_fork.py` has processes that were forked."""

import jax
import jax.numpy as jnp

from scanvec._running import computing


def test_64_bits_inside_only():
    before = jax.config.jax_enable_x64
    with computing():
        assert jnp.asarray([0.5]).dtype == "float64"
    assert jax.config.jax_enable_x64 == before
