"""The ledger: what every step of a simulated machine did.

It counts; two runs of one program give the same ledger. A cost model turns its counts into predicted time.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from . import _tables
from ._conflict import Conflict
from ._entry import Entry, Row
from ._model import Model, check_model
from ._names import Names


@dataclass
class Ledger:
    """All that ran on one simulated machine of P processors, in order.

    Attributes
    ----------
    entries : list of Entry
    processors : int
        P.
    model : Model or None
        What `seconds` is predicted with.
    handled : dict of str to ndarray of int64 (P,)
        By phase, the messages of each processor: sent or received, whichever is more in a step. Counted on
        the machine itself, not for its further numbers of processors.
    names : Names
        The phase and the operation that are running.
    """

    entries: list[Entry] = field(default_factory=list)
    processors: int = 1
    model: Model | None = None
    handled: dict[str, np.ndarray] = field(default_factory=dict, repr=False, compare=False)
    names: Names = field(default_factory=Names, repr=False, compare=False)

    @property
    def steps(self) -> int:
        """Primitive steps so far."""
        return len(self.entries)

    @property
    def messages(self) -> int:
        """Messages between processors so far."""
        return sum(e.messages for e in self.entries)

    @property
    def elements(self) -> int:
        """Elements processed so far, summed over the steps: the work of the scan model."""
        return sum(e.elements for e in self.entries)

    @property
    def seconds(self) -> float:
        """Time of all steps so far as the model predicts it.

        Raises
        ------
        ValueError
            If the machine was made without a model.
        """
        model = self.check_has_model()
        return sum(model.seconds(e, self.processors) for e in self.entries)

    def check_has_model(self) -> Model:
        """The model; ValueError, saying where one comes from, if there is none."""
        if self.model is None:
            msg = (
                "this ledger has no cost model, so it predicts no time; make the machine with one, as in "
                "Simulated(processors=32, model=scanvec.CM5), or use ledger.under(scanvec.CM5)"
            )
            raise ValueError(msg)
        return self.model

    @property
    def conflicts(self) -> list[Conflict]:
        """Steps so far whose accesses were not exclusive; of machines whose model asks for it."""
        return [
            Conflict(e.phase, e.operation, e.primitive, step, e.accesses)
            for step, e in enumerate(self.entries)
            if e.accesses > 1
        ]

    def under(self, model: Model) -> Ledger:
        """The same entries with another model.

        The loads are the same, since they depend on P only. Accesses are known only if the machine's own
        model was exclusive.
        """
        return Ledger(self.entries, self.processors, check_model(model), self.handled)

    def of(self, *phases: str) -> Ledger:
        """The part of the ledger that these phases made."""
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
        """Enter one step; machines call this."""
        self.entries.append(
            Entry(
                phase=self.names.phase,
                operation=self.names.operation(primitive),
                primitive=primitive,
                elements=elements,
                vp_ratio=vp_ratio,
                messages=messages,
                busiest=busiest,
                bytes=size,
                operations=operations,
                accesses=accesses,
                visit=self.names.visit,
            )
        )

    def add_handled(self, messages: np.ndarray) -> None:
        """Add each processor's messages in one step; machines call this."""
        load = self.handled.setdefault(self.names.phase, np.zeros(self.processors, np.int64))
        load += messages

    def held(self, phase: str | None = None) -> np.ndarray:
        """Elements of each processor, summed over the steps (of a phase): int64 (P,)."""
        edges = np.zeros(self.processors + 1, np.int64)
        for e in self.entries:
            if phase is None or e.phase == phase:
                full, rest = divmod(e.elements, e.vp_ratio)
                edges[0] += e.vp_ratio
                edges[full] -= e.vp_ratio - rest
                edges[min(full + 1, self.processors)] -= rest
        return np.cumsum(edges[:-1])

    def phase(self, name: str) -> AbstractContextManager[None]:
        """Name the phase of the entries made inside."""
        return self.names.in_phase(name)

    def operation(self, name: str) -> AbstractContextManager[None]:
        """Name the composed operation of the entries made inside; the outermost name counts."""
        return self.names.in_operation(name)

    def table(self, *by: str) -> list[Row]:
        """Sums by the given keys ("phase", "operation", "primitive"), in order of first appearance.

        Without keys, by operation and primitive. Keys that are not asked for are empty in the rows.

        Raises
        ------
        ValueError
            For another key.
        """
        groups = _tables.groups(self.entries, by or ("operation", "primitive"))
        return [_tables.add_up(key, es, self.model, self.processors) for key, es in groups.items()]

    def by_phase(self) -> dict[str, Row]:
        """Sums of each phase, in order of first appearance."""
        return {row.phase: row for row in self.table("phase")}

    def by_iteration(self, *phases: str) -> list[Row]:
        """Sums of the first, second, ... visit to the given phases, together."""
        visits: dict[int, list[Entry]] = {}
        for e in self.entries:
            if e.phase in phases:
                visits.setdefault(e.visit, []).append(e)
        key = (" + ".join(phases), "", "")
        return [_tables.add_up(key, visits[k], self.model, self.processors) for k in sorted(visits)]

    def to_csv(self, path: str | Path) -> None:
        """Write one line a step: the attributes of `Entry`, and predicted seconds where there is a model."""
        _tables.write_csv(Path(path), self.entries, self.model, self.processors)

    def __str__(self) -> str:
        return _tables.as_text(self.table(), seconds=self.model is not None)
