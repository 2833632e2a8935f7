"""Two records become one by flags: where takes the same place of either, flag_merge the next of either."""

from __future__ import annotations

from typing import overload

import jax
import jax.numpy as jnp

from .._checks import check_flags
from .._deprecated import old_keywords
from .._monoid import ADD
from .._records import R, check_one_kind, each, has_vectors, length_of
from .._vector import Scalar, Vector
from .composed import composed
from .scan import scan_inclusive


@overload
def where(flags: Vector, v: Scalar, w: Scalar) -> Vector: ...
@overload
def where(flags: Vector, v: Scalar, w: R) -> R: ...
@overload
def where(flags: Vector, v: R, w: R | Scalar) -> R: ...
@old_keywords
def where(flags: Vector, v: object, w: object) -> object:
    """r[i] = v[i] where flags[i], else w[i]. One step, n elements.

    ``p-select`` of Blelloch 1990, chapter 4. Records must be of one structure and have the same dtypes. A
    scalar in place of either stands for all its elements, and takes the dtype of the other as in NumPy.

    Raises
    ------
    ValueError
        If lengths, machines, structures or dtypes differ.
    TypeError
        If the flags are not booleans.

    Examples
    --------
    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.where(v > 3, v, 0)
    Vector([5 0 0 4], dtype=int64, Device())
    """
    check_flags(flags, "where: the flags")
    if has_vectors(v) and has_vectors(w):
        check_one_kind("where", v, w)
    return flags.machine.map(_choose, flags, v, w)


def _choose(flag: jax.Array, v: object, w: object) -> object:
    if jax.tree_util.all_leaves([v]):  # a scalar goes to all leaves
        v = jax.tree.map(lambda _: v, w)
    elif jax.tree_util.all_leaves([w]):
        w = jax.tree.map(lambda _: w, v)
    return each(lambda x, y: jnp.where(flag, x, y), v, w)


@old_keywords
@composed
def flag_merge(v: R, w: R, flags: Vector) -> R:
    """r takes the next element of w where its flag is set, of v where not; `split` undone. Seven steps.

    Over len(v) + len(w) elements, as many as flags. Blelloch 1990, chapter 3: the step of the halving merge.

    Raises
    ------
    ValueError
        If as many flags are not set as w has elements, or clear as v has; or if machines, structures or
        dtypes differ.
    TypeError
        If the flags are not booleans.

    Examples
    --------
    >>> import scanvec as sv
    >>> v, w, flags = map(sv.Device().vector, ([5, 1], [3], [False, True, False]))
    >>> sv.flag_merge(v, w, flags)
    Vector([5 3 1], dtype=int64, Device())
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


def _sources(flag: jax.Array, ups: jax.Array, i: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
    return ~flag, i - ups, ups - 1
