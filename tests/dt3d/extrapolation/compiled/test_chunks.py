"""Loops over chunks."""

import jax.numpy as jnp
import numpy as np

from dt3d.extrapolation.compiled.chunks import UNROLLED, at, cut, over_chunks, unrolled


def test_every_element_is_in_one_chunk():
    values = jnp.arange(32)

    def add(start, active, total):
        return total + jnp.sum(jnp.where(active, cut(values, start, 8), 0))

    for count in (0, 1, 8, 19, 32):
        assert int(over_chunks(add, jnp.int32(0), jnp.int32(count), 8)) == sum(range(count))


def test_turns_go_a_little_too_far():
    turns = unrolled(jnp.int32(6), lambda k, seen: jnp.maximum(seen, k), jnp.int32(-1))
    assert int(turns) == 2 * UNROLLED - 1


def test_elements_at_indices():
    np.testing.assert_array_equal(at(jnp.arange(5) * 2, jnp.array([3, 0])), [6, 0])
