"""How a compiled program calls the host: once for a batch, without derivatives, in a way that cannot hang.

On a CPU the host is a foreign function, which reads and writes the arrays of XLA themselves (`foreign.py`).
Elsewhere it is a callback, by the one rule of `jax.interpreters.mlir` that hands over arrays of NumPy:
`jax.pure_callback` makes arrays of JAX of the arguments. It copies those above 100 kB in XLA's own threads,
and where all of these wait in callbacks no copy is ever made: four threads with some calls each in flight
hang on two cores (github.com/jax-ml/jax/issues/24255). It also makes float32 of float64 where the caller has
64 bits by ``with jax.enable_x64(True)``, which does not hold in XLA's threads.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, cast

import jax
import numpy as np
from jax.extend.core import Primitive
from jax.interpreters import batching, mlir

from .foreign import target_of

if TYPE_CHECKING:
    from .foreign import Filler

Shapes = tuple[jax.core.ShapedArray, ...]

_HOST_CALL = Primitive("dt3d_host_call")
_HOST_CALL.multiple_results = True


def call_host(
    fill: Filler, results: Sequence[tuple[tuple[int, ...], type]], *arrays: jax.Array
) -> list[jax.Array]:
    """Arrays of those shapes and dtypes, which ``fill(arrays, results)`` fills; with arrays of NumPy.

    A constant to derivatives. Under `jax.vmap` all arrays get a leading dimension, 1 where one is the same
    for all, and the results have it, too.

    Parameters
    ----------
    fill : function
        Of a module, and importing none of JAX. It keeps none of the arrays, whose memory is XLA's.
    results : sequence of (tuple of int, type)
        Shapes and dtypes.
    *arrays : jax.Array
        What is given; all of them batched where one is.
    """
    shapes = tuple(jax.core.ShapedArray(shape, dtype) for shape, dtype in results)
    filled: list[jax.Array] = _HOST_CALL.bind(*jax.lax.stop_gradient(arrays), fill=fill, shapes=shapes)
    return filled


@cache
def _compiled(fill: Filler, shapes: Shapes) -> Callable[..., list[jax.Array]]:
    """For calls outside of programs; one for all calls, as the caches of `jax.jit` want."""

    def call(*arrays: jax.Array) -> list[jax.Array]:
        filled: list[jax.Array] = _HOST_CALL.bind(*arrays, fill=fill, shapes=shapes)
        return filled

    return jax.jit(call)


def _run(*arrays: jax.Array, fill: Filler, shapes: Shapes) -> list[jax.Array]:
    return _compiled(fill, shapes)(*arrays)


def _shapes(*arrays: jax.core.ShapedArray, fill: Filler, shapes: Shapes) -> Shapes:
    return shapes


def _of_batch(
    arrays: Sequence[jax.Array], axes: Sequence[int | None], *, fill: Filler, shapes: Shapes
) -> tuple[list[jax.Array], list[int]]:
    (size,) = {a.shape[axis] for a, axis in zip(arrays, axes, strict=True) if axis is not None}
    moved = [
        a[None] if axis is None else jax.numpy.moveaxis(a, axis, 0)
        for a, axis in zip(arrays, axes, strict=True)
    ]
    of_all = tuple(jax.core.ShapedArray((size, *s.shape), s.dtype) for s in shapes)
    return _HOST_CALL.bind(*moved, fill=fill, shapes=of_all), [0] * len(shapes)


def _as_foreign(
    context: mlir.LoweringRuleContext,
    *values: Any,  # of the compiler, as what is returned
    fill: Filler,
    shapes: Shapes,
) -> Any:
    return jax.ffi.ffi_lowering(target_of(fill))(context, *values)


def _as_callback(context: mlir.LoweringRuleContext, *values: Any, fill: Filler, shapes: Shapes) -> Any:
    def filled(*arrays: np.ndarray) -> tuple[np.ndarray, ...]:
        results = tuple(np.empty(shape.shape, shape.dtype) for shape in shapes)
        fill([np.asarray(a) for a in arrays], results)
        return results

    given, results = cast(Sequence[Shapes], (context.avals_in, context.avals_out))
    called, _, _ = mlir.emit_python_callback(
        context, filled, None, list(values), given, results, has_side_effect=False
    )
    return called


_HOST_CALL.def_impl(_run)
_HOST_CALL.def_abstract_eval(_shapes)
batching.primitive_batchers[_HOST_CALL] = _of_batch
mlir.register_lowering(_HOST_CALL, _as_callback)
mlir.register_lowering(_HOST_CALL, _as_foreign, platform="cpu")
