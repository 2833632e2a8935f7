"""What a 2D triangulation reports of how it was found."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Statistics:
    """Counts and times of a run; tuples have an entry for each thread.

    Attributes
    ----------
    method, order, location, subdivision : str
        What was run; where "auto" was asked for, what it chose.
    threads : int
        All threads; with "batch" the last is the specialised one.
    queue_length : int
        Of the batch method's queue; 0 otherwise.
    inserted : tuple of int
        Sites inserted.
    visited : int
        Nodes or triangles visited by location.
    flips : int
        Edges flipped.
    accesses, tests : int
        Attempts to change the structure, and circum-circle tests made for them (method "circumcircle").
    waits : tuple of int
        How often each thread had to wait for another one, or for the queue.
    retries : tuple of int
        Insertions begun again since another thread had a triangle of theirs (method "optimistic").
    exceptions, given_up : int
        Deadlocks resolved, and insertions whose swaps were left to the correction (method "circumcircle").
    corrected : int
        Swaps made by the correction.
    growths : int
        How often the structure was moved to more memory.
    queue_fill : float
        Mean number of elements that the specialised thread found in the queue.
    seconds : dict of str to float
        Wall time by phase: "input", "order", "insertion", "correction", "extraction", "total".
    cpu_seconds : tuple of float
        Processor time of each thread in the insertion, giving way included. On processors that nobody else
        uses the largest, where threads do not wait, is the wall time.
    location_seconds, change_seconds, wait_seconds : tuple of float
        Time of each thread in location, in subdivision and legalisation, and waiting. Zeros where a method
        does not tell them apart (location "walk" in place).
    visited_by : tuple of int
        Nodes or triangles visited by each thread.
    interleave, parts, queued, tested, helping
        What was run of the options of these names; ``queued`` and ``helping`` are of method "batch", and
        ``tested`` of "circumcircle".
    inconsistencies : int
        Always 0: every decision is exact.

    Examples
    --------
    >>> from dt3d import threaded2d
    >>> points = [[0, 0], [1, 0], [0, 1], [1, 1]]
    >>> stats = threaded2d.Delaunay(points, method="sequential").stats
    >>> stats.method, stats.threads, stats.inconsistencies
    ('sequential', 1, 0)
    """

    method: str
    order: str
    location: str
    subdivision: str
    threads: int
    queue_length: int
    inserted: tuple[int, ...]
    visited: int
    flips: int
    accesses: int
    tests: int
    waits: tuple[int, ...]
    retries: tuple[int, ...]
    exceptions: int
    given_up: int
    corrected: int
    growths: int
    queue_fill: float
    seconds: dict[str, float]
    cpu_seconds: tuple[float, ...]
    location_seconds: tuple[float, ...]
    change_seconds: tuple[float, ...]
    wait_seconds: tuple[float, ...]
    visited_by: tuple[int, ...] = ()
    interleave: int = 1
    parts: str = "shared"
    queued: str = "leaf"
    tested: str = "outer"
    helping: bool = False
    inconsistencies: int = 0

    @property
    def tests_per_access(self) -> float:
        """Circum-circle tests for each attempt to change the structure."""
        return self.tests / self.accesses if self.accesses else 0.0
