"""One step of a simulated machine, and what several come to."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Entry:
    """One step of a machine's primitive: what was counted, without any time.

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
    operations : int
        Elementary operations on each element: those of a map's function, or the vectors of a scan's record;
        1 for a get or a send.
    accesses : int
        Times that the place most in demand was read by a get, or written by a send, where the machine's model
        asks for it (``Model.exclusive``); 0 elsewhere.
    visit : int
        How often the phase had been entered by then, this time included: 3 in the third iteration of a loop.

    Examples
    --------
    >>> import scanvec as sv
    >>> cm = sv.Simulated(processors=4)
    >>> _ = sv.scan(cm.vector([5, 1, 3, 4, 3, 9, 2, 6]), sv.ADD)
    >>> entry = cm.ledger.entries[0]
    >>> entry.primitive, entry.elements, entry.vp_ratio, entry.messages
    ('scan', 8, 2, 3)
    """

    phase: str
    operation: str
    primitive: str
    elements: int
    vp_ratio: int
    messages: int
    busiest: int
    bytes: int
    operations: int = 1
    accesses: int = 0
    visit: int = 0


@dataclass(frozen=True)
class Row:
    """Entries added up: one row of ``Ledger.table``.

    Examples
    --------
    >>> import scanvec as sv
    >>> cm = sv.Simulated(processors=4)
    >>> v = sv.sort(cm.vector([5, 1, 3, 4]))
    >>> {row.operation for row in cm.ledger.table()}
    {'sort'}
    """

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
    seconds: float | None = None
    """Predicted by the ledger's model; None without one."""
