"""XLA calls functions of Python with its own memory; where it cannot, by callbacks with the same results."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax.interpreters import mlir

import dt3d
from dt3d.jax import callback, foreign

from .sets import assert_same, uniform

pytestmark = pytest.mark.usefixtures("on_cpu")

WORDS = "a number is negative"


def doubled(given, results):
    """Of floats to floats and to their number."""
    (numbers,) = given
    if (numbers < 0).any():
        raise KeyError(WORDS)
    results[0][...] = 2 * numbers
    results[1][...] = numbers.size
    SEEN.append((numbers.flags.writeable, *(a.ctypes.data for a in (numbers, *results))))


SEEN = []


@jax.jit
def program(x):
    shapes = [jax.ShapeDtypeStruct(x.shape, x.dtype), jax.ShapeDtypeStruct((), jnp.int32)]
    return jax.ffi.ffi_call(foreign.target_of(doubled), shapes)(x)


@pytest.mark.parametrize("shape", [(), (5,), (3, 0), (2, 3, 4)])
@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.int32, np.int64])
def test_arrays_come_and_go(shape, dtype):
    with jax.enable_x64(True):
        x = jnp.arange(np.prod(shape), dtype=dtype).reshape(shape)
        twice, count = program(x)
        assert twice.dtype == dtype
        np.testing.assert_array_equal(twice, 2 * np.asarray(x))
        assert count == x.size


def test_nothing_is_copied():
    SEEN.clear()
    x = jnp.arange(100_000.0)
    twice, _ = program(x)
    ((writeable, read, written, _),) = SEEN
    assert not writeable
    assert read == x.unsafe_buffer_pointer()
    assert written == twice.unsafe_buffer_pointer()


def test_what_is_raised_is_the_error_of_the_program():
    # JAX makes a ValueError of some of its errors
    with pytest.raises(
        (ValueError, jax.errors.JaxRuntimeError), match=rf"^INVALID_ARGUMENT: KeyError: '{WORDS}'"
    ):
        jax.block_until_ready(program(jnp.array([6.0, -7.0])))
    assert program(jnp.array([1.0]))[0] == 2


def test_one_target_for_one_function():
    assert foreign.target_of(doubled) == foreign.target_of(doubled) == f"{__name__}.doubled"


def test_elsewhere_it_is_a_callback():
    points = uniform(40, 3).astype(np.float32)
    delaunay = jax.jit(lambda p: dt3d.jax.delaunay(p, capacity=444))
    assert "dt3d.jax.host.triangulate_or_raise" in delaunay.lower(points).as_text()
    mlir.register_lowering(callback._HOST_CALL, callback._as_callback, platform="cpu")
    try:
        mesh = dt3d.jax.delaunay(points, capacity=445)
        with pytest.raises(Exception, match="40 sites have .* more than capacity=5"):
            jax.block_until_ready(dt3d.jax.delaunay(points, capacity=5))
    finally:
        mlir.register_lowering(callback._HOST_CALL, callback._as_foreign, platform="cpu")
    assert_same(mesh, points.astype(np.float64))
