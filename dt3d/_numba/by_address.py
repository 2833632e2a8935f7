"""Calls of compiled functions by their addresses, which an array holds.

numba takes all that a function calls into it, and LLVM optimises it there anew: each kernel would compile the
exact stages of the predicates again, for as long as it takes to compile the rest. What is called by its
address is compiled once. The address is that of this process, so it must come in an argument: code on disk
cannot have it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.base import BaseContext
from numba.core.dispatcher import Dispatcher
from numba.core.typing.templates import Signature

from .._errors import InternalError


def address_of(function: Dispatcher, kinds: Sequence[types.Type]) -> int:
    """Where the code of a function for these types is; it is compiled, or loaded, if it is not there.

    >>> import numba
    >>> from numba.core import types
    >>> address_of(numba.njit(lambda x: x + 1), [types.int64]) > 0
    True
    """
    function.compile(tuple(kinds))
    compiled = function.overloads[tuple(kinds)]
    return int(compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name))


def call_at(
    array: types.Array, place: int, returned: types.Type, kinds: Sequence[types.Type]
) -> tuple[Signature, Callable[..., ir.Value]]:
    """What an intrinsic returns that calls the function whose address is in an array of float64.

    The first argument of the intrinsic is the array, of one dimension and in C order, at whose ``place`` the
    64 bits of the address are. The others, of these types, are those of the function, which raises nothing
    and has been compiled for exactly these types.
    """

    def codegen(
        context: BaseContext, builder: ir.IRBuilder, signature: Signature, values: Sequence[ir.Value]
    ) -> ir.Value:
        holder = context.make_array(array)(context, builder, values[0])
        word = builder.gep(holder.data, [ir.Constant(ir.IntType(64), place)])
        kind = context.call_conv.get_function_type(returned, kinds)
        address = builder.bitcast(builder.load(word), ir.IntType(64))
        missing = builder.icmp_unsigned("==", address, ir.Constant(ir.IntType(64), 0))
        with cgutils.if_unlikely(builder, missing):
            context.call_conv.return_user_exc(builder, InternalError, (f"there is no address at {place}",))
        function = builder.inttoptr(address, kind.as_pointer())
        words = [
            context.cast(builder, value, given, taken)
            for value, given, taken in zip(values[1:], signature.args[1:], kinds, strict=True)
        ]
        _, result = context.call_conv.call_function(builder, function, returned, kinds, words)
        return result

    return returned(array, *kinds), codegen
