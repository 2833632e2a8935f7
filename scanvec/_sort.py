"""Sorting by splits, and what follows from it: rank, segmented sort, unique, union."""

from __future__ import annotations

from typing import Any

import jax
import jax.numpy as jnp

from ._composed import composed
from ._deprecated import old_keywords
from ._monoid import OR
from ._move import append, get, pack, permute, split
from ._records import length_of, machine_of, vectors_of
from ._segments import Segments
from ._vector import Vector


def sort_bits(x: Any) -> Any:
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


def _bit(u: Any, k: Any) -> Any:
    return (u >> jnp.asarray(k, u.dtype)) & jnp.asarray(1, u.dtype) != 0


def _sorted_order(keys: Any) -> Vector:
    """order[j] = index of the element that comes j-th; stable; records compare from the first vector on."""
    machine, n = machine_of(keys), length_of(keys)
    order = machine.iota(n)
    if n < 2:
        return order
    for leaf in reversed(vectors_of(keys)):
        bits = machine.map(sort_bits, get(leaf, order))
        # only the bits in which keys differ need a split
        varying = int(reduce_or(machine.map(jnp.bitwise_xor, bits, machine.item(bits, 0))))
        for k in range(varying.bit_length()):
            if varying >> k & 1:
                bits, order = split((bits, order), machine.map(_bit, bits, k))
    return order


def reduce_or(v: Vector) -> Any:
    return v.machine.item(v.machine.scan(v, OR, exclusive=False), -1)


@composed
def rank(keys: Any) -> Vector:
    """r[i] = the position of element i in the stable sorted order, int32.

    A record of keys compares lexicographically, its first vector first. One `split` for each bit in which
    the keys differ: O(b) steps, O(b n) elements (the split radix sort of Blelloch 1990, section 3.4.1).
    """
    order = _sorted_order(keys)
    return permute(machine_of(keys).iota(len(order)), order)


@composed
def sort(keys: Any, payload: Any = None) -> Any:
    """The keys in ascending order; with a payload, the pair (keys, payload), both in the order of the keys.

    Stable. Records of keys compare lexicographically. NaN comes last. O(b) steps for b differing bits.

    Raises
    ------
    ValueError
        If payload and keys have different lengths.
    """
    if payload is not None and length_of(payload) != length_of(keys):
        msg = f"sort: {length_of(keys)} keys, but a payload of {length_of(payload)}"
        raise ValueError(msg)
    order = _sorted_order(keys)
    if payload is None:
        return get(keys, order)
    return get(keys, order), get(payload, order)


@composed
def segmented_sort(keys: Any, segments: Segments, payload: Any = None) -> Any:
    """`sort` within each segment; the segments stay where they are. log2(m) splits more than `sort`."""
    if len(segments.ids) != length_of(keys):
        msg = f"the segments describe {len(segments.ids)} elements, the vector has {length_of(keys)}"
        raise ValueError(msg)
    order = _sorted_order((segments.ids, keys))
    if payload is None:
        return get(keys, order)
    return get(keys, order), get(payload, order)


def _differs(a: Any, b: Any) -> Any:
    pairs = zip(jax.tree.leaves(a), jax.tree.leaves(b), strict=True)
    differ = [sort_bits(x) != sort_bits(y) for x, y in pairs]
    return jnp.any(jnp.stack(differ))


@composed
def unique(keys: Any) -> Any:
    """The distinct elements in ascending order; of a record, its distinct rows. NaNs count as one."""
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
def union(v: Any, w: Any) -> Any:
    """The distinct elements of both, in ascending order."""
    return unique(append(v, w))
