"""Moving elements: get, send, scatter, permute, pack, split, append, distribute; once for every machine."""

from __future__ import annotations

from typing import Any

import jax

from . import _local
from ._checks import check_flags
from ._composed import composed
from ._deprecated import into_by_position, old_keywords, writes_as, zero_otherwise
from ._monoid import ADD, COPY, Monoid
from ._records import check_alike, is_vector, length_of, machine_of, structure_of, vectors_of
from ._scan import backscan_inclusive, scan_inclusive
from ._segments import Segments
from ._vector import Vector


def full_like(v: Any, value: Any, dtype: Any = None) -> Any:
    """r[i] = ``value``, as many elements as v has, on its machine. No step.

    A record gives a record like it. The elements have the dtypes of v, or ``dtype``.
    """
    return jax.tree.map(
        lambda x: x.machine.full(len(x), value, x.dtype if dtype is None else dtype), v, is_leaf=is_vector
    )


@zero_otherwise
@old_keywords
def get(v: Any, index: Vector, *, where: Vector | None = None, otherwise: Any = None) -> Any:
    """Concurrent read: r[i] = v[index[i]] where where[i], else ``otherwise``. One step, len(index) elements.

    ``otherwise``, a scalar, is required with ``where``. Raises IndexError where an index in the context is
    out of range.
    """
    return machine_of(v).get(v, index, where=where, otherwise=otherwise)


@into_by_position
@old_keywords
def send(v: Any, index: Vector, op: Monoid, *, into: Any, where: Vector | None = None) -> Any:
    """Concurrent write: ``into``, with op(r[index[i]], v[i]) for every i in the context.

    With COPY the sender of lowest index replaces. One step. Raises IndexError where an index is out of range.
    """
    return machine_of(v).send(v, index, op, into=into, where=where)


@old_keywords
@composed
def scatter(v: Any, index: Vector, *, into: Any, where: Vector | None = None) -> Any:
    """Exclusive write: ``into``, with r[index[i]] = v[i] for every i in the context. One step.

    Over max(len(v), len(into)) elements. `send` is the write of several elements to one position.

    Raises
    ------
    ValueError
        If two elements are sent to one position, or v and ``into`` differ in structure or dtypes.
    IndexError
        If an index in the context is out of range.
    """
    return machine_of(v).send(v, index, _local.UNIQUE, into=into, where=where, what="scatter")


@writes_as(scatter)
@old_keywords
@composed
def permute(v: Any, index: Vector) -> Any:
    """Exclusive write: r[index[i]] = v[i], with a permutation of 0 .. n-1. One step, n elements.

    Raises
    ------
    ValueError
        If two elements are sent to one position.
    IndexError
        If an index is out of range.
    """
    return machine_of(v).send(v, index, _local.UNIQUE, into=_blank(v, length_of(v)), what="permute")


def _blank(v: Any, n: int) -> Any:
    return jax.tree.map(lambda x: x.machine.full(n, 0, x.dtype), v, is_leaf=is_vector)


@old_keywords
@composed
def pack(v: Any, flags: Vector) -> Any:
    """The elements whose flag is set, in order. Four steps, n elements."""
    ends = _count(flags)
    kept = int(flags.machine.item(ends, -1)) if len(flags) else 0
    return machine_of(v).send(v, ends - 1, _local.UNIQUE, into=_blank(v, kept), where=flags)


def _count(flags: Vector) -> Vector:
    """r[i] = flags set in v[0], ..., v[i]."""
    check_flags(flags, "the flags")
    return flags.machine.scan(flags, ADD, exclusive=False)


@composed
def pack_index(flags: Vector) -> Vector:
    """The indices at which the flag is set, in order, int32. Five steps, n elements."""
    return pack(flags.machine.iota(len(flags)), flags)


@old_keywords
@composed
def split(v: Any, flags: Vector, segments: Segments | None = None) -> Any:
    """The elements whose flag is clear, in order, then those whose flag is set. Five steps, n elements.

    With segments each is split by itself, in seven steps. Blelloch 1990, section 3.4.1: the step of the radix
    sort; by segments, of quicksort.
    """
    n = length_of(v)
    if not n:
        return v
    machine = machine_of(v)
    if segments is None:
        ups = _count(flags)
        clear = n - int(machine.item(ups, -1))
        target = machine.map(_split_target, flags, ups, machine.iota(n), clear)
    else:
        target = _segmented_split_target(flags, segments)
    return machine.send(v, target, _local.UNIQUE, into=_blank(v, n))


def _split_target(flag: Any, ups: Any, i: Any, clear: Any) -> Any:
    return jax.numpy.where(flag, clear + ups - 1, i - ups)


def _segmented_split_target(flags: Vector, segments: Segments) -> Vector:
    check_flags(flags, "the flags")
    machine = flags.machine
    ups = scan_inclusive(flags, ADD, segments)
    total = backscan_inclusive(ups, COPY, segments)
    start, length = machine.get((segments.starts, segments.lengths), segments.ids)
    return machine.map(_target_in_segment, flags, ups, machine.iota(len(flags)), total, start, length)


def _target_in_segment(flag: Any, ups: Any, i: Any, total: Any, start: Any, length: Any) -> Any:
    return start + _split_target(flag, ups, i - start, length - total)


@old_keywords
@composed
def append(v: Any, w: Any) -> Any:
    """r = v, then w: two records of one structure and dtypes. Five steps, len(v) + len(w) elements.

    Raises
    ------
    ValueError
        If structures, dtypes or machines differ.
    """
    n, m = length_of(v), length_of(w)
    machine = machine_of(v)
    if machine_of(w) is not machine:
        check_alike([*vectors_of(v), *vectors_of(w)])
    check_one_kind("append", v, w)
    longer = _blank(v, n + m)
    if n:
        longer = machine.send(v, machine.iota(n), _local.UNIQUE, into=longer)
    if m:
        longer = machine.send(w, machine.iota(m) + n, _local.UNIQUE, into=longer)
    return longer


def check_one_kind(what: str, v: Any, w: Any) -> None:
    """Raise ValueError unless the two records have one structure and the same dtypes."""
    if structure_of(v) != structure_of(w):
        msg = f"{what}: the two records have different structures"
        raise ValueError(msg)
    if [x.dtype for x in vectors_of(v)] != [x.dtype for x in vectors_of(w)]:
        msg = f"{what}: the two records have different dtypes; convert with astype"
        raise ValueError(msg)


@old_keywords
@composed
def distribute(v: Any, counts: Vector) -> tuple[Any, Segments]:
    """counts[i] copies of v[i], for i = 0, 1, ...; and the segments that the copies of one element form.

    Blelloch 1990, section 3.6 (allocation). Twelve steps, over n and sum(counts) elements.

    Raises
    ------
    ValueError
        If a count is negative, there is not one for each element, or they add up to more than 2^31 - 1.
    """
    if len(counts) != length_of(v):
        msg = f"distribute: {length_of(v)} elements, but {len(counts)} counts"
        raise ValueError(msg)
    segments = Segments.from_lengths(counts)
    return machine_of(v).get(v, segments.ids), segments
