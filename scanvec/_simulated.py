"""A machine of P simulated processors: blocks, local work under vmap, and a ledger."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np

from . import _blocks, _loads, _local
from ._checks import check_size
from ._conflict import ConcurrentAccessError, Conflict
from ._ledger import Ledger
from ._machine import SMALLEST_BLOCK, Machine, round_up
from ._model import Model, check_model
from ._monoid import Monoid
from ._names import Names
from ._operations import count_operations
from ._running import computing
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
        `HYPERCUBE`, `MESH2D`, or your own.
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
        names = Names()  # entered once, for all
        self.ledgers = {p: Ledger(processors=p, model=model, names=names) for p in every}
        self.ledger = self.ledgers[self.processors]
        self._others = tuple(p for p in every if p != self.processors)

    def __repr__(self) -> str:
        model = "" if self.model is None else f", model={self.model!r}"
        return f"Simulated(processors={self.processors}{model})"

    def vp_ratio(self, n: int) -> int:
        """Virtual processors a processor for vectors of length n: ceil(n / P), at least 1."""
        return _blocks.vp_ratio(n, self.processors)

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
        with computing():
            return np.asarray(v._block)[:, :vp].reshape(-1)[: len(v)].copy()

    def iota(self, n: int) -> Vector:
        check_size(n)
        self._enter("map", n, 0)
        with computing():
            return Vector(self, _blocks.iota(self._shape(n), np.int32(self.vp_ratio(n))), n)

    def _item(self, block: jax.Array, n: Any, i: Any) -> jax.Array:
        vp = self.vp_ratio(int(n))
        return _blocks.item(block, np.int32(i // vp), np.int32(i % vp))

    def _map(self, fn: Callable, args: Any, where: Any, otherwise: Any, n: int) -> Any:
        out = _local.map_elements(fn, args, where, otherwise)
        self._enter("map", n, 0, count_operations(fn, args, where is not None))
        return out

    def _scan(self, op: Monoid, exclusive: bool, backward: bool, record: Any, heads: Any, n: int) -> Any:
        vp = self.vp_ratio(n)
        out = _blocks.scan(op, exclusive, backward, record, heads, np.int32(n), np.int32(vp))
        leaves = jax.tree.leaves(record)
        self._enter("scan", n, sum(x.dtype.itemsize for x in leaves), len(leaves))
        return out

    def _route(self, what: str, index: Any, where: Any, n: int, m: int) -> tuple[Any, Any, Any]:
        row = np.int32(self._shape(m)[1])
        vps = np.int32(self.vp_ratio(n)), np.int32(self.vp_ratio(m))
        replies, exclusive = what == "get", self.model is not None and self.model.exclusive
        place, facts, handled = _loads.route(replies, index, where, np.int32(n), np.int32(m), row, *vps)
        if exclusive:
            size = self._shape(m)
            facts = jnp.append(facts, _local.most_accesses(size[0] * size[1], place))
        else:
            facts = jnp.append(facts, 0)
        if self._others:
            sizes = [np.array([_blocks.vp_ratio(k, p) for p in self._others], np.int32) for k in (n, m)]
            others = _loads.loads_elsewhere(replies, self._others, index, where, np.int32(n), vps[0], *sizes)
            facts = jnp.append(facts, others)
        return place, facts, handled

    def _charge(self, primitive: str, n: int, loads: list[int], handled: Any, vectors: list[Vector]) -> None:
        messages, busiest, accesses, *others = loads
        if self.on_conflict == "raise" and accesses > 1:
            names = self.ledger.names
            operation = names.operation(primitive)
            conflict = Conflict(names.phase, operation, primitive, self.ledger.steps, accesses)
            raise ConcurrentAccessError(conflict, self.model)
        size = sum(v.dtype.itemsize for v in vectors)
        self.ledger.add_handled(np.asarray(handled))
        pairs = [(messages, busiest), *zip(others[::2], others[1::2], strict=True)]
        for p, (crossed, most) in zip([self.processors, *self._others], pairs, strict=True):
            self.ledgers[p].record(
                primitive, n, _blocks.vp_ratio(n, p), crossed, most, size, accesses=accesses
            )

    def _enter(self, primitive: str, n: int, size: int, operations: int = 1) -> None:
        """Enter a map, or a scan: every processor with elements but the last passes a partial result on."""
        for p, ledger in self.ledgers.items():
            vp = _blocks.vp_ratio(n, p)
            messages = max(-(-n // vp) - 1, 0) if primitive == "scan" else 0
            ledger.record(primitive, n, vp, messages, min(messages, 1), size, operations)


def _check_processors(processors: Any) -> int:
    if isinstance(processors, bool) or int(processors) != processors or processors < 1:
        msg = f"processors must be a positive integer, got {processors!r}"
        raise ValueError(msg)
    return int(processors)
