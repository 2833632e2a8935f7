"""Atomic words for compiled threads: load, store, add, compare-and-swap, and giving way.

A plain read of an array in a loop may be hoisted out of it by LLVM, and a plain write moved past another;
words that threads share are only touched through these. They are LLVM's own atomics, sequentially consistent
unless their names say otherwise, on elements of NumPy arrays of 32- or 64-bit integers. Indices are not
checked, and negative ones do not wrap around.
"""

from __future__ import annotations

import ctypes
import sys
from typing import Any

import numpy as np
import numpy.typing as npt
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.base import BaseContext
from numba.core.errors import TypingError
from numba.extending import intrinsic

from .kernel_cache import cached_njit

PAIR_OF_LINES = 128  # bytes


def element(
    context: BaseContext, builder: ir.IRBuilder, array_type: types.Array, array: ir.Value,
    index_type: types.Type, index: ir.Value,
) -> ir.Value:  # fmt: skip
    """Return a pointer to one element of an array; the index is an integer or a tuple of integers."""
    parts = _parts(index_type)
    values = cgutils.unpack_tuple(builder, index) if isinstance(index_type, types.BaseTuple) else [index]
    words = [context.cast(builder, v, t, types.intp) for v, t in zip(values, parts, strict=True)]
    native = context.make_array(array_type)(context, builder, array)
    return cgutils.get_item_pointer(context, builder, array_type, native, words, wraparound=False)


def _parts(index_type: types.Type) -> tuple[types.Type, ...]:
    """The types of an index, one for each dimension."""
    return tuple(getattr(index_type, "types", (index_type,)))


def _check(array: types.Type, index: types.Type) -> None:
    """Refuse at compile time what has no atomic word."""
    parts = len(_parts(index))
    if not (
        isinstance(array, types.Array) and isinstance(array.dtype, types.Integer) and parts == array.ndim
    ):
        msg = f"atomics work on single elements of integer arrays, got {array} at {index}"
        raise TypingError(msg)


def _bytes(array: types.Array) -> int:
    return int(array.dtype.bitwidth) // 8


def _loader(ordering: str) -> Any:
    @intrinsic
    def load(typingctx, array, index):
        _check(array, index)

        def codegen(context, builder, signature, args):
            pointer = element(context, builder, array, args[0], index, args[1])
            return builder.load_atomic(pointer, ordering, _bytes(array))

        return array.dtype(array, index), codegen

    return load


def _storer(ordering: str) -> Any:
    @intrinsic
    def store(typingctx, array, index, value):
        _check(array, index)

        def codegen(context, builder, signature, args):
            pointer = element(context, builder, array, args[0], index, args[1])
            word = context.cast(builder, args[2], value, array.dtype)
            builder.store_atomic(word, pointer, ordering, _bytes(array))
            return context.get_dummy_value()

        return types.void(array, index, value), codegen

    return store


def _modifier(operation: str) -> Any:
    @intrinsic
    def modify(typingctx, array, index, value):
        _check(array, index)

        def codegen(context, builder, signature, args):
            pointer = element(context, builder, array, args[0], index, args[1])
            word = context.cast(builder, args[2], value, array.dtype)
            return builder.atomic_rmw(operation, pointer, word, "seq_cst")

        return array.dtype(array, index, value), codegen

    return modify


load = _loader("seq_cst")
"""load(array, index): the element, in the one order in which all threads see these operations."""
load_acquire = _loader("acquire")
"""The element; what its writer wrote before a releasing store is visible after it. A plain move on x86."""
store = _storer("seq_cst")
"""store(array, index, value), visible to all before anything that follows in the program."""
store_release = _storer("release")
"""store(array, index, value), after all that precedes it. A plain move on x86."""
add = _modifier("add")
"""add(array, index, value): adds, and returns what was there before."""


@intrinsic
def compare_and_swap(typingctx, array, index, expected, value):
    """Put value where expected is; returns whether it was."""
    _check(array, index)

    def codegen(context, builder, signature, args):
        pointer = element(context, builder, array, args[0], index, args[1])
        old = context.cast(builder, args[2], expected, array.dtype)
        new = context.cast(builder, args[3], value, array.dtype)
        pair = builder.cmpxchg(pointer, old, new, ordering="seq_cst", failordering="seq_cst")
        return builder.extract_value(pair, 1)

    return types.boolean(array, index, expected, value), codegen


@intrinsic
def cycles(typingctx):
    """The processor's cycle counter, int64; one reading costs some 10 ns."""

    def codegen(context, builder, signature, args):
        kind = ir.FunctionType(ir.IntType(64), [])
        return builder.call(cgutils.get_or_insert_function(builder.module, kind, "llvm.readcyclecounter"), [])

    return types.int64(), codegen


if sys.platform == "win32":
    # numba resolves symbols by their names in the process
    _YIELD, _SLEEP, _NAP = "SwitchToThread", "Sleep", 0
    ctypes.windll.kernel32.Sleep(0)
else:
    _YIELD, _SLEEP, _NAP = "sched_yield", "usleep", 30

give_way = types.ExternalFunction(_YIELD, types.int32())
"""give_way(): lets another thread have the processor."""
_sleep = types.ExternalFunction(_SLEEP, types.int32(types.uint32))


@cached_njit
def nap():
    """Sleep for some 30 microseconds."""
    _sleep(np.uint32(_NAP))


TURNS = 64


@cached_njit
def wait_a_little(turn):
    """Give way; from the `TURNS`-th turn in a row on, sleep for some 30 microseconds per turn.

    Short waits end while a thread gives way. In long ones, of several threads for one, giving way takes more
    time from the thread that is waited for than the wait is worth.
    """
    if turn < TURNS:
        give_way()
    else:
        nap()


@cached_njit
def acquire(words, at, me):
    """Take the lock words[at], which is 0 when free; ``me`` is not 0. Returns whether it is taken.

    It is tried `TURNS` times. After that the caller has to see whether all threads have to stop.
    """
    for _ in range(TURNS):
        if compare_and_swap(words, at, 0, me):
            return True
        give_way()
    return False


@cached_njit
def release(words, at):
    """Give the lock back."""
    store_release(words, at, 0)


def padded(n: int) -> np.ndarray:
    """Return n words, int64 (n, 16), of which only column 0 is used: each has two cache lines of its own."""
    return rows_apart(n, 1)


def rows_apart(n: int, columns: int, dtype: npt.DTypeLike = np.int64) -> np.ndarray:
    """Return zeros, n rows of ``columns`` entries or a few more, for threads that write to one row each.

    No two rows are in one pair of cache lines: a processor that writes to a line takes it from all others,
    and fetches lines in pairs. Only what is used gets memory.
    """
    item = np.dtype(dtype).itemsize
    columns = -(-columns * item // PAIR_OF_LINES) * PAIR_OF_LINES // item
    words = np.zeros(n * columns + PAIR_OF_LINES // item, dtype)
    skipped = -words.ctypes.data % PAIR_OF_LINES // item
    return words[skipped : skipped + n * columns].reshape(n, columns)
