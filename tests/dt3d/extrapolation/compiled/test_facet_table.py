"""The table of facets, full and nearly so."""

import jax
import jax.numpy as jnp

from dt3d.extrapolation import dictionary
from dt3d.extrapolation.compiled import facet_table


def test_a_full_table_of_facets_is_not_searched_for_ever():
    corners = jnp.tile(jnp.array([500, 501, 502, 1], jnp.int32), 20)
    facet = tuple(jnp.full(20, v, jnp.int32) for v in (500, 501, 502))
    half, every = 4 * jnp.arange(20, dtype=jnp.int32) + 3, jnp.ones(20, bool)
    with jax.enable_x64(True):
        look_up, insert = jax.jit(facet_table.look_up), jax.jit(facet_table.insert)
        full, slot = jnp.zeros(64, jnp.int32), jnp.full(20, 40, jnp.int32)
        assert int(look_up(full, corners, facet, every)[2]) == 20
        assert int(insert(full, corners, facet, half, slot, every)[2]) == 20
        one_is_free = full.at[40].set(dictionary.EMPTY_SLOT)  # which is enough for one facet
        assert int(look_up(one_is_free, corners, facet, every)[2]) == 0
        _, found, unplaced = insert(one_is_free, corners, facet, half, slot, every)
        assert found.tolist() == [dictionary.ABSENT, *[3] * 19]
        assert int(unplaced) == 0
