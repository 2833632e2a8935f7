"""Asking for memory before it is needed."""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

from ..._kernel_cache import cached_njit
from ..atomics import element
from ..mesh import NEIGHBOR


@intrinsic
def prefetch(typingctx: Any, array: Any, row: Any) -> Any:
    """prefetch(array, row): begin to load the line of the cache in which a row of a 2D array begins, for
    reading; any row will do."""

    def codegen(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        pair = types.UniTuple(row, 2)
        index = context.make_tuple(builder, pair, [args[1], context.get_constant(row, 0)])
        place = builder.bitcast(
            element(context, builder, array, args[0], pair, index), ir.IntType(8).as_pointer()
        )
        number = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [place.type, number, number, number])
        function = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0i8")
        builder.call(function, [place, number(0), number(3), number(1)])
        return context.get_dummy_value()

    return types.void(array, row), codegen


@cached_njit(forceinline=True)
def prefetch_around(points, nodes, t):
    """Ask for the vertices of t, which is at hand, and for its neighbours."""
    for k in range(3):
        prefetch(nodes, nodes[t, NEIGHBOR + k] >> 2)
        prefetch(points, nodes[t, k])


@cached_njit(forceinline=True)
def prefetch_beyond(points, nodes, t):
    """Ask for the far vertices of the neighbours of t, which are at hand, and what lies beyond them."""
    for k in range(3):
        edge = nodes[t, NEIGHBOR + k]
        u, j = edge >> 2, edge & 3
        prefetch(points, nodes[u, j])
        prefetch(nodes, nodes[u, NEIGHBOR + (j + 1) % 3] >> 2)
        prefetch(nodes, nodes[u, NEIGHBOR + (j + 2) % 3] >> 2)
