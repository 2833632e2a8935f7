"""What is run where an option is left open: the best configuration (Kohout et al. 2004, section 4.2)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .._numba.cores import available_cores
from .._options import MOST_THREADS_IN_PLANE

WORTH_THREADS = 5000  # sites: with fewer a second thread costs more than it saves


@dataclass(frozen=True, kw_only=True)
class Options:
    """What to run, after "auto" and None have been replaced.

    ``helping`` is the batch method's variant in which searching threads that find the queue full finish
    locations. With ``yield_every`` threads give way at random, once in that many chances, for tests.
    """

    method: str
    threads: int = 1
    order: str = "brio"
    location: str = "dag"
    queue_length: int = 2
    subdivision: str = "random"
    seed: int = 0
    helping: bool = False
    yield_every: int = 0

    def contended(self, yield_every: int, helping: bool = False) -> Options:
        """The same with threads that give way at random, for tests."""
        return replace(self, yield_every=yield_every, helping=helping)

    @property
    def in_place(self) -> bool:
        """Whether the structure keeps no history."""
        return self.location == "walk" and self.method in ("sequential", "optimistic")

    @property
    def parts(self) -> int:
        """How many threads get sites: with the batch method all but the specialised one."""
        return self.threads - 1 if self.method == "batch" else self.threads


def configured(
    n: int,
    *,
    method: str = "auto",
    threads: int | None = None,
    order: str = "brio",
    location: str = "dag",
    queue_length: int | None = None,
    subdivision: str = "random",
    seed: int = 0,
) -> Options:
    """What is run for n sites where None or "auto" was given."""
    processors = min(available_cores(), MOST_THREADS_IN_PLANE)
    if method == "auto":
        count = threads or (processors if n > WORTH_THREADS else 1)
        return Options(
            method="optimistic" if count > 1 else "sequential",
            threads=count,
            location="walk",
            subdivision="curve",
            seed=seed,
        )
    if method == "batch":
        count = threads or searching_threads(n, processors) + 1
    else:
        count = 1 if method == "sequential" else threads or processors
    return Options(
        method=method,
        threads=count,
        order=order,
        location=location,
        queue_length=queue_length or queue_for(n),
        subdivision=subdivision,
        seed=seed,
    )


def searching_threads(n: int, processors: int) -> int:
    """How many searching threads the batch method has for n sites (Table 1).

    Two to the specialised one for small sets and three from 50,000 sites on; with four processors or more,
    four above 100,000 sites and five above 1.5 million.
    """
    if processors >= 4 and n > 100_000:
        return 5 if n > 1_500_000 else 4
    return 3 if n >= 50_000 else 2


def queue_for(n: int) -> int:
    """The best length of the batch method's queue for n sites (Table 1)."""
    for least, length in ((100_000, 1024), (10_000, 512), (5_000, 256)):
        if n >= least:
            return length
    return 64
