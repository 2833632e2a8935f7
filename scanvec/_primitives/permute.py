"""Moving elements by indices: get, send, scatter, permute."""

from __future__ import annotations

from .._deprecated import into_by_position, old_keywords, writes_as, zero_otherwise
from .._monoid import UNIQUE, Monoid
from .._records import R, machine_of
from .._vector import Scalar, Vector
from .composed import composed
from .scalar import full_like


@zero_otherwise
@old_keywords
def get(v: R, index: Vector, *, where: Vector | None = None, otherwise: Scalar | None = None) -> R:
    """Concurrent read: r[i] = v[index[i]] where where[i], else ``otherwise``. One step, len(index) elements.

    ``otherwise``, a scalar, is required with ``where``. Raises IndexError where an index in the context is
    out of range.

    >>> import scanvec as sv
    >>> v, index = map(sv.Device().vector, ([5, 1, 3], [2, 0, 9]))
    >>> sv.get(v, index, where=index < 3, otherwise=-1)
    Vector([ 3  5 -1], dtype=int64, Device())
    """
    return machine_of(v).get(v, index, where=where, otherwise=otherwise)


@into_by_position
@old_keywords
def send(v: R, index: Vector, op: Monoid, *, into: R, where: Vector | None = None) -> R:
    """Concurrent write: ``into``, with op(r[index[i]], v[i]) for every i in the context.

    With COPY the sender of lowest index replaces. One step. Raises IndexError where an index is out of range.

    >>> import scanvec as sv
    >>> v, index = map(sv.Device().vector, ([5, 1, 3], [0, 1, 0]))
    >>> sv.send(v, index, sv.ADD, into=sv.full_like(v, 10))
    Vector([18 11 10], dtype=int64, Device())
    """
    return machine_of(v).send(v, index, op, into=into, where=where)


@old_keywords
@composed
def scatter(v: R, index: Vector, *, into: R, where: Vector | None = None) -> R:
    """Exclusive write: ``into``, with r[index[i]] = v[i] for every i in the context. One step.

    Over max(len(v), len(into)) elements. `send` is the write of several elements to one position.

    Raises
    ------
    ValueError
        If two elements are sent to one position, or v and ``into`` differ in structure or dtypes.
    IndexError
        If an index in the context is out of range.

    Examples
    --------
    >>> import scanvec as sv
    >>> v, index = map(sv.Device().vector, ([5, 1, 3], [3, 0, 1]))
    >>> sv.scatter(v, index, into=v.machine.full(4, -1, v.dtype))
    Vector([ 1  3 -1  5], dtype=int64, Device())
    """
    return machine_of(v).send(v, index, UNIQUE, into=into, where=where, what="scatter")


@writes_as(scatter)
@old_keywords
@composed
def permute(v: R, index: Vector) -> R:
    """Exclusive write: r[index[i]] = v[i], with a permutation of 0 .. n-1. One step, n elements.

    Raises
    ------
    ValueError
        If two elements are sent to one position.
    IndexError
        If an index is out of range.

    Examples
    --------
    >>> import scanvec as sv
    >>> v, index = map(sv.Device().vector, ([5, 1, 3], [2, 0, 1]))
    >>> sv.permute(v, index)
    Vector([1 3 5], dtype=int64, Device())
    """
    return machine_of(v).send(v, index, UNIQUE, into=full_like(v, 0), what="permute")
