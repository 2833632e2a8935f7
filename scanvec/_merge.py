"""Two records become one by flags: where takes the same place of either, flag_merge the next of either."""

from __future__ import annotations

from typing import Any

import jax
import jax.numpy as jnp

from ._checks import check_flags
from ._composed import composed
from ._deprecated import old_keywords
from ._monoid import ADD
from ._move import check_one_kind
from ._records import has_vectors, length_of
from ._scan import scan_inclusive
from ._vector import Vector


@old_keywords
def where(flags: Vector, v: Any, w: Any) -> Any:
    """r[i] = v[i] where flags[i], else w[i]. One step, n elements.

    `p-select` of Blelloch 1990, chapter 4. Records must be of one structure and have the same dtypes. A
    scalar in place of either stands for all its elements, and takes the dtype of the other as in NumPy.

    Raises
    ------
    ValueError
        If lengths, machines, structures or dtypes differ.
    TypeError
        If the flags are not booleans.
    """
    check_flags(flags, "where: the flags")
    if has_vectors(v) and has_vectors(w):
        check_one_kind("where", v, w)
    return flags.machine.map(_choose, flags, v, w)


def _choose(flag: Any, v: Any, w: Any) -> Any:
    if jax.tree_util.all_leaves([v]):
        return jax.tree.map(lambda y: jnp.where(flag, v, y), w)
    if jax.tree_util.all_leaves([w]):
        return jax.tree.map(lambda x: jnp.where(flag, x, w), v)
    return jax.tree.map(lambda x, y: jnp.where(flag, x, y), v, w)


@old_keywords
@composed
def flag_merge(v: Any, w: Any, flags: Vector) -> Any:
    """r takes the next element of w where its flag is set, of v where not; `split` undone. Seven steps.

    Over len(v) + len(w) elements, as many as flags. Blelloch 1990, chapter 3: the step of the halving merge.

    Raises
    ------
    ValueError
        If as many flags are not set as w has elements, or clear as v has; or if machines, structures or
        dtypes differ.
    TypeError
        If the flags are not booleans.
    """
    check_flags(flags, "flag_merge: the flags")
    check_one_kind("flag_merge", v, w)
    machine, n = flags.machine, len(flags)
    ups = scan_inclusive(flags, ADD)
    found = int(machine.item(ups, -1)) if n else 0
    if found != length_of(w) or n - found != length_of(v):
        msg = (
            f"flag_merge: {n - found} flags are clear and {found} set, but there are {length_of(v)} and "
            f"{length_of(w)} elements to merge; give a clear flag for each element of the first record, "
            f"and a set one for each of the second"
        )
        raise ValueError(msg)
    clear, from_v, from_w = machine.map(_sources, flags, ups, machine.iota(n))
    return where(
        flags,
        machine.get(w, from_w, where=flags, otherwise=0),
        machine.get(v, from_v, where=clear, otherwise=0),
    )


def _sources(flag: Any, ups: Any, i: Any) -> tuple[Any, Any, Any]:
    return ~flag, i - ups, ups - 1
