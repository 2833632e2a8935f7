"""A machine of P simulated processors: blocks, local work under vmap, and a ledger."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from . import _local
from ._checks import check_size
from ._entry import Conflict
from ._ledger import Ledger
from ._machine import SMALLEST_BLOCK, Machine, round_up
from ._model import Model, check_model
from ._monoid import ONE_SIDED, Monoid
from ._operations import count_operations
from ._vector import Vector


class Simulated(Machine):
    """P processors, each with ceil(n / P) consecutive elements of every vector of length n.

    Virtual processing as on a Connection Machine: element i lives on processor i // ceil(n / P), and a step
    takes as long as the processor with most elements. Work inside a processor runs under `jax.vmap` over
    the processors; what crosses between them is counted in `ledger`.

    Parameters
    ----------
    processors : int
        P, at least 1.
    model : Model, optional
        Predicts the time of what runs, as ``ledger.seconds``: `EREW_PRAM`, `CRCW_PRAM`, `SCAN`, `CM2`, `CM5`,
        `Hypercube`, `Mesh2D`, or your own.
    also : iterable of int, optional
        Further numbers of processors, for which the loads of the same steps are counted, each in a ledger of
        its own. A program whose course does not depend on P, as results never do, need not run again for
        each P.
    on_conflict : "report" or "raise"
        What a concurrent read or write does under a model with exclusive access (`EREW_PRAM`): it is listed
        in ``ledger.conflicts``, or raises `ConcurrentAccessError` and is not entered.

    Attributes
    ----------
    ledger : Ledger
        Every step so far.
    ledgers : dict of int to Ledger
        The same, and those of ``also``, by number of processors.

    Raises
    ------
    ValueError
        If a number of processors is not a positive integer, ``model`` is no model, or ``on_conflict``
        unknown.
    """

    def __init__(
        self,
        processors: int,
        model: Model | None = None,
        *,
        also: Iterable[int] = (),
        on_conflict: str = "report",
    ) -> None:
        self.processors = _check_processors(processors)
        self.model = check_model(model)
        if on_conflict not in ("report", "raise"):
            msg = f"on_conflict must be 'report' or 'raise', got {on_conflict!r}"
            raise ValueError(msg)
        self.on_conflict = on_conflict
        every = dict.fromkeys([self.processors, *map(_check_processors, also)])
        self.ledgers = {p: Ledger(processors=p, model=model) for p in every}
        self.ledger = self.ledgers[self.processors]
        self._others = tuple(p for p in every if p != self.processors)
        for p in self._others:  # names are entered once, for all
            self.ledgers[p].share_names(self.ledger)

    def __repr__(self) -> str:
        model = "" if self.model is None else f", model={self.model!r}"
        return f"Simulated(processors={self.processors}{model})"

    def vp_ratio(self, n: int) -> int:
        """Virtual processors a processor for vectors of length n: ceil(n / P), at least 1."""
        return _vp_ratio(n, self.processors)

    def _shape(self, n: int) -> tuple[int, int]:
        # A row is longer than the VP ratio: rounded up, so that few shapes are compiled.
        least = round_up(-(-SMALLEST_BLOCK // self.processors), 1)
        return self.processors, round_up(self.vp_ratio(n), least)

    def _load(self, array: np.ndarray) -> jax.Array:
        p, row = self._shape(len(array))
        vp = self.vp_ratio(len(array))
        block = np.zeros((p, row), array.dtype)
        padded = np.zeros(p * vp, array.dtype)
        padded[: len(array)] = array
        block[:, :vp] = padded.reshape(p, vp)
        return jax.device_put(block)

    def to_numpy(self, v: Vector) -> np.ndarray:
        vp = self.vp_ratio(len(v))
        return np.asarray(v._block)[:, :vp].reshape(-1)[: len(v)].copy()

    def iota(self, n: int) -> Vector:
        check_size(n)
        self._enter("map", n, 0)
        with jax.enable_x64(True):
            return Vector(self, _iota(self._shape(n), np.int32(self.vp_ratio(n))), n)

    def _item(self, block: jax.Array, n: Any, i: Any) -> jax.Array:
        vp = self.vp_ratio(int(n))
        return _item(block, np.int32(i // vp), np.int32(i % vp))

    def _map(self, fn: Callable, args: Any, where: Any, otherwise: Any, n: int) -> Any:
        out = _local.map_elements(fn, args, where, otherwise)
        self._enter("map", n, 0, count_operations(fn, args, where is not None))
        return out

    def _scan(self, op: Monoid, exclusive: bool, backward: bool, record: Any, heads: Any, n: int) -> Any:
        vp = self.vp_ratio(n)
        out = _scan(op, exclusive, backward, record, heads, np.int32(n), np.int32(vp))
        leaves = jax.tree.leaves(record)
        self._enter("scan", n, sum(x.dtype.itemsize for x in leaves), len(leaves))
        return out

    def _route(self, what: str, index: Any, where: Any, n: int, m: int) -> tuple[Any, Any, Any]:
        row = np.int32(self._shape(m)[1])
        vps = np.int32(self.vp_ratio(n)), np.int32(self.vp_ratio(m))
        replies, exclusive = what == "get", self.model is not None and self.model.exclusive
        place, facts, handled = _route(replies, index, where, np.int32(n), np.int32(m), row, *vps)
        if exclusive:
            size = self._shape(m)
            facts = jnp.append(facts, _local.most_accesses(size[0] * size[1], place))
        else:
            facts = jnp.append(facts, 0)
        if self._others:
            sizes = [np.array([_vp_ratio(k, p) for p in self._others], np.int32) for k in (n, m)]
            others = _loads(replies, self._others, index, where, np.int32(n), vps[0], *sizes)
            facts = jnp.append(facts, others)
        return place, facts, handled

    def _charge(self, primitive: str, n: int, loads: list[int], handled: Any, vectors: list[Vector]) -> None:
        messages, busiest, accesses, *others = loads
        if self.on_conflict == "raise" and accesses > 1:
            phase, operation = self.ledger.names(primitive)
            conflict = Conflict(phase, operation, primitive, self.ledger.steps, accesses)
            raise ConcurrentAccessError(conflict, self.model)
        size = sum(v.dtype.itemsize for v in vectors)
        self.ledger.add_handled(np.asarray(handled))
        pairs = [(messages, busiest), *zip(others[::2], others[1::2], strict=True)]
        for p, (crossed, most) in zip([self.processors, *self._others], pairs, strict=True):
            self.ledgers[p].record(primitive, n, _vp_ratio(n, p), crossed, most, size, accesses=accesses)

    def _enter(self, primitive: str, n: int, size: int, operations: int = 1) -> None:
        """Enter a map, or a scan: every processor with elements but the last passes a partial result on."""
        for p, ledger in self.ledgers.items():
            vp = _vp_ratio(n, p)
            messages = max(-(-n // vp) - 1, 0) if primitive == "scan" else 0
            ledger.record(primitive, n, vp, messages, min(messages, 1), size, operations)


class ConcurrentAccessError(ValueError):
    """A concurrent read or write on a machine with exclusive access.

    Attributes
    ----------
    conflict : Conflict
    """

    def __init__(self, conflict: Conflict, model: Model | None) -> None:
        super().__init__(
            f"{conflict}; {model!r} allows exclusive access only. Use indices that are distinct, a copy-scan "
            f"instead of a concurrent read, a reduction instead of a write; or on_conflict='report'"
        )
        self.conflict = conflict


def _check_processors(processors: Any) -> int:
    if isinstance(processors, bool) or int(processors) != processors or processors < 1:
        msg = f"processors must be a positive integer, got {processors!r}"
        raise ValueError(msg)
    return int(processors)


def _vp_ratio(n: int, processors: int) -> int:
    return max(1, -(-n // processors))


# The kernels. Arrays are (P, row); row >= vp, the VP ratio; element i is at [i // vp, i % vp].


def _valid(shape: tuple[int, int], n: Any, vp: Any) -> jax.Array:
    """Which places of a block hold an element."""
    column = jnp.arange(shape[1], dtype=jnp.int32)
    return (column < vp) & (_indices(shape, vp) < n)


def _indices(shape: tuple[int, int], vp: Any) -> jax.Array:
    p, row = shape
    return jnp.arange(p, dtype=jnp.int32)[:, None] * vp + jnp.arange(row, dtype=jnp.int32)


@partial(jax.jit, static_argnums=0)
def _iota(shape: tuple[int, int], vp: Any) -> jax.Array:
    return _indices(shape, vp)


@jax.jit
def _item(block: jax.Array, p: Any, j: Any) -> jax.Array:
    return block[p, j]


@partial(jax.jit, static_argnums=(0, 1, 2))
def _scan(op: Monoid, exclusive: bool, backward: bool, record: Any, heads: Any, n: Any, vp: Any) -> Any:
    shape = jax.tree.leaves(record)[0].shape
    valid = _valid(shape, n, vp)
    index = _indices(shape, vp)
    values = _local.mask_identity(op, record, valid)
    flags = None if heads is None else heads & valid
    if backward and flags is not None:
        # going backward, segments begin at their last elements: where the next one is a head
        following = jnp.roll(flags[:, 0], -1)[:, None]
        following = jnp.where(
            jnp.arange(shape[1]) == vp - 1, following, jnp.concatenate([flags[:, 1:], following], 1)
        )
        flags = following & valid
    if op in ONE_SIDED:
        first = index == (n - 1 if backward else 0)
        flags = (first & valid) if flags is None else flags | (first & valid)
    if backward:
        values, flags = jax.tree.map(lambda x: x[::-1, ::-1], (values, flags))

    # every processor scans its own elements
    local, seen = jax.vmap(partial(_local.inclusive_scan, op))(values, flags)
    # the processors' totals are scanned once, and come back as what each one starts with
    totals = jax.tree.map(lambda x: x[:, -1], local)
    running, _ = _local.inclusive_scan(op, totals, None if seen is None else seen[:, -1])
    identity = _local.identity_like(op, record)
    carry = jax.tree.map(lambda x, e: _local.shift(x, 1, e)[:, None], running, identity)
    result = op.fn(jax.tree.map(lambda c, x: jnp.broadcast_to(c, x.shape), carry, local), local)
    if seen is not None:
        result = _local.select(seen, local, result)
    if exclusive:
        result = jax.tree.map(lambda c, x: jnp.concatenate([c, x[:, :-1]], 1), carry, result)
        if flags is not None:
            result = jax.tree.map(lambda x, e: jnp.where(flags, e, x), result, identity)
    return jax.tree.map(lambda x: x[::-1, ::-1], result) if backward else result


@partial(jax.jit, static_argnums=0)
def _route(
    replies: bool, index: Any, where: Any, n: Any, m: Any, row: Any, vp_n: Any, vp_m: Any
) -> tuple[Any, Any, Any]:
    """Where n indices lead in a vector of m elements whose blocks have rows of ``row``."""
    processors = index.shape[0]
    active = _valid(index.shape, n, vp_n)
    if where is not None:
        active &= where
    least, greatest = _local.span(index, active)
    index = jnp.clip(index, 0, jnp.maximum(m - 1, 0)).astype(jnp.int32)
    owner = index // vp_m
    place = jnp.where(active, owner * row + (index - owner * vp_m), _local.NOWHERE)
    # messages: each processor's own elements that lead elsewhere, and those of others that lead to it
    remote = active & (owner != jnp.arange(processors, dtype=jnp.int32)[:, None])
    sent = jnp.sum(remote, 1)
    to = jnp.where(remote, owner, processors).reshape(-1)
    received = jnp.zeros(processors, sent.dtype).at[to].add(1, mode="drop")
    if replies:  # a request goes out for each reply that comes in, and the other way round
        handled = sent + received
        loads = [2 * jnp.sum(sent), jnp.max(handled)]
    else:
        handled = jnp.maximum(sent, received)
        loads = [jnp.sum(sent), jnp.max(handled)]
    return place, jnp.stack([x.astype(jnp.int64) for x in [least, greatest, *loads]]), handled


@partial(jax.jit, static_argnums=(0, 1))
def _loads(
    replies: bool, machines: tuple[int, ...], index: Any, where: Any, n: Any, vp: Any, vps_n: Any, vps_m: Any
) -> jax.Array:
    """Messages in all, and of the busiest processor, on machines of other numbers of processors: int64 (2k,).

    The block is laid out with ``vp`` elements a row; ``vps_n`` and ``vps_m`` are the VP ratios on the others.
    """
    active = _valid(index.shape, n, vp)
    if where is not None:
        active &= where
    element = _indices(index.shape, vp)
    out = []
    for k, p in enumerate(machines):
        owner, asker = (index // vps_m[k]).astype(jnp.int32), element // vps_n[k]
        remote = active & (owner != asker)
        none = jnp.zeros(p, jnp.int32)
        sent = none.at[jnp.where(remote, asker, p).reshape(-1)].add(1, mode="drop")
        received = none.at[jnp.where(remote, owner, p).reshape(-1)].add(1, mode="drop")
        total = jnp.sum(remote, dtype=jnp.int64)
        if replies:
            out += [2 * total, jnp.max(sent + received)]
        else:
            out += [total, jnp.maximum(jnp.max(sent), jnp.max(received))]
    return jnp.stack([x.astype(jnp.int64) for x in out])
