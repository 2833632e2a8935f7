"""Scans and reductions, plain and segmented, written once for every machine.

Blelloch 1990, chapter 3; segmented forms restart at the first element of each segment.
"""

from __future__ import annotations

from typing import Any, overload

import jax
import numpy as np

from .._checks import check_flags
from .._deprecated import old_keywords
from .._monoid import ADD, COPY, MUL, Monoid
from .._records import R, each, length_of, machine_of, vectors_of
from .._segments import Segments
from .._vector import Vector
from .composed import composed


def _heads(segments: Segments | None, v: object) -> Vector | None:
    if segments is None:
        return None
    n = length_of(v)
    if len(segments.heads) != n:
        msg = f"the segments describe {len(segments.heads)} elements, the vector has {n}"
        raise ValueError(msg)
    return segments.heads


@old_keywords
@composed
def scan(v: R, op: Monoid, segments: Segments | None = None) -> R:
    """r[i] = op(v[s], ..., v[i-1]), the identity at i = s, the start of i's segment (0 without segments).

    One scan step, n elements; booleans are added and multiplied as int32, which is one more. A record is
    scanned leaf by leaf, unless the operator is one on records. Raises TypeError where ``op`` is not defined
    for the dtype.

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.scan(v, sv.ADD)
    Vector([0 5 6 9], dtype=int64, Device())
    """
    return machine_of(v).scan(v, op, exclusive=True, heads=_heads(segments, v))


@old_keywords
@composed
def scan_inclusive(v: R, op: Monoid, segments: Segments | None = None) -> R:
    """r[i] = op(v[s], ..., v[i]), s the start of i's segment (0 without segments). One step, n elements.

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.scan_inclusive(v, sv.MAX)
    Vector([5 5 5 5], dtype=int64, Device())
    """
    return machine_of(v).scan(v, op, exclusive=False, heads=_heads(segments, v))


@old_keywords
@composed
def backscan(v: R, op: Monoid, segments: Segments | None = None) -> R:
    """r[i] = op(v[e], ..., v[i+1]), the identity at i = e, the end of i's segment. One step, n elements.

    The operator sees the elements from the right: it matters to those that do not commute, such as COPY.

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.backscan(v, sv.ADD)
    Vector([8 7 4 0], dtype=int64, Device())
    """
    heads = _heads(segments, v)
    return machine_of(v).scan(v, op, exclusive=True, backward=True, heads=heads)


@old_keywords
@composed
def backscan_inclusive(v: R, op: Monoid, segments: Segments | None = None) -> R:
    """r[i] = op(v[e], ..., v[i]), e the end of i's segment. One step, n elements.

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.backscan_inclusive(v, sv.ADD)
    Vector([13  8  7  4], dtype=int64, Device())
    """
    heads = _heads(segments, v)
    return machine_of(v).scan(v, op, exclusive=False, backward=True, heads=heads)


@old_keywords
@composed
def copy_scan(v: R, segments: Segments | None = None) -> R:
    """r[i] = v[s], the first element of i's segment. One step, n elements.

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.copy_scan(v, sv.Segments.from_lengths(v.machine.vector([1, 3])))
    Vector([5 1 1 1], dtype=int64, Device())
    """
    return scan_inclusive(v, COPY, segments)


@composed
def enumerate(flags: Vector, segments: Segments | None = None) -> Vector:  # Blelloch's name
    """r[i] = how many flags are set before i (in i's segment), as int32. Two steps, n elements.

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.enumerate(v > 2)
    Vector([0 1 1 2], dtype=int32, Device())
    """
    check_flags(flags, "enumerate: the flags")
    return scan(flags.astype(np.int32), ADD, segments)


@overload
def reduce(v: R, op: Monoid, segments: Segments) -> R: ...
@overload
def reduce(v: object, op: Monoid, segments: None = None) -> Any: ...
@old_keywords
@composed
def reduce(v: object, op: Monoid, segments: Segments | None = None) -> object:
    """op(v[0], ..., v[n-1]); with segments, a vector of one such value per segment.

    Without segments the result is a NumPy scalar on the host (a record of them for a record). An empty
    vector or segment gives the identity. One step, n elements; five with segments, and one more for each
    further vector of a record. Booleans are added and multiplied as int32, which is one more step.

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.reduce(v, sv.ADD, sv.Segments.from_lengths(v.machine.vector([1, 0, 3])))
    Vector([5 0 8], dtype=int64, Device())
    """
    vectors = vectors_of(v)
    machine, n = vectors[0].machine, len(vectors[0])
    if segments is None and n:
        return jax.tree.map(lambda x: machine.item(x, n - 1), scan_inclusive(v, op))
    if op in (ADD, MUL):
        v = each(lambda x: x.astype(np.int32) if x.dtype == bool else x, v)
    for x in vectors_of(v):
        op.check(x.dtype, "reduce")
    dtypes = jax.tree.map(lambda x: x.dtype, v)
    identity = jax.tree.map(lambda d, e: np.asarray(e).astype(d)[()], dtypes, op.identity(dtypes))
    if segments is None:
        return identity
    if not n:
        _heads(segments, v)
        return jax.tree.map(lambda d, e: machine.full(segments.count, e, d), dtypes, identity)
    running = scan_inclusive(v, op, segments)
    occupied = segments.lengths > 0
    last = segments.starts + segments.lengths - 1
    return each(lambda x, e: machine.get(x, last, where=occupied, otherwise=e), running, identity)


@old_keywords
@composed
def op_distribute(v: R, op: Monoid, segments: Segments | None = None) -> R:
    """r[i] = op(v[s], ..., v[e]), over the whole of i's segment (all elements without segments).

    Blelloch's +-distribute, max-distribute, ...: a scan, and its last element copied backward. Two steps, n
    elements; booleans are added and multiplied as int32, which is one more.

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.op_distribute(v, sv.MAX)
    Vector([5 5 5 5], dtype=int64, Device())
    """
    return backscan_inclusive(scan_inclusive(v, op, segments), COPY, segments)
