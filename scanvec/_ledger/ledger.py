"""The ledger: what every step of a simulated machine did.

It counts; two runs of one program give the same ledger. A cost model turns its counts into predicted time.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from .._deprecated import warn
from .._models.model import Model, check_model
from . import tables
from .conflict import Conflict
from .entry import Entry, Row
from .scopes import Scopes


@dataclass
class Ledger:
    """All that ran on one simulated machine of P processors, in order.

    Attributes
    ----------
    entries : list of Entry
    processors : int
        How many, P.
    model : Model or None
        What `seconds` is predicted with.
    handled : dict of str to ndarray of int64 (P,)
        By phase, the messages of each processor: sent or received, whichever is more in a step. Counted on
        the machine itself, not for its further numbers of processors.
    scopes : Scopes
        The phase and the operation that are running.

    Examples
    --------
    >>> import scanvec as sv
    >>> cm = sv.Simulated(processors=4, model=sv.SCAN)
    >>> v = cm.iota(8) + 1
    >>> cm.ledger.steps, cm.ledger.messages, cm.ledger.seconds
    (2, 0, 4e-06)
    """

    entries: list[Entry] = field(default_factory=list)
    processors: int = 1
    model: Model | None = None
    handled: dict[str, npt.NDArray[np.int64]] = field(default_factory=dict, repr=False, compare=False)
    scopes: Scopes = field(default_factory=Scopes, repr=False, compare=False)

    @property
    def names(self) -> Scopes:
        """The old name of `scopes`."""
        warn("Ledger.names", "Ledger.scopes")
        return self.scopes

    @property
    def steps(self) -> int:
        """Primitive steps so far.

        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4, model=sv.SCAN)
        >>> v = cm.iota(8) + 1
        >>> cm.ledger.steps
        2
        """
        return len(self.entries)

    @property
    def messages(self) -> int:
        """Messages between processors so far.

        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4, model=sv.SCAN)
        >>> sums = sv.scan(cm.vector([5, 1, 3, 4]), sv.ADD)
        >>> cm.ledger.messages
        3
        """
        return sum(e.messages for e in self.entries)

    @property
    def elements(self) -> int:
        """Elements processed so far, summed over the steps: the work of the scan model.

        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4, model=sv.SCAN)
        >>> v = cm.iota(8) + 1
        >>> cm.ledger.elements
        16
        """
        return sum(e.elements for e in self.entries)

    @property
    def seconds(self) -> float:
        """Time of all steps so far as the model predicts it.

        Raises
        ------
        ValueError
            If the machine was made without a model.

        Examples
        --------
        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4, model=sv.SCAN)
        >>> v = cm.iota(8) + 1
        >>> round(cm.ledger.seconds, 9)
        4e-06
        """
        model = self.check_has_model()
        return sum(model.seconds(e, self.processors) for e in self.entries)

    def check_has_model(self) -> Model:
        """The model; ValueError, saying where one comes from, if there is none.

        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4, model=sv.SCAN)
        >>> v = cm.iota(8) + 1
        >>> cm.ledger.check_has_model()
        scanvec.SCAN
        """
        if self.model is None:
            msg = (
                "this ledger has no cost model, so it predicts no time; make the machine with one, as in "
                "Simulated(processors=32, model=scanvec.CM5), or use ledger.under(scanvec.CM5)"
            )
            raise ValueError(msg)
        return self.model

    @property
    def conflicts(self) -> list[Conflict]:
        """Steps so far whose accesses were not exclusive; of machines whose model asks for it.

        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4, model=sv.EREW_PRAM)
        >>> v = sv.get(cm.vector([5, 1, 3]), cm.vector([2, 2, 0]))
        >>> print(cm.ledger.conflicts[0])
        step 0: get, called by get: one place was read by 2 elements at once
        """
        return [
            Conflict(e.phase, e.operation, e.primitive, step, e.accesses)
            for step, e in enumerate(self.entries)
            if e.accesses > 1
        ]

    def under(self, model: Model) -> Ledger:
        """The same entries with another model.

        The loads are the same, since they depend on P only. Accesses are known only if the machine's own
        model was exclusive.

        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4, model=sv.SCAN)
        >>> v = cm.iota(8) + 1
        >>> round(cm.ledger.under(sv.CM5).seconds, 6)
        0.00102
        """
        return Ledger(self.entries, self.processors, check_model(model), self.handled)

    def of(self, *phases: str) -> Ledger:
        """The part of the ledger that these phases made.

        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4)
        >>> with cm.phase("begin"):
        ...     v = cm.iota(8)
        >>> w = v + 1
        >>> cm.ledger.of("begin").steps
        1
        """
        entries = [e for e in self.entries if e.phase in phases]
        handled = {phase: load for phase, load in self.handled.items() if phase in phases}
        return Ledger(entries, self.processors, self.model, handled)

    def record(
        self,
        primitive: str,
        elements: int,
        vp_ratio: int,
        messages: int,
        busiest: int,
        size: int,
        operations: int = 1,
        accesses: int = 0,
    ) -> None:
        """Enter one step; machines call this.

        >>> ledger = Ledger(processors=4)
        >>> ledger.record("scan", elements=8, vp_ratio=2, messages=3, busiest=1, size=4)
        >>> ledger.entries[0].operation
        'scan'
        """
        self.entries.append(
            Entry(
                phase=self.scopes.phase,
                operation=self.scopes.operation(primitive),
                primitive=primitive,
                elements=elements,
                vp_ratio=vp_ratio,
                messages=messages,
                busiest=busiest,
                bytes=size,
                operations=operations,
                accesses=accesses,
                visit=self.scopes.visit,
            )
        )

    def add_handled(self, messages: npt.NDArray[np.int64]) -> None:
        """Add each processor's messages in one step; machines call this.

        >>> ledger = Ledger(processors=2)
        >>> ledger.add_handled(np.array([3, 1]))
        >>> ledger.handled
        {'': array([3, 1])}
        """
        load = self.handled.setdefault(self.scopes.phase, np.zeros(self.processors, np.int64))
        load += messages

    def held(self, phase: str | None = None) -> npt.NDArray[np.int64]:
        """Elements of each processor, summed over the steps (of a phase): int64 (P,).

        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4, model=sv.SCAN)
        >>> v = cm.iota(10)
        >>> cm.ledger.held().tolist()
        [3, 3, 3, 1]
        """
        edges = np.zeros(self.processors + 1, np.int64)
        for e in self.entries:
            if phase is None or e.phase == phase:
                full, rest = divmod(e.elements, e.vp_ratio)
                edges[0] += e.vp_ratio
                edges[full] -= e.vp_ratio - rest
                edges[min(full + 1, self.processors)] -= rest
        return np.cumsum(edges[:-1])

    def phase(self, name: str) -> AbstractContextManager[None]:
        """Name the phase of the entries made inside.

        >>> ledger = Ledger()
        >>> with ledger.phase("search"):
        ...     ledger.scopes.phase
        'search'
        """
        return self.scopes.in_phase(name)

    def operation(self, name: str) -> AbstractContextManager[None]:
        """Name the composed operation of the entries made inside; the outermost name counts.

        >>> ledger = Ledger()
        >>> with ledger.operation("union"), ledger.operation("sort"):
        ...     ledger.scopes.operation("map")
        'union'
        """
        return self.scopes.in_operation(name)

    def table(self, *by: str) -> list[Row]:
        """Sums by the given keys ("phase", "operation", "primitive"), in order of first appearance.

        Without keys, by operation and primitive. Keys that are not asked for are empty in the rows.

        Raises
        ------
        ValueError
            For another key.

        Examples
        --------
        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4, model=sv.SCAN)
        >>> v = cm.iota(8) + 1
        >>> [(row.primitive, row.steps, row.vp_steps) for row in cm.ledger.table("primitive")]
        [('map', 2, 4)]
        """
        groups = tables.groups(self.entries, by or ("operation", "primitive"))
        return [tables.add_up(key, es, self.model, self.processors) for key, es in groups.items()]

    def by_phase(self) -> dict[str, Row]:
        """Sums of each phase, in order of first appearance.

        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4, model=sv.SCAN)
        >>> v = cm.iota(8) + 1
        >>> cm.ledger.by_phase()[""].steps
        2
        """
        return {row.phase: row for row in self.table("phase")}

    def by_iteration(self, *phases: str) -> list[Row]:
        """Sums of the first, second, ... visit to the given phases, together.

        >>> import scanvec as sv
        >>> cm = sv.Simulated(processors=4)
        >>> for n in (8, 4):
        ...     with cm.phase("loop"):
        ...         v = cm.iota(n)
        >>> [row.elements for row in cm.ledger.by_iteration("loop")]
        [8, 4]
        """
        visits: dict[int, list[Entry]] = {}
        for e in self.entries:
            if e.phase in phases:
                visits.setdefault(e.visit, []).append(e)
        key = (" + ".join(phases), "", "")
        return [tables.add_up(key, visits[k], self.model, self.processors) for k in sorted(visits)]

    def to_csv(self, path: str | Path) -> None:
        """Write one line per step: the attributes of `Entry`, and predicted seconds where there is a model.

        >>> import tempfile
        >>> path = Path(tempfile.mkdtemp(), "steps.csv")
        >>> Ledger().to_csv(path)
        >>> path.read_text().split(",")[:3]
        ['phase', 'operation', 'primitive']
        """
        tables.write_csv(Path(path), self.entries, self.model, self.processors)

    def __str__(self) -> str:
        return tables.as_text(self.table(), seconds=self.model is not None)
