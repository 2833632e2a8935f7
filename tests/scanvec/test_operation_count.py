"""Elementary operations of functions."""

import jax.numpy as jnp
import numpy as np
import pytest

import scanvec as sv


@pytest.mark.parametrize(
    ("function", "arguments", "operations"),
    [
        (jnp.add, 2, 1),
        (lambda a, b: a * b + a, 2, 2),
        (lambda a: jnp.where(a > 0, a, -a), 1, 3),
        (lambda a: a, 1, 1),
    ],
)
def test_operations_are_those_of_the_function(function, arguments, operations):
    cm = sv.Simulated(4)
    v = cm.vector(np.arange(8.0))
    cm.map(function, *[v] * arguments)
    assert [e.operations for e in cm.ledger.entries] == [operations]
    # under a context one more selects the result
    cm.map(jnp.add, v, v, where=cm.vector(np.arange(8) > 3), otherwise=0.0)
    assert cm.ledger.entries[-1].operations == 2
