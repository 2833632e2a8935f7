"""A machine of P simulated processors: blocks, local work under vmap, and a ledger."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from .._checks import check_size
from .._ledger.conflict import ConcurrentAccessError, Conflict
from .._ledger.ledger import Ledger
from .._ledger.operation_count import count_operations
from .._ledger.scopes import Scopes
from .._models.model import Model, check_model
from .._monoid import Monoid
from .._records import Args, R
from .._running import computing
from .._vector import Scalar, Vector
from . import blocks, routing
from .base import Machine
from .combining import most_accesses, put
from .routing import Route


class Simulated(Machine):
    """P processors, each with ceil(n / P) consecutive elements of every vector of length n.

    Virtual processing as on a Connection Machine: element i lives on processor i // ceil(n / P), and a step
    takes as long as the processor with most elements. Work inside a processor runs under `jax.vmap` over
    the processors; what crosses between them is counted in `ledger`.

    >>> import scanvec as sv
    >>> cm = sv.Simulated(processors=4, model=sv.SCAN)
    >>> sv.reduce(cm.iota(8), sv.MAX), cm.ledger.steps, cm.ledger.messages
    (np.int32(7), 2, 3)

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
        scopes = Scopes()  # entered once, for all
        self.ledgers = {p: Ledger(processors=p, model=model, scopes=scopes) for p in every}
        self.ledger: Ledger = self.ledgers[self.processors]
        self._others = tuple(p for p in every if p != self.processors)

    def __repr__(self) -> str:
        model = "" if self.model is None else f", model={self.model!r}"
        return f"Simulated(processors={self.processors}{model})"

    def vp_ratio(self, n: int) -> int:
        """Virtual processors per processor for vectors of length n: ceil(n / P), at least 1.

        >>> import scanvec as sv
        >>> sv.Simulated(processors=4).vp_ratio(10)
        3
        """
        return blocks.vp_ratio(n, self.processors)

    def to_numpy(self, v: Vector) -> npt.NDArray[np.generic]:  # noqa: D102
        with computing():
            return blocks.from_blocks(np.asarray(v._block), len(v))

    def iota(self, n: int) -> Vector:  # noqa: D102
        check_size(n)
        self._enter("map", n, 0)
        with computing():
            return Vector(self, blocks.iota(self._shape(n), np.int32(self.vp_ratio(n))), n)

    def _shape(self, n: int) -> tuple[int, int]:
        return self.processors, blocks.row_length(n, self.processors)

    def _load(self, array: npt.NDArray[np.generic]) -> jax.Array:
        out: jax.Array = jax.device_put(blocks.to_blocks(array, self.processors))
        return out

    def _item(self, block: jax.Array, n: int, i: int) -> jax.Array:
        out: jax.Array = blocks.item(block, *map(np.int32, divmod(i, self.vp_ratio(n))))
        return out

    def _map(self, fn: Callable[..., R], args: Args, where: jax.Array | None, otherwise: object, n: int) -> R:
        out: R = blocks.map_blocks(fn, args, where, otherwise)
        self._enter("map", n, 0, count_operations(fn, args, where is not None))
        return out

    def _scan(
        self, op: Monoid, exclusive: bool, backward: bool, record: R, heads: jax.Array | None, n: int
    ) -> R:
        counts = np.int32(n), np.int32(self.vp_ratio(n))
        out: R = blocks.scan(op, exclusive, backward, record, heads, *counts)
        leaves = jax.tree.leaves(record)
        self._enter("scan", n, sum(x.dtype.itemsize for x in leaves), len(leaves))
        return out

    def _find(
        self, what: str, index: jax.Array, where: jax.Array | None, n: int, m: int
    ) -> tuple[jax.Array, jax.Array, jax.Array]:
        replies, exclusive = what == "get", self.model is not None and self.model.exclusive
        at = routing.layout(n, m, self.processors)
        place, facts, handled = routing.find(replies, index, where, at)
        size = self.processors * blocks.row_length(m, self.processors)
        facts = jnp.append(facts, most_accesses(size, place) if exclusive else 0)
        if self._others:
            vps = [np.array([blocks.vp_ratio(k, p) for p in self._others], np.int32) for k in (n, m)]
            others = routing.loads_elsewhere(replies, self._others, index, where, at, *vps)
            facts = jnp.append(facts, others)
        return place, facts, handled

    def _get(self, block: jax.Array, place: jax.Array, otherwise: Scalar) -> jax.Array:
        out: jax.Array = blocks.get(block, place, otherwise)
        return out

    def _send(self, op: Monoid, into: jax.Array, place: jax.Array, values: jax.Array) -> jax.Array:
        out: jax.Array = put(op, into, place, values)
        return out

    def _charge(self, primitive: str, n: int, route: Route, vectors: list[Vector]) -> None:
        messages, busiest, accesses, *others = route.loads
        if self.on_conflict == "raise" and accesses > 1:
            scopes = self.ledger.scopes
            operation = scopes.operation(primitive)
            conflict = Conflict(scopes.phase, operation, primitive, self.ledger.steps, accesses)
            raise ConcurrentAccessError(conflict, self.model)
        size = sum(v.dtype.itemsize for v in vectors)
        self.ledger.add_handled(np.asarray(route.handled))
        pairs = [(messages, busiest), *zip(others[::2], others[1::2], strict=True)]
        for p, (crossed, most) in zip([self.processors, *self._others], pairs, strict=True):
            vp = blocks.vp_ratio(n, p)
            self.ledgers[p].record(primitive, n, vp, crossed, most, size, accesses=accesses)

    def _enter(self, primitive: str, n: int, size: int, operations: int = 1) -> None:
        """Enter a map, or a scan: every processor with elements but the last passes a partial result on."""
        for p, ledger in self.ledgers.items():
            vp = blocks.vp_ratio(n, p)
            messages = max(-(-n // vp) - 1, 0) if primitive == "scan" else 0
            ledger.record(primitive, n, vp, messages, min(messages, 1), size, operations)


def _check_processors(processors: int) -> int:
    if isinstance(processors, bool) or int(processors) != processors or processors < 1:
        msg = f"processors must be a positive integer, got {processors!r}"
        raise ValueError(msg)
    return int(processors)
