"""Asking for memory before it is needed."""

from __future__ import annotations

from llvmlite import ir
from numba.core import cgutils, types
from numba.extending import intrinsic

from .atomics import element


@intrinsic
def prefetch(typingctx, array, index):
    """Begin to load the line of the cache in which ``array[index]`` begins, for reading.

    Any index will do, also one that is out of bounds. In a 2D array it is the index of a row.
    """

    def codegen(context, builder, signature, args):
        place_type = types.UniTuple(types.intp, array.ndim)
        first = context.cast(builder, args[1], index, types.intp)
        zeros = [context.get_constant(types.intp, 0)] * (array.ndim - 1)
        whole = context.make_tuple(builder, place_type, [first, *zeros])
        pointer = element(context, builder, array, args[0], place_type, whole)
        place = builder.bitcast(pointer, ir.IntType(8).as_pointer())
        number = ir.IntType(32)
        kind = ir.FunctionType(ir.VoidType(), [place.type, number, number, number])
        function = cgutils.get_or_insert_function(builder.module, kind, "llvm.prefetch.p0i8")
        builder.call(function, [place, number(0), number(3), number(1)])
        return context.get_dummy_value()

    return types.void(array, index), codegen
