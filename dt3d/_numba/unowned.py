"""Arrays without an owner, for compiled kernels.

numba counts the references of every array that goes from one compiled function to another, with an atomic
addition and subtraction each. They cost more than a filtered predicate does, and threads that share an array
wait for each other's. An unowned array has no count.
"""

from __future__ import annotations

from llvmlite import ir
from numba.core import cgutils, types
from numba.core.base import BaseContext
from numba.core.errors import TypingError
from numba.extending import intrinsic


@intrinsic
def unowned(typingctx, array):
    """Return the same array, or tuple with arrays in it, without an owner.

    The caller sees to it that the owner outlives it.
    """
    if not isinstance(array, types.Array | types.BaseTuple):
        msg = f"only arrays and tuples of them have owners, got {array}"
        raise TypingError(msg)

    def codegen(context, builder, signature, args):
        return _without_owner(context, builder, array, args[0])

    return array(array), codegen


def _without_owner(
    context: BaseContext, builder: ir.IRBuilder, kind: types.Type, value: ir.Value
) -> ir.Value:
    if isinstance(kind, types.BaseTuple):
        for i, part in enumerate(kind):
            inner = _without_owner(context, builder, part, builder.extract_value(value, i))
            value = builder.insert_value(value, inner, i)
        return value
    if not isinstance(kind, types.Array):
        return value
    view = context.make_array(kind)(context, builder, value)
    view.meminfo = cgutils.get_null_value(view.meminfo.type)
    view.parent = cgutils.get_null_value(view.parent.type)
    return view._getvalue()
