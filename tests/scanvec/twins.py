"""Serial twins of the primitives: plain loops over NumPy scalars, the oracles of the other tests.

They are written from the definitions, one element after the other, and share nothing with scanvec.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

import scanvec as sv


def _least(dtype: np.dtype) -> Any:
    if dtype.kind == "f":
        return dtype.type("-inf")
    return dtype.type(0) if dtype.kind in "bu" else dtype.type(-(2 ** (8 * dtype.itemsize - 1)))


def _greatest(dtype: np.dtype) -> Any:
    if dtype.kind == "f":
        return dtype.type("inf")
    return ~_least(dtype)


# each operator of scanvec with what NumPy calls it and its identity
OPERATORS: dict[sv.Monoid, tuple[Callable, Callable]] = {
    sv.ADD: (np.add, lambda dtype: dtype.type(0)),
    sv.MUL: (np.multiply, lambda dtype: dtype.type(1)),
    sv.MIN: (np.minimum, _greatest),
    sv.MAX: (np.maximum, _least),
    sv.AND: (np.bitwise_and, lambda dtype: ~dtype.type(0)),
    sv.OR: (np.bitwise_or, lambda dtype: dtype.type(0)),
    sv.COPY: (lambda a, b: a, lambda dtype: dtype.type(0)),
}


def heads_of(lengths: Sequence[int]) -> np.ndarray:
    """Head flags of segments of these lengths."""
    heads = np.zeros(sum(lengths), bool)
    start = 0
    for length in lengths:
        if length:
            heads[start] = True
        start += length
    return heads


def ids_of(lengths: Sequence[int]) -> np.ndarray:
    """The number of the segment of each element."""
    return np.array([j for j, length in enumerate(lengths) for _ in range(length)], np.int32)


def scan(
    values: Sequence[Any],
    fn: Callable[[Any, Any], Any],
    identity: Any,
    heads: Sequence[bool] | None = None,
    *,
    inclusive: bool,
    backward: bool,
) -> list[Any]:
    """The running result of ``fn``, begun anew in each segment."""
    n = len(values)
    out: list[Any] = [None] * n
    running = None
    for i in reversed(range(n)) if backward else range(n):
        begins = i + 1 if backward else i  # going backward, a segment begins before the next one's head
        if heads is not None and begins < n and heads[begins]:
            running = None
        before = running
        running = values[i] if before is None else fn(before, values[i])
        out[i] = running if inclusive else identity if before is None else before
    return out


def scan_array(
    op: sv.Monoid, values: np.ndarray, heads: Sequence[bool] | None = None, **form: bool
) -> np.ndarray:
    """`scan` of an array by one of scanvec's operators, in wrap-around arithmetic."""
    if values.dtype == bool and op in (sv.ADD, sv.MUL):
        values = values.astype(np.int32)
    fn, identity = OPERATORS[op]
    with np.errstate(all="ignore"):
        out = scan(list(values), fn, identity(values.dtype), heads, **form)
    return np.array(out, values.dtype)


def reduce_array(op: sv.Monoid, values: np.ndarray) -> Any:
    """The result over a whole array or segment; the identity over none."""
    if values.dtype == bool and op in (sv.ADD, sv.MUL):
        values = values.astype(np.int32)
    fn, identity = OPERATORS[op]
    out = None
    with np.errstate(all="ignore"):
        for x in values:
            out = x if out is None else fn(out, x)
    return identity(values.dtype) if out is None else out


def get(values: np.ndarray, index: Sequence[int], where: Sequence[bool], otherwise: Any) -> np.ndarray:
    """r[i] = values[index[i]] in the context."""
    out = [values[j] if active else otherwise for j, active in zip(index, where, strict=True)]
    return np.array(out, values.dtype)


def send(
    op: sv.Monoid, values: np.ndarray, index: Sequence[int], into: np.ndarray, where: Sequence[bool]
) -> np.ndarray:
    """``into`` with every value in the context combined in at its index; COPY keeps the first sender's."""
    out = into.copy()
    taken = set()
    with np.errstate(all="ignore"):
        for i, j in enumerate(index):
            if not where[i]:
                continue
            if op != sv.COPY:
                out[j] = OPERATORS[op][0](out[j], values[i])
            elif j not in taken:
                out[j] = values[i]
            taken.add(j)
    return out


def sorted_order(keys: Sequence[np.ndarray]) -> list[int]:
    """Indices in the order of the rows: first key first, NaN last, equal rows as they were."""

    def rank(x: Any) -> tuple:
        return (True, 0) if x != x else (False, x.item())

    return sorted(range(len(keys[0])), key=lambda i: tuple(rank(k[i]) for k in keys))


def select(flags: Sequence[bool], first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """first[i] where flags[i], else second[i]."""
    return np.array([a if f else b for f, a, b in zip(flags, first, second, strict=True)], first.dtype)


def flag_merge(first: np.ndarray, second: np.ndarray, flags: Sequence[bool]) -> np.ndarray:
    """The next of ``second`` where the flag is set, of ``first`` where it is clear."""
    sources = [iter(first), iter(second)]
    return np.array([next(sources[bool(f)]) for f in flags], first.dtype)


def distribute_array(op: sv.Monoid, values: np.ndarray, ids: np.ndarray) -> np.ndarray:
    """Each element's segment reduced."""
    whole = {j: reduce_array(op, values[ids == j]) for j in set(ids.tolist())}
    dtype = np.asarray(reduce_array(op, values[:0])).dtype
    return np.array([whole[j] for j in ids.tolist()], dtype)


def split(values: np.ndarray, flags: Sequence[bool], lengths: Sequence[int]) -> np.ndarray:
    """In each segment, the elements whose flag is clear and then the others."""
    out, start = [], 0
    for length in lengths:
        own = range(start, start + length)
        out += [values[i] for i in own if not flags[i]] + [values[i] for i in own if flags[i]]
        start += length
    return np.array(out, values.dtype)
