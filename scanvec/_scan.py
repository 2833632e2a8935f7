"""Scans and reductions, plain and segmented, written once for every machine.

Blelloch 1990, chapter 3; segmented forms restart at the first element of each segment.
"""

from __future__ import annotations

from typing import Any

import jax
import numpy as np

from ._checks import check_flags
from ._composed import composed
from ._deprecated import old_keywords
from ._monoid import ADD, COPY, MUL, Monoid
from ._records import is_vector, length_of, machine_of, vectors_of
from ._segments import Segments
from ._vector import Vector


def _heads(segments: Segments | None, v: Any) -> Vector | None:
    if segments is None:
        return None
    n = length_of(v)
    if len(segments.heads) != n:
        msg = f"the segments describe {len(segments.heads)} elements, the vector has {n}"
        raise ValueError(msg)
    return segments.heads


@old_keywords
@composed
def scan(v: Any, op: Monoid, segments: Segments | None = None) -> Any:
    """r[i] = op(v[s], ..., v[i-1]), the identity at i = s, the start of i's segment (0 without segments).

    One scan step, n elements; booleans are added and multiplied as int32, which is one more. A record is
    scanned leaf by leaf, unless the operator is one on records. Raises TypeError where ``op`` is not defined
    for the dtype.
    """
    return machine_of(v).scan(v, op, exclusive=True, heads=_heads(segments, v))


@old_keywords
@composed
def scan_inclusive(v: Any, op: Monoid, segments: Segments | None = None) -> Any:
    """r[i] = op(v[s], ..., v[i]), s the start of i's segment (0 without segments). One step, n elements."""
    return machine_of(v).scan(v, op, exclusive=False, heads=_heads(segments, v))


@old_keywords
@composed
def backscan(v: Any, op: Monoid, segments: Segments | None = None) -> Any:
    """r[i] = op(v[e], ..., v[i+1]), the identity at i = e, the end of i's segment. One step, n elements.

    The operator sees the elements from the right: it matters to those that do not commute, such as COPY.
    """
    heads = _heads(segments, v)
    return machine_of(v).scan(v, op, exclusive=True, backward=True, heads=heads)


@old_keywords
@composed
def backscan_inclusive(v: Any, op: Monoid, segments: Segments | None = None) -> Any:
    """r[i] = op(v[e], ..., v[i]), e the end of i's segment. One step, n elements."""
    heads = _heads(segments, v)
    return machine_of(v).scan(v, op, exclusive=False, backward=True, heads=heads)


@old_keywords
@composed
def copy_scan(v: Any, segments: Segments | None = None) -> Any:
    """r[i] = v[s], the first element of i's segment. One step, n elements."""
    return scan_inclusive(v, COPY, segments)


@composed
def enumerate(flags: Vector, segments: Segments | None = None) -> Vector:  # Blelloch's name
    """r[i] = how many flags are set before i (in i's segment), as int32. Two steps, n elements."""
    check_flags(flags, "enumerate: the flags")
    return scan(flags.astype(np.int32), ADD, segments)


@old_keywords
@composed
def reduce(v: Any, op: Monoid, segments: Segments | None = None) -> Any:
    """op(v[0], ..., v[n-1]); with segments, a vector of one such value a segment.

    Without segments the result is a NumPy scalar on the host (a record of them for a record). An empty
    vector or segment gives the identity. One step, n elements; five with segments, and one more for each
    further vector of a record. Booleans are added and multiplied as int32, which is one more step.
    """
    vectors = vectors_of(v)
    machine, n = vectors[0].machine, len(vectors[0])
    if segments is None and n:
        return jax.tree.map(lambda x: machine.item(x, n - 1), scan_inclusive(v, op), is_leaf=is_vector)
    if op in (ADD, MUL):
        v = jax.tree.map(lambda x: x.astype(np.int32) if x.dtype == bool else x, v, is_leaf=is_vector)
    for x in vectors_of(v):
        op.check(x.dtype, "reduce")
    dtypes = jax.tree.map(lambda x: x.dtype, v, is_leaf=is_vector)
    identity = jax.tree.map(lambda d, e: np.asarray(e).astype(d)[()], dtypes, op.identity(dtypes))
    if segments is None:
        return identity
    if not n:
        _heads(segments, v)
        return jax.tree.map(lambda d, e: machine.full(segments.count, e, d), dtypes, identity)
    running = scan_inclusive(v, op, segments)
    occupied = segments.lengths > 0
    last = segments.starts + segments.lengths - 1
    return jax.tree.map(
        lambda x, e: machine.get(x, last, where=occupied, otherwise=e), running, identity, is_leaf=is_vector
    )


@old_keywords
@composed
def op_distribute(v: Any, op: Monoid, segments: Segments | None = None) -> Any:
    """r[i] = op(v[s], ..., v[e]), over the whole of i's segment (all elements without segments).

    Blelloch's +-distribute, max-distribute, ...: a scan, and its last element copied backward. Two steps, n
    elements; booleans are added and multiplied as int32, which is one more.
    """
    return backscan_inclusive(scan_inclusive(v, op, segments), COPY, segments)
