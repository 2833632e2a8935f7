"""Calls of compiled functions by their addresses, which an array holds.

numba takes all that a function calls into it, and LLVM optimises it there anew: each kernel would compile the
exact stages of the predicates again, for as long as it takes to compile the rest. What is called by its
address is compiled once, and only when a kernel comes to the call: where the array has no address, it has
that of a function which finds it. The addresses are those of this process, so they must come in an argument:
code on disk cannot have them.
"""

from __future__ import annotations

import ctypes
import logging
from collections.abc import Callable, Sequence

import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.base import BaseContext
from numba.core.compiler_lock import global_compiler_lock
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


NOT_FOUND = -1  # in the place of an address: the function could not be compiled

_FINDER = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int64)


class Functions:
    """Compiled functions, each with a place in the arrays that have their addresses.

    Parameters
    ----------
    finder : int
        The place of the address of what finds the others.
    """

    def __init__(self, finder: int) -> None:
        self.finder = finder
        self._functions: dict[int, tuple[Dispatcher, tuple[types.Type, ...]]] = {}
        self._addresses: dict[int, int] = {}
        self._callback = _FINDER(self._find)  # which has to live as long as its address is known
        self._addresses[finder] = ctypes.cast(self._callback, ctypes.c_void_p).value or 0

    def add(self, place: int, function: Dispatcher, kinds: Sequence[types.Type]) -> None:
        """Let a function for arguments of these types have a place."""
        self._functions[place] = function, tuple(kinds)

    def kinds(self, place: int) -> tuple[types.Type, ...]:
        """The types of the arguments of the function at a place."""
        return self._functions[place][1]

    def address(self, place: int) -> int:
        """The address for a place. Its function is compiled, or loaded from disk, when first asked for."""
        with global_compiler_lock:  # a fork waits for it
            if place not in self._addresses:
                self._addresses[place] = address_of(*self._functions[place])
        return self._addresses[place]

    def write(self, words: np.ndarray) -> None:
        """Write the addresses that are known into an array int64 (k,): the finder's and what was asked."""
        for place, address in tuple(self._addresses.items()):
            words[place] = address

    def _find(self, array: int, place: int) -> None:
        """Write the address for a place into an array that begins here; called by compiled code.

        Kernels that run without the interpreter's lock take it meanwhile. Python cannot raise through them:
        where the address is still 0 afterwards, the kernel raises KeyboardInterrupt, for only a signal ends
        this function in that way, whenever it comes.
        """
        word = ctypes.c_int64.from_address(array + 8 * place)
        try:
            word.value = self.address(place)
        except KeyboardInterrupt:
            pass
        except BaseException:
            word.value = NOT_FOUND
            logging.getLogger("dt3d").exception("the function at %d could not be compiled", place)


def call_at(
    array: types.Array, place: int, returned: types.Type, functions: Functions
) -> tuple[Signature, Callable[..., ir.Value]]:
    """What an intrinsic returns that calls the function at a place.

    The first argument of the intrinsic is the array, of float64, of one dimension and in C order, in which
    the 64 bits of the addresses are (`Functions.write`). The others are those of the function.
    """
    kinds = functions.kinds(place)

    def codegen(
        context: BaseContext, builder: ir.IRBuilder, signature: Signature, values: Sequence[ir.Value]
    ) -> ir.Value:
        raises = context.call_conv.return_user_exc
        integer = ir.IntType(64)
        holder = context.make_array(array)(context, builder, values[0])
        words = builder.bitcast(holder.data, integer.as_pointer())

        def word(k: int) -> ir.Value:
            return builder.load(builder.gep(words, [ir.Constant(integer, k)]))

        def is_(value: ir.Value, number: int) -> ir.Value:
            return builder.icmp_signed("==", value, ir.Constant(integer, number))

        known = word(place)
        begin = builder.basic_block
        missing = builder.icmp_signed("<=", known, ir.Constant(integer, 0))  # or `NOT_FOUND` before
        with cgutils.if_unlikely(builder, missing):
            finder = word(functions.finder)
            with cgutils.if_unlikely(builder, is_(finder, 0)):
                raises(builder, InternalError, (f"there is no address at {place}",))
            kind = ir.FunctionType(ir.VoidType(), [integer.as_pointer(), integer]).as_pointer()
            builder.call(builder.inttoptr(finder, kind), [words, ir.Constant(integer, place)])
            found = word(place)
            with cgutils.if_unlikely(builder, is_(found, 0)):
                raises(builder, KeyboardInterrupt, ())
            with cgutils.if_unlikely(builder, is_(found, NOT_FOUND)):
                raises(builder, InternalError, (f"the function at {place} could not be compiled",))
            end = builder.basic_block
        address = builder.phi(integer)
        address.add_incoming(known, begin)
        address.add_incoming(found, end)
        function = builder.inttoptr(
            address, context.call_conv.get_function_type(returned, kinds).as_pointer()
        )
        given = [
            context.cast(builder, value, has, takes)
            for value, has, takes in zip(values[1:], signature.args[1:], kinds, strict=True)
        ]
        status, result = context.call_conv.call_function(builder, function, returned, kinds, given)
        with cgutils.if_unlikely(builder, status.is_error):
            context.call_conv.return_status_propagate(builder, status)
        return result

    return returned(array, *kinds), codegen
