"""A JAX that miscompiles must not pass unseen: matrix times vector, then a sum, for many vectors on a CPU.

JAX 0.10.2 leaves the last elements wrong where a dot product with one small matrix is fused with a sum, from
16385 elements of float64 or 32769 of float32 on (github.com/jax-ml/jax/issues/39103). The numbers here are
whole, so that every correct order of summation gives the same bits.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from .cases import MACHINES

N = 32769
MATRIX = np.array([[3, 1, 0], [-2, -2, -4], [-4, 5, -3]])
POINTS = np.random.default_rng(39103).integers(-9, 10, (N, 3))


def sum_of_squares(matrix, x):
    return jnp.sum((matrix @ x) ** 2)


def plain_sum(matrix, x):
    return jnp.sum(matrix @ x)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_matrix_times_vector_then_the_sum_of_squares(dtype):
    want = ((POINTS @ MATRIX.T) ** 2).sum(1)
    with jax.enable_x64(True):
        many = jax.jit(jax.vmap(sum_of_squares, (None, 0)))
        got = many(MATRIX.astype(dtype), POINTS.astype(dtype))
    np.testing.assert_array_equal(got, want)


def test_matrix_times_vector_then_the_sum():
    # in double precision: in single, 0.9.2 to 0.10.1 get this one form wrong, which scanvec does not use
    want = (POINTS @ MATRIX.T).sum(1)
    with jax.enable_x64(True):
        many = jax.jit(jax.vmap(plain_sum, (None, 0)))
        got = many(MATRIX.astype("float64"), POINTS.astype("float64"))
    np.testing.assert_array_equal(got, want)


def by_components(x, y, z):
    image = jnp.asarray(MATRIX, x.dtype) @ jnp.stack([x, y, z])
    return jnp.sum(image), jnp.sum(image**2)


@pytest.mark.parametrize("dtype", ["float32", "float64"])
@pytest.mark.parametrize("machine", [MACHINES[0], MACHINES[3]], ids=repr)
def test_the_same_in_a_map(machine, dtype):
    # what keeps a map safe is that its vectors are components, which no dot product takes as they are
    image = POINTS @ MATRIX.T
    got = machine.map(by_components, *(machine.vector(column) for column in POINTS.T.astype(dtype)))
    np.testing.assert_array_equal(got[0], image.sum(1))
    np.testing.assert_array_equal(got[1], (image**2).sum(1))
