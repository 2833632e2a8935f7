"""The ledger: what every step of a simulated machine did.

It counts; two runs of one program give the same ledger. A cost model turns its counts into predicted time.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np

from ._entry import Conflict, Entry, Row
from ._model import Model, check_model

KEYS = ("phase", "operation", "primitive")


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
    """

    entries: list[Entry] = field(default_factory=list)
    processors: int = 1
    model: Model | None = None
    handled: dict[str, np.ndarray] = field(default_factory=dict, repr=False, compare=False)
    _phase: list[str] = field(default_factory=list, repr=False)
    _visits: dict[str, int] = field(default_factory=dict, repr=False)
    _operation: list[str] = field(default_factory=list, repr=False)

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
        phase, operation = self.names(primitive)
        self.entries.append(
            Entry(
                phase=phase,
                operation=operation,
                primitive=primitive,
                elements=elements,
                vp_ratio=vp_ratio,
                messages=messages,
                busiest=busiest,
                bytes=size,
                operations=operations,
                accesses=accesses,
                visit=self._visits.get(phase, 0),
            )
        )

    def add_handled(self, messages: np.ndarray) -> None:
        """Add each processor's messages in one step; machines call this."""
        phase = self._phase[-1] if self._phase else ""
        if phase not in self.handled:
            self.handled[phase] = np.zeros(self.processors, np.int64)
        self.handled[phase] += messages

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

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """Name the phase of the entries made inside."""
        self._phase.append(name)
        self._visits[name] = self._visits.get(name, 0) + 1
        try:
            yield
        finally:
            self._phase.pop()

    @contextmanager
    def operation(self, name: str) -> Iterator[None]:
        """Name the composed operation of the entries made inside; the outermost name counts."""
        self._operation.append(name)
        try:
            yield
        finally:
            self._operation.pop()

    def names(self, primitive: str) -> tuple[str, str]:
        """The phase and the operation that an entry made now would have."""
        phase = self._phase[-1] if self._phase else ""
        return phase, self._operation[0] if self._operation else primitive

    def share_names(self, other: Ledger) -> None:
        """Take phases and operations from another ledger, of the same steps on another machine."""
        self._phase, self._visits, self._operation = other._phase, other._visits, other._operation

    def table(self, *by: str) -> list[Row]:
        """Sums by the given keys ("phase", "operation", "primitive"), in order of first appearance.

        Without keys, by operation and primitive. Keys that are not asked for are empty in the rows.

        Raises
        ------
        ValueError
            For another key.
        """
        by = by or ("operation", "primitive")
        for key in by:
            if key not in KEYS:
                msg = f"cannot group the ledger by {key!r}; use {', '.join(KEYS)}"
                raise ValueError(msg)
        groups: dict[tuple[str, ...], list[Entry]] = {}
        for e in self.entries:
            groups.setdefault(tuple(getattr(e, k) if k in by else "" for k in KEYS), []).append(e)
        return [self._row(key, es) for key, es in groups.items()]

    def by_phase(self) -> dict[str, Row]:
        """Sums of each phase, in order of first appearance."""
        return {row.phase: row for row in self.table("phase")}

    def by_iteration(self, *phases: str) -> list[Row]:
        """Sums of the first, second, ... visit to the given phases, together."""
        visits: dict[int, list[Entry]] = {}
        for e in self.entries:
            if e.phase in phases:
                visits.setdefault(e.visit, []).append(e)
        return [self._row((" + ".join(phases), "", ""), visits[k]) for k in sorted(visits)]

    def _row(self, key: tuple[str, ...], entries: list[Entry]) -> Row:
        phase, operation, primitive = key
        seconds = None
        if self.model is not None:
            seconds = sum(self.model.seconds(e, self.processors) for e in entries)
        return Row(
            phase=phase,
            operation=operation,
            primitive=primitive,
            steps=len(entries),
            elements=sum(e.elements for e in entries),
            vp_steps=sum(e.vp_ratio for e in entries),
            max_vp_ratio=max(e.vp_ratio for e in entries),
            messages=sum(e.messages for e in entries),
            busiest=sum(e.busiest for e in entries),
            seconds=seconds,
        )

    def to_csv(self, path: str | Path) -> None:
        """Write one line a step: the attributes of `Entry`, and predicted seconds where there is a model."""
        names = [f.name for f in fields(Entry)]
        with Path(path).open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow([*names, *(["seconds"] if self.model else [])])
            for e in self.entries:
                values: list[Any] = [getattr(e, n) for n in names]
                if self.model is not None:
                    values.append(self.model.seconds(e, self.processors))
                writer.writerow(values)

    def __str__(self) -> str:
        names = [f.name for f in fields(Row) if f.name != "phase" and (self.model or f.name != "seconds")]
        rows = [[_text(getattr(r, n)) for n in names] for r in self.table()]
        widths = [max(len(x) for x in col) for col in zip(names, *rows, strict=True)]
        lines = ["  ".join(x.rjust(w) for x, w in zip(r, widths, strict=True)) for r in [names, *rows]]
        return "\n".join(lines)


def _text(value: Any) -> str:
    return f"{value:.6f}" if isinstance(value, float) else str(value)
