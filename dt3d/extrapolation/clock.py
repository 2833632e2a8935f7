"""Seconds by phase, in both loops."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

import scanvec as sv


class Clock:
    """Adds up seconds by phase, and names the phases in the machine's ledger."""

    def __init__(self, machine: sv.Machine) -> None:
        self.machine = machine
        self.seconds: dict[str, float] = {}

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """Count what is done within to a phase."""
        start = time.perf_counter()
        with self.machine.phase(name):
            yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start
