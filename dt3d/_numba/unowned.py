"""Arrays without an owner, for compiled kernels.

numba counts the references of every array that goes from one compiled function to another, with an atomic
addition and subtraction each. They cost more than a filtered predicate does, and threads that share an array
wait for each other's. An unowned array has no count.
"""

from __future__ import annotations

from numba.core import cgutils, types
from numba.core.errors import TypingError
from numba.extending import intrinsic


@intrinsic
def unowned(typingctx, array):
    """Return the same array without an owner; the caller sees to it that the owner outlives it."""
    if not isinstance(array, types.Array):
        msg = f"only arrays have owners, got {array}"
        raise TypingError(msg)

    def codegen(context, builder, signature, args):
        view = context.make_array(array)(context, builder, args[0])
        view.meminfo = cgutils.get_null_value(view.meminfo.type)
        view.parent = cgutils.get_null_value(view.parent.type)
        return view._getvalue()

    return array(array), codegen
