"""Sorting by splits, and what follows from it: rank, segmented sort, unique, union."""

from __future__ import annotations

from typing import TypeVar, overload

import jax
import jax.numpy as jnp
import numpy as np

from .._deprecated import old_keywords
from .._monoid import OR
from .._records import R, length_of, machine_of, vectors_of
from .._segments import Segments
from .._vector import Vector
from .composed import composed
from .pack import append, pack, split
from .permute import get, permute

S = TypeVar("S")  # the record of a payload


def sort_bits(x: jax.Array) -> jax.Array:
    """Unsigned bits that order as the values do: -0.0 equals 0.0, and NaN comes last, as in NumPy.

    Zero and NaN are told by their bits: on CPUs, XLA's comparisons take subnormal numbers for zero.
    """
    x = jnp.asarray(x)
    if x.dtype == bool:
        return x.astype(jnp.uint8)
    bits = x.dtype.itemsize * 8
    unsigned = jnp.dtype(f"uint{bits}")
    if jnp.issubdtype(x.dtype, jnp.unsignedinteger):
        return x
    top = jnp.asarray(1 << (bits - 1), unsigned)
    if jnp.issubdtype(x.dtype, jnp.signedinteger):
        return jax.lax.bitcast_convert_type(x, unsigned) ^ top
    u = jax.lax.bitcast_convert_type(x, unsigned)
    magnitude = u & ~top
    # negative: all bits flipped; others: above all negative ones
    ordered = jnp.where((u == magnitude) | (magnitude == 0), magnitude | top, ~u)
    infinity = jax.lax.bitcast_convert_type(jnp.asarray(jnp.inf, x.dtype), unsigned)
    return jnp.where(magnitude > infinity, ~jnp.zeros_like(u), ordered)


def _bit(u: jax.Array, k: int) -> jax.Array:
    return (u >> jnp.asarray(k, u.dtype)) & jnp.asarray(1, u.dtype) != 0


def _sorted_order(keys: object) -> Vector:
    """order[j] = index of the element that comes j-th; stable; records compare from the first vector on."""
    machine, n = machine_of(keys), length_of(keys)
    order = machine.iota(n)
    if n < 2:
        return order
    for leaf in reversed(vectors_of(keys)):
        bits = machine.map(sort_bits, get(leaf, order))
        # only the bits in which keys differ need a split
        varying = int(_bitwise_or(machine.map(jnp.bitwise_xor, bits, machine.item(bits, 0))))
        for k in range(varying.bit_length()):
            if varying >> k & 1:
                bits, order = split((bits, order), machine.map(_bit, bits, k))
    return order


def _bitwise_or(v: Vector) -> np.integer:
    out: np.integer = v.machine.item(v.machine.scan(v, OR, exclusive=False), -1)
    return out


@composed
def rank(keys: object) -> Vector:
    """r[i] = the position of element i in the stable sorted order, int32.

    A record of keys compares lexicographically, its first vector first. One `split` for each bit in which
    the keys differ: O(b) steps, O(b n) elements (the split radix sort of Blelloch 1990, section 3.4.1).

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.rank(v)
    Vector([3 0 1 2], dtype=int32, Device())
    """
    order = _sorted_order(keys)
    return permute(machine_of(keys).iota(len(order)), order)


@overload
def sort(keys: R, payload: None = None) -> R: ...
@overload
def sort(keys: R, payload: S) -> tuple[R, S]: ...
@composed
def sort(keys: R, payload: object = None) -> object:
    """The keys in ascending order; with a payload, the pair (keys, payload), both in the order of the keys.

    Stable. Records of keys compare lexicographically. NaN comes last. O(b) steps for b differing bits.

    Raises
    ------
    ValueError
        If payload and keys have different lengths.

    Examples
    --------
    >>> import scanvec as sv
    >>> sv.sort(sv.Device().vector([5, 1, 3, 4]))
    Vector([1 3 4 5], dtype=int64, Device())
    """
    if payload is not None and length_of(payload) != length_of(keys):
        msg = f"sort: {length_of(keys)} keys, but a payload of {length_of(payload)}"
        raise ValueError(msg)
    order = _sorted_order(keys)
    if payload is None:
        return get(keys, order)
    return get(keys, order), get(payload, order)


@overload
def segmented_sort(keys: R, segments: Segments, payload: None = None) -> R: ...
@overload
def segmented_sort(keys: R, segments: Segments, payload: S) -> tuple[R, S]: ...
@composed
def segmented_sort(keys: R, segments: Segments, payload: object = None) -> object:
    """`sort` within each segment; the segments stay where they are. log2(m) splits more than `sort`.

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.segmented_sort(v, sv.Segments.from_lengths(v.machine.vector([2, 2])))
    Vector([1 5 3 4], dtype=int64, Device())
    """
    if len(segments.ids) != length_of(keys):
        msg = f"the segments describe {len(segments.ids)} elements, the vector has {length_of(keys)}"
        raise ValueError(msg)
    order = _sorted_order((segments.ids, keys))
    if payload is None:
        return get(keys, order)
    return get(keys, order), get(payload, order)


def _differs(a: object, b: object) -> jax.Array:
    pairs = zip(jax.tree.leaves(a), jax.tree.leaves(b), strict=True)
    differ = [sort_bits(x) != sort_bits(y) for x, y in pairs]
    return jnp.any(jnp.stack(differ))


@composed
def unique(keys: R) -> R:
    """The distinct elements in ascending order; of a record, its distinct rows. NaNs count as one.

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 1])
    >>> sv.unique(v)
    Vector([1 3 5], dtype=int64, Device())
    """
    n = length_of(keys)
    if not n:
        return keys
    machine = machine_of(keys)
    ordered = sort(keys)
    index = machine.iota(n)
    before = get(ordered, index - 1, where=index > 0, otherwise=0)
    new = machine.map(_differs, ordered, before) | (index == 0)
    return pack(ordered, new)


@old_keywords
@composed
def union(v: R, w: R) -> R:
    """The distinct elements of both, in ascending order.

    >>> import scanvec as sv
    >>> v = sv.Device().vector([5, 1, 3, 4])
    >>> sv.union(v, v + 1)
    Vector([1 2 3 4 5 6], dtype=int64, Device())
    """
    return unique(append(v, w))
