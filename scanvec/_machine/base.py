"""What a machine supplies: maps, scans, gets and sends. Everything else is written from these four."""

from __future__ import annotations

import abc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import jax
import numpy as np
import numpy.typing as npt

from .._checks import (
    check_dtype,
    check_flags,
    check_index,
    check_size,
    not_distinct,
    out_of_range,
    vectors_and_scalars,
)
from .._deprecated import into_by_position, old_keywords, zero_otherwise
from .._ledger.ledger import Ledger
from .._monoid import ADD, MUL, UNIQUE, Monoid
from .._records import Args, R, blocks_of, check_alike, each, structure_of, vectors_of
from .._running import computing
from .._vector import Scalar, Vector
from .combining import COMBINERS, most_accesses
from .routing import Route


class Machine(abc.ABC):
    """Where vectors live. Use `Simulated` or `Device`.

    The four primitives `map`, `scan`, `get` and `send` are the whole of what programs are made of. They take
    a *context*: with ``where=flags`` only the elements whose flag is set take part (Teng et al. 1993, section
    2.3). What a machine supplies for them are the abstract methods below.

    Attributes
    ----------
    ledger : Ledger or None
        Every step so far, on machines that keep a ledger.

    Examples
    --------
    >>> import scanvec as sv
    >>> def total(machine):
    ...     return int(sv.reduce(machine.iota(10), sv.ADD))
    >>> total(sv.Device()), total(sv.Simulated(processors=4))
    (45, 45)
    """

    ledger: Ledger | None = None

    # making vectors and bringing them back

    def vector(self, values: npt.ArrayLike, dtype: npt.DTypeLike | None = None) -> Vector:
        """A vector of the n elements of a one-dimensional array.

        >>> import scanvec as sv
        >>> sv.Device().vector([4, 5, 6], "int16")
        Vector([4 5 6], dtype=int16, Device())

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

    def full(self, n: int, value: Scalar, dtype: npt.DTypeLike) -> Vector:
        """n elements equal to ``value``. No step.

        >>> import scanvec as sv
        >>> sv.Device().full(3, 7, "int32")
        Vector([7 7 7], dtype=int32, Device())

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

        >>> import scanvec as sv
        >>> sv.Device().iota(4)
        Vector([0 1 2 3], dtype=int32, Device())

        Raises
        ------
        ValueError
            If n is not in 0 .. 2^31 - 1.
        """

    @abc.abstractmethod
    def to_numpy(self, v: Vector) -> npt.NDArray[np.generic]:
        """The elements of ``v`` in order, shape (n,).

        >>> import scanvec as sv
        >>> sv.Device().to_numpy(sv.Device().iota(4)).tolist()
        [0, 1, 2, 3]
        """

    def item(self, v: Vector, i: int) -> Any:
        """The element v[i] as a NumPy scalar on the host; negative i counts from the end.

        >>> import scanvec as sv
        >>> int(sv.Device().item(sv.Device().iota(4), -1))
        3

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
            return np.asarray(self._item(v._block, n, i % n))[()]

    # the four primitives

    def map(
        self,
        fn: Callable[..., object],
        *args: object,
        where: Vector | None = None,
        otherwise: object = None,
    ) -> Any:
        """Elementwise under a context: r[i] = fn(a[i], b[i], ...) where where[i], else otherwise[i].

        One step, n elements.

        >>> import jax.numpy as jnp, scanvec as sv
        >>> v = sv.Device().vector([1.0, -4.0, 9.0])
        >>> v.machine.map(jnp.sqrt, v, where=v >= 0, otherwise=-1)
        Vector([ 1. -1.  3.], dtype=float64, Device())

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
        v: R,
        op: Monoid,
        *,
        exclusive: bool,
        backward: bool = False,
        heads: Vector | None = None,
    ) -> R:
        """The one scan that machines supply; `scanvec.scan` and its siblings name its forms.

        ``heads`` marks the first element of each segment; the scan restarts there (or, backward, at the
        last element of each segment). One step, n elements.

        >>> import scanvec as sv
        >>> cm = sv.Device()
        >>> cm.scan(cm.vector([5, 1, 3]), sv.ADD, exclusive=True, backward=True)
        Vector([4 3 0], dtype=int64, Device())
        """
        vectors = vectors_of(v)
        if op in (ADD, MUL):  # as NumPy does, booleans are added as integers
            v = each(lambda x: x.astype(np.int32) if x.dtype == bool else x, v)
            vectors = vectors_of(v)
        for x in vectors:
            op.check(x.dtype, "scan")
        if heads is not None:
            check_flags(heads, "scan: heads")
            check_alike([vectors[0], heads])
        n = len(vectors[0])
        with computing():
            out: R = self._scan(op, exclusive, backward, blocks_of(v), blocks_of(heads), n)
            return self._wrap(out, n)

    @zero_otherwise
    @old_keywords
    def get(self, v: R, index: Vector, *, where: Vector | None = None, otherwise: Scalar | None = None) -> R:
        """Concurrent read: r[i] = v[index[i]] where where[i], else the scalar ``otherwise``.

        One step, len(index) elements. Several elements may read one place. ``otherwise`` is required with
        ``where``.

        >>> import scanvec as sv
        >>> cm = sv.Device()
        >>> cm.get(cm.vector([5, 1, 3]), cm.vector([2, 2, 0]))
        Vector([3 3 5], dtype=int64, Device())

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
        if otherwise is not None and (isinstance(otherwise, Vector) or np.ndim(otherwise)):
            msg = f"get: `otherwise` must be a scalar, got {type(otherwise).__name__}"
            raise TypeError(msg)
        n, m = len(index), len(vectors[0])
        with computing():
            route = self._route("get", index, where, n, m)
            self._charge("get", n, route, vectors)
            fill = 0 if otherwise is None else otherwise
            return self._wrap(each(lambda x: self._get(x._block, route.place, fill), v), n)

    @into_by_position
    @old_keywords
    def send(
        self,
        v: R,
        index: Vector,
        op: Monoid,
        *,
        into: R,
        where: Vector | None = None,
        what: str = "send",
    ) -> R:
        """Concurrent write: r = into, then for every i with where[i]: r[index[i]] = op(r[index[i]], v[i]).

        ``COPY`` replaces: of several senders to one place the one of lowest index wins. The order of other
        operators' combinations is not defined, so float sums may differ in the last bits between machines.
        One step, max(len(v), len(into)) elements. Errors say ``what`` was called.

        >>> import scanvec as sv
        >>> cm = sv.Device()
        >>> cm.send(cm.vector([5, 1, 3]), cm.vector([0, 1, 0]), sv.ADD, into=cm.vector([10, 10]))
        Vector([18 11], dtype=int64, Device())

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
        if op not in COMBINERS:
            msg = (
                f"{what}: the operator {op.name} cannot combine a concurrent write; "
                f"use one of scanvec's ADD, MUL, MIN, MAX, AND, OR, COPY"
            )
            raise TypeError(msg)
        for x in vectors:
            op.check(x.dtype, what)
        n, m = len(vectors[0]), len(places[0])
        with computing():
            route = self._route("send", index, where, n, m)
            if op is UNIQUE:
                hits = int(most_accesses(places[0]._block.size, route.place))
                if hits > 1:
                    not_distinct(what, index, where, hits)
            self._charge("send", max(n, m), route, vectors)
            out = each(lambda r, x: self._send(op, r._block, route.place, x._block), into, v)
            return self._wrap(out, m)

    def _route(self, what: str, index: Vector, where: Vector | None, n: int, m: int) -> Route:
        """The route of n indices into m elements, checked."""
        place, facts, handled = self._find(what, index._block, blocks_of(where), n, m)
        least, greatest, *loads = np.asarray(facts).tolist()
        if least < 0 or greatest >= m:
            out_of_range(what, least, greatest, m)
        return Route(place, loads, handled)

    def _wrap(self, record: R, n: int) -> R:
        return each(lambda block: Vector(self, block, n), record)

    # what a machine supplies: arrays in, arrays out

    @abc.abstractmethod
    def _shape(self, n: int) -> tuple[int, ...]:
        """The shape of the array of a vector of n elements, which has room for at least n."""

    @abc.abstractmethod
    def _load(self, array: npt.NDArray[np.generic]) -> jax.Array:
        """The elements in their places."""

    @abc.abstractmethod
    def _item(self, block: jax.Array, n: int, i: int) -> jax.Array:
        """Element i of n."""

    @abc.abstractmethod
    def _map(self, fn: Callable[..., R], args: Args, where: jax.Array | None, otherwise: object, n: int) -> R:
        """`map` of n elements."""

    @abc.abstractmethod
    def _scan(
        self, op: Monoid, exclusive: bool, backward: bool, record: R, heads: jax.Array | None, n: int
    ) -> R:
        """`scan` of n elements."""

    @abc.abstractmethod
    def _find(
        self, what: str, index: jax.Array, where: jax.Array | None, n: int, m: int
    ) -> tuple[jax.Array, jax.Array, jax.Array | None]:
        """The places that n indices name among m elements; facts: least, greatest, loads; messages handled.

        What a place is, is the machine's own affair, but `processor.NOWHERE` is outside the context. The last
        two are those of a `Route`.
        """

    @abc.abstractmethod
    def _get(self, block: jax.Array, place: jax.Array, otherwise: Scalar) -> jax.Array:
        """The elements at places, ``otherwise`` outside the context."""

    @abc.abstractmethod
    def _send(self, op: Monoid, into: jax.Array, place: jax.Array, values: jax.Array) -> jax.Array:
        """The array with ``values`` combined in at places."""

    # the ledger; nothing happens on machines that keep none

    def _charge(self, primitive: str, n: int, route: Route, vectors: list[Vector]) -> None:
        """Enter a step that moved elements between processors."""

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """``with machine.phase("search"):`` names a part of the program in the ledger.

        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4)
        >>> with cm.phase("begin"):
        ...     v = cm.iota(8)
        >>> cm.ledger.entries[0].phase
        'begin'
        """
        if self.ledger is None:
            yield
        else:
            with self.ledger.phase(name):
                yield

    @contextmanager
    def operation(self, name: str) -> Iterator[None]:
        """Names a composed operation in the ledger; the outermost name counts.

        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4)
        >>> with cm.operation("count"):
        ...     v = cm.iota(8)
        >>> cm.ledger.entries[0].operation
        'count'
        """
        if self.ledger is None:
            yield
        else:
            with self.ledger.operation(name):
                yield
