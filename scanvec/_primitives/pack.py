"""Making vectors of other lengths: pack, split, append, distribute."""

from __future__ import annotations

import jax
import jax.numpy as jnp

from .._checks import check_flags
from .._deprecated import old_keywords
from .._monoid import ADD, COPY, UNIQUE
from .._records import R, check_alike, check_one_kind, each, length_of, machine_of, vectors_of
from .._segments import Segments
from .._vector import Vector
from .composed import composed
from .scan import backscan_inclusive, scan_inclusive


@old_keywords
@composed
def pack(v: R, flags: Vector) -> R:
    """The elements whose flag is set, in order. Four steps, n elements.

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.pack(v, v > 2)
    Vector([5 3 4], dtype=int64, Device())
    """
    ends = _count(flags)
    kept = int(flags.machine.item(ends, -1)) if len(flags) else 0
    return machine_of(v).send(v, ends - 1, UNIQUE, into=_blank(v, kept), where=flags)


def _count(flags: Vector) -> Vector:
    """r[i] = flags set in v[0], ..., v[i]."""
    check_flags(flags, "the flags")
    return flags.machine.scan(flags, ADD, exclusive=False)


def _blank(v: R, n: int) -> R:
    return each(lambda x: x.machine.full(n, 0, x.dtype), v)


@composed
def pack_index(flags: Vector) -> Vector:
    """The indices at which the flag is set, in order, int32. Five steps, n elements.

    >>> import scanvec as sv
    >>> sv.pack_index(sv.Device().vector([5, 1, 3, 4]) > 2)
    Vector([0 2 3], dtype=int32, Device())
    """
    return pack(flags.machine.iota(len(flags)), flags)


@old_keywords
@composed
def split(v: R, flags: Vector, segments: Segments | None = None) -> R:
    """The elements whose flag is clear, in order, then those whose flag is set. Five steps, n elements.

    With segments each is split by itself, in seven steps. Blelloch 1990, section 3.4.1: the step of the radix
    sort; by segments, of quicksort.

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.split(v, v > 3)
    Vector([1 3 5 4], dtype=int64, Device())
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
    return machine.send(v, target, UNIQUE, into=_blank(v, n))


def _split_target(flag: jax.Array, ups: jax.Array, i: jax.Array, clear: jax.Array) -> jax.Array:
    return jnp.where(flag, clear + ups - 1, i - ups)


def _segmented_split_target(flags: Vector, segments: Segments) -> Vector:
    check_flags(flags, "the flags")
    machine = flags.machine
    ups = scan_inclusive(flags, ADD, segments)
    total = backscan_inclusive(ups, COPY, segments)
    start, length = machine.get((segments.starts, segments.lengths), segments.ids)
    index = machine.iota(len(flags))
    target: Vector = machine.map(_target_in_segment, flags, ups, index, total, start, length)
    return target


def _target_in_segment(
    flag: jax.Array, ups: jax.Array, i: jax.Array, total: jax.Array, start: jax.Array, length: jax.Array
) -> jax.Array:
    return start + _split_target(flag, ups, i - start, length - total)


@old_keywords
@composed
def append(v: R, w: R) -> R:
    """r = v, then w: two records of one structure and dtypes. Five steps, len(v) + len(w) elements.

    Raises
    ------
    ValueError
        If structures, dtypes or machines differ.

    Examples
    --------
    >>> import scanvec as sv
    >>> sv.append(*map(sv.Device().vector, ([5, 1], [3])))
    Vector([5 1 3], dtype=int64, Device())
    """
    n, m = length_of(v), length_of(w)
    machine = machine_of(v)
    if machine_of(w) is not machine:
        check_alike([*vectors_of(v), *vectors_of(w)])
    check_one_kind("append", v, w)
    longer = _blank(v, n + m)
    if n:
        longer = machine.send(v, machine.iota(n), UNIQUE, into=longer)
    if m:
        longer = machine.send(w, machine.iota(m) + n, UNIQUE, into=longer)
    return longer


@old_keywords
@composed
def distribute(v: R, counts: Vector) -> tuple[R, Segments]:
    """counts[i] copies of v[i], for i = 0, 1, ...; and the segments that the copies of one element form.

    Blelloch 1990, section 3.6 (allocation). Twelve steps, over n and sum(counts) elements.

    Raises
    ------
    ValueError
        If a count is negative, there is not one for each element, or they add up to more than 2^31 - 1.

    Examples
    --------
    >>> import scanvec as sv
    >>> v, counts = map(sv.Device().vector, ([5, 1, 3], [2, 0, 1]))
    >>> copies, segments = sv.distribute(v, counts)
    >>> copies
    Vector([5 5 3], dtype=int64, Device())
    >>> segments.ids
    Vector([0 0 2], dtype=int32, Device())
    """
    if len(counts) != length_of(v):
        msg = f"distribute: {length_of(v)} elements, but {len(counts)} counts"
        raise ValueError(msg)
    segments = Segments.from_lengths(counts)
    return machine_of(v).get(v, segments.ids), segments
