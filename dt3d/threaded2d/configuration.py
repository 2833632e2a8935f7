"""What is run where an option is left open: the best configuration (Kohout et al. 2004, section 4.2)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Unpack

from .._numba.cores import available_cores
from .._options import MOST_THREADS_IN_PLANE
from .options import PlaneOptions, with_preset

INTERLEAVED = 8  # searches in turn, by a thread of the batch or circum-circle method
MOST_PROCESSORS_OF_BATCH = 4
WORTH_THREADS = 5000  # sites: with fewer a second thread costs more than it saves


@dataclass(frozen=True, kw_only=True)
class Options:
    """What to run, after "auto" and None have been replaced.

    `dt3d._plane_options.PlaneOptions` says what those of the paper's own way are: ``interleave`` (None: what
    the method does by itself), ``fixed_parts``, ``queue_parents``, ``test_all``, ``head_start`` and
    ``helping``. With ``yield_every`` threads give way at random, once in that many chances, for tests.
    """

    method: str
    threads: int = 1
    order: str = "brio"
    location: str = "dag"
    queue_length: int = 2
    subdivision: str = "random"
    seed: int = 0
    interleave: int | None = None
    fixed_parts: bool = False
    queue_parents: bool = False
    test_all: bool = False
    head_start: bool = True
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
    def searches(self) -> int:
        """How many sites a thread locates at a time, in turn."""
        return self.interleave or (INTERLEAVED if self.method in ("batch", "circumcircle") else 1)

    @property
    def parts(self) -> int:
        """How many threads get sites: with the batch method all but the specialised one."""
        return self.threads - 1 if self.method == "batch" else self.threads


def configured(
    n: int,
    *,
    method: str = "auto",
    threads: int | None = None,
    order: str | None = None,
    location: str = "dag",
    subdivision: str = "random",
    seed: int = 0,
    **own: Unpack[PlaneOptions],
) -> Options:
    """What is run for n sites where None or "auto" was given.

    With the paper's preset "auto" is the batch method on up to four processors, for which the paper means it
    (section 5), and the circum-circle method on more.
    """
    processors = min(available_cores(), MOST_THREADS_IN_PLANE)
    preset = own.get("preset") is not None
    given = with_preset(own)
    fixed = given.get("parts") == "fixed"
    if method == "auto" and not preset:
        count = threads or (processors if n > WORTH_THREADS else 1)
        return Options(
            method="optimistic" if count > 1 else "sequential",
            threads=count,
            location="walk",
            subdivision="curve",
            seed=seed,
            fixed_parts=fixed,
        )
    if method == "auto":
        method = "batch" if processors <= MOST_PROCESSORS_OF_BATCH else "circumcircle"
    if method == "batch":
        count = threads or searching_threads(n, processors) + 1
    else:
        count = 1 if method == "sequential" else threads or processors
    return Options(
        method=method,
        threads=count,
        order=order or ("random" if preset else "brio"),
        location=location,
        queue_length=given.get("queue_length") or queue_for(n),
        subdivision=subdivision,
        seed=seed,
        interleave=given.get("interleave"),
        fixed_parts=fixed,
        queue_parents=given.get("queued") == "parent" and location == "dag",
        test_all=given.get("tested") == "all",
        head_start=given.get("head_start") is not False,
        helping=given.get("helping") is True,
    )


def searching_threads(n: int, processors: int) -> int:
    """How many searching threads the batch method has for n sites (Table 1).

    Two to the specialised one for small sets and three from 50,000 sites on. With four processors or more
    three from 5,000 sites on, four above 100,000 and five above 1.5 million.
    """
    if processors >= 4:
        for least, count in ((1_500_000, 5), (100_000, 4), (4_999, 3)):
            if n > least:
                return count
        return 2
    return 3 if n >= 50_000 else 2


def queue_for(n: int) -> int:
    """The best length of the batch method's queue for n sites (Table 1)."""
    for least, length in ((100_000, 1024), (10_000, 512), (5_000, 256)):
        if n >= least:
            return length
    return 64
