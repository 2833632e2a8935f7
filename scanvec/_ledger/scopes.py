"""What the program calls the part that is running: phases, and composed operations."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager


class Scopes:
    """The phase and the operation of the entries made now; one for all ledgers of a machine."""

    def __init__(self) -> None:
        self._phases: list[str] = []
        self._visits: Counter[str] = Counter()
        self._operations: list[str] = []

    @property
    def phase(self) -> str:
        """The innermost phase; empty outside."""
        return self._phases[-1] if self._phases else ""

    @property
    def visit(self) -> int:
        """How often the phase has been entered."""
        return self._visits[self.phase]

    def operation(self, primitive: str) -> str:
        """The outermost operation; outside of all, the primitive itself."""
        return self._operations[0] if self._operations else primitive

    @contextmanager
    def in_phase(self, name: str) -> Iterator[None]:
        """Name the phase of the entries made inside."""
        self._phases.append(name)
        self._visits[name] += 1
        try:
            yield
        finally:
            self._phases.pop()

    @contextmanager
    def in_operation(self, name: str) -> Iterator[None]:
        """Name the operation of the entries made inside, unless another one encloses it."""
        self._operations.append(name)
        try:
            yield
        finally:
            self._operations.pop()
