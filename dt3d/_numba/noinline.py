"""Calls that stay calls: rarely needed compiled code that must not be inlined into the code around it.

LLVM inlines an exact stage into each of the many places where a predicate is used. What is executed there,
the filter, then loses its registers to it, and counts references of arrays that only the exact stage needs;
threads that count references of one array wait for each other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from llvmlite import ir
from numba.core import types
from numba.core.base import BaseContext
from numba.core.dispatcher import Dispatcher
from numba.core.typing import Context
from numba.core.typing.templates import Signature


def call_noinline(
    typingctx: Context, function: Dispatcher, kinds: tuple[types.Type, ...]
) -> tuple[Signature, Callable[..., ir.Value]]:
    """Return what an intrinsic returns that calls ``function``, with arguments of these types, never inlined.

    >>> import numba
    >>> from numba.extending import intrinsic
    >>> @numba.njit
    ... def seldom(x):
    ...     return x + 1
    >>> @intrinsic
    ... def call_seldom(typingctx, x):
    ...     return call_noinline(typingctx, seldom, (x,))
    >>> @numba.njit
    ... def often(x):
    ...     return x if x > 0 else call_seldom(x)
    >>> often(-3)
    -2
    """
    kind = typingctx.resolve_value_type(function)
    inner = kind.get_call_type(typingctx, tuple(map(_widened, kinds)), {})

    def codegen(
        context: BaseContext, builder: ir.IRBuilder, signature: Signature, values: Sequence[ir.Value]
    ) -> ir.Value:
        implementation = context.get_function(kind, inner)
        context.add_linking_libs(getattr(implementation, "libs", ()))
        words = [context.cast(builder, v, t, u) for v, t, u in zip(values, kinds, inner.args, strict=True)]
        before = {id(i) for block in builder.function.blocks for i in block.instructions}
        result = implementation(builder, words)
        for block in builder.function.blocks:
            for made in block.instructions:
                if id(made) not in before and isinstance(made, ir.CallInstr):
                    made.attributes.add("noinline")
        return result

    return inner.return_type(*kinds), codegen


def _widened(kind: types.Type) -> types.Type:
    """Return 64 bits for indices of all widths, also in tuples, so that one copy of the code serves them."""
    if isinstance(kind, types.Integer):
        return types.int64
    return types.Tuple([_widened(k) for k in kind]) if isinstance(kind, types.BaseTuple) else kind
