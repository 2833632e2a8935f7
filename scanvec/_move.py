"""Moving elements: permute, get, send, pack, split, append, distribute. Written once for every machine."""

from __future__ import annotations

from typing import Any

import jax

from . import _local
from ._checks import check_flags
from ._composed import composed
from ._monoid import ADD, COPY, Monoid
from ._records import check_alike, is_vector, length_of, machine_of, structure_of, vectors_of
from ._scan import backscan_inclusive, scan_inclusive
from ._segments import Segments
from ._vector import Vector


def get(record: Any, index: Vector, *, where: Vector | None = None, otherwise: Any = 0) -> Any:
    """Concurrent read: r[i] = v[index[i]] where where[i], else ``otherwise``. One step, len(index) elements.

    Raises IndexError where an index in the context is out of range.
    """
    return machine_of(record).get(record, index, where=where, otherwise=otherwise)


def send(record: Any, index: Vector, op: Monoid, into: Any, *, where: Vector | None = None) -> Any:
    """Concurrent write: ``into``, with op(r[index[i]], v[i]) for every i in the context.

    With COPY the sender of lowest index replaces. One step. Raises IndexError where an index is out of range.
    """
    return machine_of(record).send(record, index, op, into, where=where)


@composed
def permute(record: Any, index: Vector, *, into: Any = None, where: Vector | None = None) -> Any:
    """Exclusive write: r[index[i]] = v[i]. One step, n elements.

    Without ``into``, ``index`` must be a permutation of 0 .. n-1. With ``into``, a record of any length, its
    elements stay where nothing is sent.

    Raises
    ------
    ValueError
        If two elements are sent to one position, or a context is given without ``into``.
    IndexError
        If an index is out of range.
    """
    if into is None:
        if where is not None:
            msg = "permute under a context needs `into`: what stays where nothing is sent"
            raise ValueError(msg)
        into = _blank(record, length_of(record))
    return machine_of(record).send(record, index, _local.UNIQUE, into, where=where)


def _blank(record: Any, n: int) -> Any:
    return jax.tree.map(lambda v: v.machine.full(n, 0, v.dtype), record, is_leaf=is_vector)


@composed
def pack(record: Any, flags: Vector) -> Any:
    """The elements whose flag is set, in order. Four steps, n elements."""
    ends = _count(flags)
    kept = int(flags.machine.item(ends, -1)) if len(flags) else 0
    return machine_of(record).send(record, ends - 1, _local.UNIQUE, _blank(record, kept), where=flags)


def _count(flags: Vector) -> Vector:
    """r[i] = flags set in v[0], ..., v[i]."""
    check_flags(flags, "the flags")
    return flags.machine.scan(flags, ADD, exclusive=False)


@composed
def pack_index(flags: Vector) -> Vector:
    """The indices at which the flag is set, in order, int32. Five steps, n elements."""
    return pack(flags.machine.iota(len(flags)), flags)


@composed
def split(record: Any, flags: Vector, segments: Segments | None = None) -> Any:
    """The elements whose flag is clear, in order, then those whose flag is set. Five steps, n elements.

    With segments each is split by itself, in seven steps. Blelloch 1990, section 3.4.1: the step of the radix
    sort; by segments, of quicksort.
    """
    n = length_of(record)
    if not n:
        return record
    machine = machine_of(record)
    if segments is None:
        ups = _count(flags)
        clear = n - int(machine.item(ups, -1))
        target = machine.map(_split_target, flags, ups, machine.iota(n), clear)
    else:
        target = _segmented_split_target(flags, segments)
    return machine.send(record, target, _local.UNIQUE, _blank(record, n))


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


@composed
def append(first: Any, second: Any) -> Any:
    """r = v, then w: two records of one structure and dtypes. Five steps, len(v) + len(w) elements.

    Raises
    ------
    ValueError
        If structures, dtypes or machines differ.
    """
    n, m = length_of(first), length_of(second)
    machine = machine_of(first)
    if machine_of(second) is not machine:
        check_alike([*vectors_of(first), *vectors_of(second)])
    if structure_of(first) != structure_of(second):
        msg = "append: the two records have different structures"
        raise ValueError(msg)
    if [v.dtype for v in vectors_of(first)] != [v.dtype for v in vectors_of(second)]:
        msg = "append: the two records have different dtypes; convert with astype"
        raise ValueError(msg)
    longer = _blank(first, n + m)
    if n:
        longer = machine.send(first, machine.iota(n), _local.UNIQUE, longer)
    if m:
        longer = machine.send(second, machine.iota(m) + n, _local.UNIQUE, longer)
    return longer


@composed
def distribute(record: Any, counts: Vector) -> tuple[Any, Segments]:
    """counts[i] copies of v[i], for i = 0, 1, ...; and the segments that the copies of one element form.

    Blelloch 1990, section 3.6 (allocation). Twelve steps, over n and sum(counts) elements.

    Raises
    ------
    ValueError
        If a count is negative, there is not one for each element, or they add up to more than 2^31 - 1.
    """
    if len(counts) != length_of(record):
        msg = f"distribute: {length_of(record)} elements, but {len(counts)} counts"
        raise ValueError(msg)
    segments = Segments.from_lengths(counts)
    return machine_of(record).get(record, segments.ids), segments
