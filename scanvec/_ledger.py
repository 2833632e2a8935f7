"""The ledger: what every step of a simulated machine did.

It counts; it does not time. Two runs of one program give the same ledger.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, fields


@dataclass(frozen=True)
class Entry:
    """One step of a machine's primitive.

    Attributes
    ----------
    phase : str
        The part of the program that ran it, as named by ``machine.phase``.
    operation : str
        What the program called: the composed operation ("pack"), or the primitive itself.
    primitive : str
        What the machine did: "map", "scan", "get" or "send".
    elements : int
        Length n of the vector that the step ran over.
    vp_ratio : int
        Virtual processors a processor: ceil(n / P), the elements that the busiest one handles.
    messages : int
        Values that crossed from one processor to another. A get costs a request and a reply where the
        element lives elsewhere, a send one message, a scan one partial result from each processor but the
        last. A record travels as one message.
    busiest : int
        Messages that the busiest processor sent or received, whichever is more.
    bytes : int
        Size of one message in bytes.
    """

    phase: str
    operation: str
    primitive: str
    elements: int
    vp_ratio: int
    messages: int
    busiest: int
    bytes: int


@dataclass(frozen=True)
class Row:
    """Entries added up: one row of ``Ledger.table``."""

    phase: str
    operation: str
    primitive: str
    steps: int
    elements: int
    vp_steps: int
    """Sum of the VP ratios: the time in element steps of the busiest processor."""
    max_vp_ratio: int
    messages: int
    busiest: int
    """Sum of the busiest processors' messages: the time in messages."""


@dataclass
class Ledger:
    """All that ran on one simulated machine, in order."""

    entries: list[Entry] = field(default_factory=list)
    _phase: list[str] = field(default_factory=list, repr=False)
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

    def record(
        self, primitive: str, elements: int, vp_ratio: int, messages: int, busiest: int, size: int
    ) -> None:
        """Enter one step; machines call this."""
        self.entries.append(
            Entry(
                phase=self._phase[-1] if self._phase else "",
                operation=self._operation[0] if self._operation else primitive,
                primitive=primitive,
                elements=elements,
                vp_ratio=vp_ratio,
                messages=messages,
                busiest=busiest,
                bytes=size,
            )
        )

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """Name the phase of the entries made inside."""
        self._phase.append(name)
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

    def table(self, *by: str) -> list[Row]:
        """Sums by the given keys ("phase", "operation", "primitive"), in order of first appearance.

        Without keys, by operation and primitive. Keys that are not asked for are empty in the rows.

        Raises
        ------
        ValueError
            For another key.
        """
        by = by or ("operation", "primitive")
        allowed = ("phase", "operation", "primitive")
        for key in by:
            if key not in allowed:
                msg = f"cannot group the ledger by {key!r}; use {', '.join(allowed)}"
                raise ValueError(msg)
        groups: dict[tuple[str, ...], list[Entry]] = {}
        for e in self.entries:
            groups.setdefault(tuple(getattr(e, k) if k in by else "" for k in allowed), []).append(e)
        return [
            Row(
                phase=phase,
                operation=operation,
                primitive=primitive,
                steps=len(es),
                elements=sum(e.elements for e in es),
                vp_steps=sum(e.vp_ratio for e in es),
                max_vp_ratio=max(e.vp_ratio for e in es),
                messages=sum(e.messages for e in es),
                busiest=sum(e.busiest for e in es),
            )
            for (phase, operation, primitive), es in groups.items()
        ]

    def __str__(self) -> str:
        names = [f.name for f in fields(Row) if f.name != "phase"]
        rows = [[str(getattr(r, n)) for n in names] for r in self.table()]
        widths = [max(len(x) for x in col) for col in zip(names, *rows, strict=True)]
        lines = ["  ".join(x.rjust(w) for x, w in zip(r, widths, strict=True)) for r in [names, *rows]]
        return "\n".join(lines)
