"""Accesses that were not exclusive, on a machine whose model allows no others."""

from __future__ import annotations

from dataclasses import dataclass

from .._models.model import Model


@dataclass(frozen=True)
class Conflict:
    """A step of a machine with exclusive access that read or wrote one place more than once.

    Attributes
    ----------
    phase, operation, primitive : str
        As in `Entry`.
    step : int
        Which step of the ledger it was, from 0.
    accesses : int
        Elements that read or wrote the place most in demand.

    Examples
    --------
    >>> import scanvec as sv
    >>> cm = sv.Simulated(processors=4, model=sv.EREW_PRAM)
    >>> _ = sv.get(cm.vector([5, 1, 3]), cm.vector([2, 2, 0]))
    >>> cm.ledger.conflicts[0].accesses
    2
    """

    phase: str
    operation: str
    primitive: str
    step: int
    accesses: int

    def __str__(self) -> str:
        verb = "read" if self.primitive == "get" else "written"
        where = f" in phase {self.phase!r}" if self.phase else ""
        return (
            f"step {self.step}: {self.primitive}, called by {self.operation}{where}: one place was {verb} by "
            f"{self.accesses} elements at once"
        )


class ConcurrentAccessError(ValueError):
    """A concurrent read or write on a machine with exclusive access.

    Attributes
    ----------
    conflict : Conflict

    Examples
    --------
    >>> import scanvec as sv
    >>> cm = sv.Simulated(processors=4, model=sv.EREW_PRAM, on_conflict="raise")
    >>> sv.get(cm.vector([5, 1, 3]), cm.vector([2, 2, 0]))
    Traceback (most recent call last):
    scanvec._ledger.conflict.ConcurrentAccessError: step 0: get, called by get: one place ...
    """

    def __init__(self, conflict: Conflict, model: Model | None) -> None:
        super().__init__(
            f"{conflict}; {model!r} allows exclusive access only. Use indices that are distinct, a copy-scan "
            f"instead of a concurrent read, a reduction instead of a write; or on_conflict='report'"
        )
        self.conflict = conflict
