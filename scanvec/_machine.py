"""What a machine supplies: maps, scans, gets and sends. Everything else is written from these four."""

from __future__ import annotations

import abc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import jax
import numpy as np

from . import _local
from ._checks import (
    check_distinct,
    check_dtype,
    check_flags,
    check_index,
    check_size,
    out_of_range,
    vectors_and_scalars,
)
from ._deprecated import into_by_position, old_keywords, zero_otherwise
from ._monoid import ADD, MUL, Monoid
from ._records import blocks_of, check_alike, is_vector, structure_of, vectors_of
from ._running import computing
from ._vector import Vector

SMALLEST_BLOCK = 16384  # elements; shorter vectors share its compiled kernels


def round_up(n: int, least: int) -> int:
    """The smallest of least, 4 least, 16 least, ... that holds n: few lengths, so few compilations."""
    size = least
    while size < n:
        size *= 4
    return size


class Machine(abc.ABC):
    """Where vectors live. Use `Simulated` or `Device`.

    The four primitives below are the whole of what differs between machines. They take a *context*: with
    ``where=flags`` only the elements whose flag is set take part (Teng et al. 1993, section 2.3).
    """

    ledger: Any = None  # a Ledger on machines that keep one

    # making vectors and bringing them back

    def vector(self, values: Any, dtype: Any = None) -> Vector:
        """A vector of the n elements of a one-dimensional array.

        Raises
        ------
        ValueError
            If ``values`` is not one-dimensional.
        TypeError
            If its dtype is not boolean, integer or real floating of at most 64 bits.
        """
        array = np.asarray(values, dtype)
        if array.ndim != 1:
            msg = f"a vector takes a one-dimensional array, got shape {array.shape}; use one vector a column"
            raise ValueError(msg)
        check_dtype(array.dtype)
        check_size(len(array))
        with computing():
            return Vector(self, self._load(array.astype(array.dtype.newbyteorder("="))), len(array))

    def full(self, n: int, value: Any, dtype: Any) -> Vector:
        """n elements equal to ``value``. No step.

        Raises
        ------
        ValueError
            If n is not in 0 .. 2^31 - 1.
        TypeError
            If ``dtype`` is not one that `vector` takes.
        """
        check_dtype(np.dtype(dtype))
        check_size(n)
        with computing():
            shape = self._shape(n)
            return Vector(self, jax.device_put(np.full(shape, value, dtype)), n)

    @abc.abstractmethod
    def iota(self, n: int) -> Vector:
        """r[i] = i as int32: each element's own index. One step, n elements.

        Raises
        ------
        ValueError
            If n is not in 0 .. 2^31 - 1.
        """

    @abc.abstractmethod
    def to_numpy(self, v: Vector) -> np.ndarray:
        """The elements of ``v`` in order, shape (n,)."""

    @abc.abstractmethod
    def _load(self, array: np.ndarray) -> jax.Array: ...

    @abc.abstractmethod
    def _shape(self, n: int) -> tuple[int, ...]: ...

    def item(self, v: Vector, i: int) -> Any:
        """The element v[i] as a NumPy scalar on the host; negative i counts from the end.

        Raises
        ------
        IndexError
            If i is not an index of v.
        """
        n = len(v)
        if not -n <= i < n:
            msg = f"index {i} is out of range for a vector of {n} elements"
            raise IndexError(msg)
        with computing():
            return np.asarray(self._item(v._block, np.int32(n), np.int32(i % n)))[()]

    @abc.abstractmethod
    def _item(self, block: jax.Array, n: Any, i: Any) -> jax.Array: ...

    # the four primitives

    def map(self, fn: Callable, *args: Any, where: Vector | None = None, otherwise: Any = None) -> Any:
        """Elementwise under a context: r[i] = fn(a[i], b[i], ...) where where[i], else otherwise[i].

        One step, n elements.

        Parameters
        ----------
        fn
            Traceable by JAX. It gets scalars, or records of scalars, one element of each argument, and
            returns a scalar or a record of scalars. Compiled once for each function object: pass a function
            that has a name rather than a new lambda each time.
        args
            Vectors of length n, records of them, and Python or NumPy scalars, which every element sees.
        where
            The context: a vector of n booleans; all when None.
        otherwise
            A record like the result, or a scalar for each of its leaves: the value outside the context.
            Required with ``where``.

        Raises
        ------
        TypeError
            If no argument is a vector or one is an array, ``fn`` does not return real scalars, or ``where``
            is not boolean.
        ValueError
            If lengths or machines differ.
        """
        vectors = vectors_and_scalars(args)
        if not vectors:
            msg = "map needs at least one Vector among its arguments"
            raise TypeError(msg)
        vectors += vectors_and_scalars(otherwise)
        if where is not None:
            check_flags(where, "map: where")
            vectors.append(where)
            if otherwise is None:
                msg = "map under a context needs `otherwise`: what elements outside the context get"
                raise TypeError(msg)
        check_alike(vectors)
        n = len(vectors[0])
        with computing():
            out = self._map(fn, blocks_of(args), blocks_of(where), blocks_of(otherwise), n)
            return self._wrap(out, n)

    @old_keywords
    def scan(
        self,
        v: Any,
        op: Monoid,
        *,
        exclusive: bool,
        backward: bool = False,
        heads: Vector | None = None,
    ) -> Any:
        """The one scan that machines supply; `scanvec.scan` and its siblings name its forms.

        ``heads`` marks the first element of each segment; the scan restarts there (or, backward, at the
        last element of each segment).
        """
        vectors = vectors_of(v)
        if op in (ADD, MUL):  # as NumPy does, booleans are added as integers
            v = jax.tree.map(lambda x: x.astype(np.int32) if x.dtype == bool else x, v, is_leaf=is_vector)
            vectors = vectors_of(v)
        for x in vectors:
            op.check(x.dtype, "scan")
        if heads is not None:
            check_flags(heads, "scan: heads")
            check_alike([vectors[0], heads])
        n = len(vectors[0])
        with computing():
            out = self._scan(op, exclusive, backward, blocks_of(v), blocks_of(heads), n)
            return self._wrap(out, n)

    @zero_otherwise
    @old_keywords
    def get(self, v: Any, index: Vector, *, where: Vector | None = None, otherwise: Any = None) -> Any:
        """Concurrent read: r[i] = v[index[i]] where where[i], else the scalar ``otherwise``.

        One step, len(index) elements. Several elements may read one place. ``otherwise`` is required with
        ``where``.

        Raises
        ------
        IndexError
            If an index in the context is not in 0 .. len(v)-1.
        TypeError
            If ``index`` is not an integer vector, or ``otherwise`` not a scalar.
        """
        vectors = vectors_of(v)
        index = check_index(index, vectors[0].machine, "get")
        if where is not None:
            check_flags(where, "get: where")
            check_alike([index, where])
            if otherwise is None:
                msg = "get under a context needs `otherwise`: what elements outside the context get"
                raise TypeError(msg)
        if is_vector(otherwise) or np.ndim(otherwise):
            msg = f"get: `otherwise` must be a scalar, got {type(otherwise).__name__}"
            raise TypeError(msg)
        n, m = len(index), len(vectors[0])
        with computing():
            place, loads, handled = self._routed("get", index, where, n, m)
            self._charge("get", n, loads, handled, vectors)
            fill = 0 if otherwise is None else otherwise
            out = jax.tree.map(lambda x: _local.take(x._block, place, fill), v, is_leaf=is_vector)
            return self._wrap(out, n)

    @into_by_position
    @old_keywords
    def send(
        self,
        v: Any,
        index: Vector,
        op: Monoid,
        *,
        into: Any,
        where: Vector | None = None,
        what: str = "send",
    ) -> Any:
        """Concurrent write: r = into, then for every i with where[i]: r[index[i]] = op(r[index[i]], v[i]).

        ``COPY`` replaces: of several senders to one place the one of lowest index wins. The order of other
        operators' combinations is not defined, so float sums may differ in the last bits between machines.
        One step, max(len(v), len(into)) elements. Errors say ``what`` was called.

        Raises
        ------
        IndexError
            If an index in the context is not in 0 .. len(into)-1.
        ValueError
            If the records differ in structure, length of index, or dtypes.
        TypeError
            If ``index`` is not an integer vector, or ``op`` is not defined for a dtype.
        """
        vectors = vectors_of(v)
        places = vectors_of(into)
        index = check_index(index, vectors[0].machine, what)
        check_alike([vectors[0], index] + ([] if where is None else [where]))
        if where is not None:
            check_flags(where, f"{what}: where")
        if places[0].machine is not vectors[0].machine:
            check_alike([vectors[0], places[0]])
        if structure_of(v) != structure_of(into):
            msg = f"{what}: a record {structure_of(v)} cannot go into a record {structure_of(into)}"
            raise ValueError(msg)
        if [x.dtype for x in vectors] != [x.dtype for x in places]:
            got, want = [str(x.dtype) for x in vectors], [str(x.dtype) for x in places]
            msg = (
                f"{what}: elements of {', '.join(got)} cannot go into {', '.join(want)}; convert with astype"
            )
            raise ValueError(msg)
        if op not in _local.COMBINERS:
            msg = (
                f"{what}: the operator {op.name} cannot combine a concurrent write; "
                f"use one of scanvec's ADD, MUL, MIN, MAX, AND, OR, COPY"
            )
            raise TypeError(msg)
        for x in vectors:
            op.check(x.dtype, what)
        n, m = len(vectors[0]), len(places[0])
        with computing():
            place, loads, handled = self._routed("send", index, where, n, m)
            if op is _local.UNIQUE:
                check_distinct(what, index, where, place, places[0]._block)
            self._charge("send", max(n, m), loads, handled, vectors)
            out = jax.tree.map(
                lambda r, x: _local.put(op, r._block, place, x._block), into, v, is_leaf=is_vector
            )
            return self._wrap(out, m)

    def _routed(
        self, what: str, index: Vector, where: Vector | None, n: int, m: int
    ) -> tuple[jax.Array, list[int], Any]:
        """The flat places that n indices name among m elements, checked; and the messages it takes."""
        place, facts, handled = self._route(what, index._block, blocks_of(where), n, m)
        least, greatest, *loads = np.asarray(facts).tolist()
        if least < 0 or greatest >= m:
            out_of_range(what, least, greatest, m)
        return place, loads, handled

    def _wrap(self, blocks: Any, n: int) -> Any:
        return jax.tree.map(lambda b: Vector(self, b, n), blocks)

    @abc.abstractmethod
    def _map(self, fn: Callable, args: Any, where: Any, otherwise: Any, n: int) -> Any: ...

    @abc.abstractmethod
    def _scan(self, op: Monoid, exclusive: bool, backward: bool, record: Any, heads: Any, n: int) -> Any: ...

    @abc.abstractmethod
    def _route(
        self, what: str, index: jax.Array, where: jax.Array | None, n: int, m: int
    ) -> tuple[jax.Array, jax.Array, Any]:
        """Flat place in a block of m elements for each of n indices; facts: least, greatest, loads; and the
        messages that each processor handles, on machines that count them.

        An element outside the context gets a place beyond every block, `_local.NOWHERE`.
        """

    # the ledger; nothing happens on machines that keep none

    def _charge(self, primitive: str, n: int, loads: list[int], handled: Any, vectors: list[Vector]) -> None:
        """Enter a step that moved elements between processors."""

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """``with machine.phase("search"):`` names a part of the program in the ledger."""
        if self.ledger is None:
            yield
        else:
            with self.ledger.phase(name):
                yield

    @contextmanager
    def operation(self, name: str) -> Iterator[None]:
        """Names a composed operation in the ledger; the outermost name counts."""
        if self.ledger is None:
            yield
        else:
            with self.ledger.operation(name):
                yield
