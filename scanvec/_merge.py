"""Two records become one by flags: select takes the same place of either, flag_merge the next of either."""

from __future__ import annotations

from typing import Any

from . import _local
from ._checks import check_flags
from ._composed import composed
from ._monoid import ADD
from ._records import length_of, machine_of, structure_of, vectors_of
from ._scan import scan_inclusive
from ._vector import Vector


def select(flags: Vector, first: Any, second: Any) -> Any:
    """r[i] = v[i] where flags[i], else w[i]. One step, n elements.

    `p-select` of Blelloch 1990, chapter 4. Records must be of one structure and have the same dtypes.

    Raises
    ------
    ValueError
        If lengths, machines, structures or dtypes differ.
    TypeError
        If the flags are not booleans.
    """
    check_flags(flags, "select: the flags")
    _check_one_kind("select", first, second)
    return machine_of(first).map(_local.select, flags, first, second)


@composed
def flag_merge(first: Any, second: Any, flags: Vector) -> Any:
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
    _check_one_kind("flag_merge", first, second)
    machine, n = flags.machine, len(flags)
    ups = scan_inclusive(flags, ADD)
    found = int(machine.item(ups, -1)) if n else 0
    if found != length_of(second) or n - found != length_of(first):
        msg = (
            f"flag_merge: {n - found} flags are clear and {found} set, but there are {length_of(first)} and "
            f"{length_of(second)} elements to merge; give a clear flag for each element of the first record, "
            f"and a set one for each of the second"
        )
        raise ValueError(msg)
    clear, from_first, from_second = machine.map(_sources, flags, ups, machine.iota(n))
    return select(
        flags,
        machine.get(second, from_second, where=flags),
        machine.get(first, from_first, where=clear),
    )


def _sources(flag: Any, ups: Any, i: Any) -> tuple[Any, Any, Any]:
    return ~flag, i - ups, ups - 1


def _check_one_kind(what: str, first: Any, second: Any) -> None:
    if structure_of(first) != structure_of(second):
        msg = f"{what}: the two records have different structures"
        raise ValueError(msg)
    if [v.dtype for v in vectors_of(first)] != [v.dtype for v in vectors_of(second)]:
        msg = f"{what}: the two records have different dtypes; convert with astype"
        raise ValueError(msg)
